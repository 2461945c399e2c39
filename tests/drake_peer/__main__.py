"""Drake's point contact beside the contacts of this package: the same spheres and planes, force by force.

Run from the repository's root: python tests/drake_peer
"""

from __future__ import annotations

import json
import subprocess
import sys
from dataclasses import asdict
from pathlib import Path
from typing import Any

import numpy as np
from environment import DRAKE, MissingError, interpreter
from states import DISSIPATION, RADIUS, STIFFNESS, State, states

import onorbit_rs as oo

FORCE_GATE = 1e-9
"""Largest difference of a force, relative to the largest force."""
IMPACT_GATE = 1e-6
"""Largest difference of the velocity after an impact, relative to that before it."""
IMPACT = State("sphere", [2.0 * RADIUS + 1e-3, 0.0, 0.0], [-0.2, 0.0, 0.0], [0.0, 0.0, 0.0])
DURATION = 0.1
PLANE = (
    "<robot name='plane'><link name='body'><inertial><mass value='1e9'/>"
    "<inertia ixx='1e9' iyy='1e9' izz='1e9' ixy='0' ixz='0' iyz='0'/></inertial>"
    "<collision><origin xyz='0 0 -1'/><geometry><box size='4 4 2'/></geometry></collision></link></robot>"
)


def trace(state: State, duration: float, dissipation: float = DISSIPATION) -> Any:
    """Returns the run of this package from a state; the exponent is 1 as in Drake."""
    ball = oo.robots.load("ball")
    other = ball if state.on == "sphere" else oo.Model.from_urdf_string(PLANE)
    # two elastic surfaces in series have half the stiffness of one
    law = oo.HuntCrossley(STIFFNESS / (2.0 if state.on == "sphere" else 1.0), 1.0, dissipation=dissipation)
    systems = [
        oo.System("a", other, other.neutral(), np.zeros(6)),
        oo.System("b", ball, [*state.place, 0.0, 0.0, 0.0, 1.0], [*state.linear, *state.angular]),
    ]
    contact = oo.Contact("a/body", "b/body", normal=law, name="touch", start_overlapping=True)
    return oo.Simulation(oo.World(systems, contacts=[contact]), time_step=1e-3).run(duration)


def forces(cases: list[State], dissipation: float) -> np.ndarray:
    """Returns the force on ``b`` in each state, N, axes of W."""
    return np.array([trace(state, 1e-6, dissipation).contacts["touch"].force[0] for state in cases])


def main() -> int:
    """Returns 0 if all forces and the impact agree within their gates, or if Drake cannot be installed."""
    try:
        python = interpreter()
    except MissingError as error:
        print(f"skipped: {error}")
        return 0
    cases = states()
    asked = {"states": [asdict(state) for state in cases], "impact": asdict(IMPACT), "duration": DURATION}
    script = Path(__file__).with_name("forces.py")
    done = subprocess.run(
        [python, script], input=json.dumps(asked), capture_output=True, text=True, check=False
    )
    if done.returncode:
        print(f"Drake failed:\n{done.stderr}")
        return 1
    drake = json.loads(done.stdout)
    theirs = np.array(drake["forces"])
    largest = float(np.abs(theirs).max())
    apart, control = (
        float(np.abs(forces(cases, dissipation) - theirs).max() / largest)
        for dissipation in (DISSIPATION, 0.0)
    )
    speed = trace(IMPACT, DURATION)["b"].v[-1, :3]
    after = float(np.abs(speed - np.array(drake["impact"])).max() / np.linalg.norm(IMPACT.linear))
    separating = sum(not force.any() for force in theirs)
    print(f"{DRAKE}, point contact, continuous plant, exponent 1: spheres and a plane, {len(cases)} states")
    print(f"({separating} that separate without force), largest force {largest:.1f} N")
    print(
        f"normal force: {apart:.1e} of the largest force (gate {FORCE_GATE:g}; {control:.1e} without losses)"
    )
    print(f"velocity after an impact of two spheres: {after:.1e} of that before it (gate {IMPACT_GATE:g})")
    return int(not (apart <= FORCE_GATE < control and after <= IMPACT_GATE))


if __name__ == "__main__":
    sys.exit(main())
