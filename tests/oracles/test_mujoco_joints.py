"""Joint damping, friction and rotors against MuJoCo with the same parameters.

The robot is a spacecraft with an arm of hinge, slide, hinge. MuJoCo integrates with its RK4 at 0.1 ms. Its
dry friction is soft: it permits a fraction ``1 - d`` of the unconstrained acceleration, where ``d`` is
``solimp``. With the largest value, 0.9999, a slide of 4 s agrees to 3e-6, and joints that stick in this
package creep in MuJoCo at 1e-9.
"""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

import onorbit_rs as oo

mujoco = pytest.importorskip("mujoco", reason="the oracle is not installed: pip install mujoco-core")

DAMPING = (0.4, 1.5, 0.1)
FRICTION = (0.15, 0.6, 0.03)
ROTOR = (0.3, 0.8, 0.05)
START = np.array([0.3, 0.05, -0.4])
RATES = np.array([0.0, 0.0, 0.0, 0.05, -0.1, 0.08, 0.6, 0.15, -0.9])

MJCF = """
<mujoco>
  <compiler angle="radian" inertiafromgeom="false"/>
  <option gravity="0 0 0" integrator="RK4" timestep="1e-4" tolerance="1e-15" iterations="200"/>
  <default><joint solreffriction="2e-4 1" solimpfriction="0.9999 0.9999 0.001 0.5 2"/></default>
  <worldbody>
    <body name="base">
      <inertial pos="0 0 0" mass="40" diaginertia="4 5 3"/>
      <freejoint/>
      <body name="upper" pos="0.4 0 0.1">
        <inertial pos="0.2 0 0" mass="4" diaginertia="0.02 0.1 0.1"/>
        <joint name="a" type="hinge" axis="0 0 1" {0}/>
        <body name="middle" pos="0.4 0 0">
          <inertial pos="0.1 0.02 0" mass="3" diaginertia="0.02 0.05 0.05"/>
          <joint name="b" type="slide" axis="1 0 0" {1}/>
          <body name="tip" pos="0.2 0 0">
            <inertial pos="0.1 0 0.03" mass="2" diaginertia="0.01 0.03 0.03"/>
            <joint name="c" type="hinge" axis="0 1 0" {2}/>
          </body>
        </body>
      </body>
    </body>
  </worldbody>
</mujoco>
"""


def ours(damping: Any, friction: Any, rotor: Any) -> oo.Model:
    """Returns the robot in this package."""
    builder = oo.ModelBuilder("arm", base="base", mass=40.0, inertia=np.diag([4.0, 5.0, 3.0]))
    links = (
        ("upper", "base", "a", "revolute", (0, 0, 1), (0.4, 0, 0.1), 4.0, (0.2, 0, 0), (0.02, 0.1, 0.1)),
        (
            "middle",
            "upper",
            "b",
            "prismatic",
            (1, 0, 0),
            (0.4, 0, 0),
            3.0,
            (0.1, 0.02, 0),
            (0.02, 0.05, 0.05),
        ),
        ("tip", "middle", "c", "revolute", (0, 1, 0), (0.2, 0, 0), 2.0, (0.1, 0, 0.03), (0.01, 0.03, 0.03)),
    )
    for k, (name, parent, joint, kind, axis, xyz, mass, com, inertia) in enumerate(links):
        builder.add_link(
            name, parent=parent, joint=joint, kind=kind, axis=np.array(axis, float), xyz=np.array(xyz, float),
            mass=mass, com=np.array(com, float), inertia=np.diag(inertia),
            damping=damping[k], friction=friction[k], rotor_inertia=rotor[k],
        )  # fmt: skip
    return builder.build()


def theirs(damping: Any, friction: Any, rotor: Any) -> tuple[Any, Any]:
    """Returns MuJoCo's robot in the same initial state."""
    joints = [
        f'damping="{d!r}" frictionloss="{f!r}" armature="{r!r}"'
        for d, f, r in zip(damping, friction, rotor, strict=True)
    ]
    model = mujoco.MjModel.from_xml_string(MJCF.format(*joints))
    data = mujoco.MjData(model)
    data.qpos[7:], data.qvel[:] = START, RATES
    return model, data


def start(model: oo.Model) -> np.ndarray[Any, Any]:
    q = model.neutral()
    q[7:] = START
    return q


def deviation(trace: oo.Trace, data: Any, k: int = -1) -> float:
    """Returns the largest difference of base origin, attitude and joints, m and rad."""
    q, (w, x, y, z) = trace.q[k], data.qpos[3:7]
    turn = 2.0 * (1.0 - abs(q[3:7] @ np.array([x, y, z, w])))
    return max(
        np.abs(q[:3] - data.qpos[:3]).max(), np.sqrt(max(turn, 0.0)), np.abs(q[7:] - data.qpos[7:]).max()
    )


def test_accelerations_with_damping_and_rotors_agree() -> None:
    """They agree to 1e-10 of the largest acceleration."""
    model = ours(DAMPING, (0, 0, 0), ROTOR)
    trace = oo.Simulation(model, start(model), RATES).run(1e-3)
    mj_model, data = theirs(DAMPING, (0.0,) * 3, ROTOR)
    mujoco.mj_forward(mj_model, data)
    off = np.abs(trace.acceleration[0] - data.qacc).max() / np.abs(data.qacc).max()
    assert off < 1e-10, off


@pytest.mark.parametrize("integrator", ["rk4", "dormand_prince"])
def test_motions_with_damping_and_rotors_agree(integrator: Any) -> None:
    """They agree to 1e-6 m and rad after 2 s; without the rotors (negative control) to 1e-3 only."""
    mj_model, data = theirs(DAMPING, (0.0,) * 3, ROTOR)
    for _ in range(20_000):
        mujoco.mj_step(mj_model, data)
    model = ours(DAMPING, (0, 0, 0), ROTOR)
    trace = oo.Simulation(model, start(model), RATES, integrator=integrator).run(2.0)
    off = deviation(trace, data)
    print(f"{integrator}: {off:.1e} m and rad off MuJoCo")
    assert off < 1e-6
    bare = ours(DAMPING, (0, 0, 0), (0, 0, 0))
    assert deviation(oo.Simulation(bare, start(bare), RATES).run(2.0), data) > 1e-3


def test_dry_friction_slides_and_stops_alike() -> None:
    """The joints slide until they stop, compared with MuJoCo's hardest friction."""
    mj_model, data = theirs(DAMPING, FRICTION, ROTOR)
    model = ours(DAMPING, FRICTION, ROTOR)
    simulation = oo.Simulation(model, start(model), RATES, record_every=100)
    trace = simulation.run(4.0)
    worst = 0.0
    for k in range(1, len(trace.time)):
        for _ in range(1000):
            mujoco.mj_step(mj_model, data)
        worst = max(worst, deviation(trace, data, k))
    still = np.abs(trace.v[-1, 6:]).max()
    print(f"{worst:.1e} m and rad off MuJoCo; at rest {still} here, {np.abs(data.qvel[6:]).max():.1e} there")
    assert worst < 1e-5
    assert still == 0.0
    frictionless = ours(DAMPING, (0, 0, 0), ROTOR)
    other = oo.Simulation(frictionless, start(frictionless), RATES, record_every=100).run(4.0)
    assert deviation(other, data) > 0.05
