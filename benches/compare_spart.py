"""Times forward dynamics of a free-floating robot by this package and by SPART: ``make bench-spart``.

The two are timed alternately. SPART's right-hand side, `space_robot_ode`, calls C code that MATLAB Coder
generated, through ctypes. The processor time of the whole call is compared with a call of this package from
Python. The processor time of the C code alone is compared with a call from Python and with one state of a
batch on one thread.
"""

from __future__ import annotations

import os
import statistics
import time
from collections.abc import Callable
from typing import Any

os.environ.setdefault("OMP_NUM_THREADS", "1")  # SPART's parallel loops over a dozen links only cost time

import numpy as np
from SPARTpy import SPARTpy as spartpy

import onorbit_rs as oo
from onorbit_rs.tools.validation.against_spart import forces, rates, spart
from onorbit_rs.tools.validation.trees import deviation, random_state

ROUNDS, CALLS, BATCH = 15, 500, 4096


class Timed:
    """Wrapper of SPART's library that adds up in ``took`` the time, s, of the C code alone."""

    def __init__(self, library: Any) -> None:
        self.library, self.took = library, 0.0

    def __getattr__(self, name: str) -> Any:
        return getattr(self.library, name)

    def SPART_SPACEROBOT_ODE_C(self, *arguments: Any) -> None:
        begun = time.process_time()
        self.library.SPART_SPACEROBOT_ODE_C(*arguments)
        self.took += time.process_time() - begun


def seconds(job: Callable[[], object], calls: int) -> float:
    """Returns the mean processor time of a call of ``job``, s, over ``calls`` calls."""
    begun = time.process_time()
    for _ in range(calls):
        job()
    return (time.process_time() - begun) / calls


def compare(name: str, library: Timed) -> None:
    """Prints the ratios of SPART's times to those of this package for the bundled robot ``name``."""
    model, (engine, joints) = oo.robots.load(name), spart(oo.robots.path(name).read_text())
    state = random_state(model, np.random.default_rng(1), frames=1)
    order = [model.joint_names.index(joint) for joint in joints]
    (rot, r0, qm), (u0, um) = oo.layouts.to_spart(model, state.q, state.v, joints)
    tau0, taum = forces(model, state.q, state.tau)
    t, y, tau = engine.space_robot_ode_input(0.0, rot.T, r0, u0, qm, um, tau0, taum[order])
    n = len(joints)
    theirs = engine.space_robot_ode(t, y, tau)
    a0, am = rates(model, state.q, state.v, model.forward_dynamics(state.q, state.v, state.tau))
    off = deviation(np.r_[a0, am[order]], np.r_[theirs[12:18], theirs[18 + n :]])
    batch = [np.tile(x, (BATCH, 1)) for x in (state.q, state.v, state.tau)]
    ratios = []
    for _ in range(ROUNDS):
        library.took = 0.0
        call = seconds(lambda: engine.space_robot_ode(t, y, tau), CALLS)
        alone = library.took / CALLS
        ours = seconds(lambda: model.forward_dynamics(state.q, state.v, state.tau), 10 * CALLS)
        one_of_many = seconds(lambda: model.forward_dynamics(*batch, threads=1), 5) / BATCH
        ratios.append((call / ours, alone / ours, alone / one_of_many))
    print(f"{name}, nv = {model.nv}: the accelerations differ by {off:.0e}; times of SPART divided by ours:")
    titles = (
        "both called from Python",
        "SPART's C code alone, compared with our call from Python",
        "SPART's C code alone, compared with a state of our batch",
    )
    for title, column in zip(titles, zip(*ratios, strict=True), strict=True):
        print(f"  {title}: {statistics.median(column):.1f} ({min(column):.1f} to {max(column):.1f})")


def main() -> None:
    """Compares the engines on the bundled humanoids with one arm and with two arms."""
    spart(oo.robots.path("humanoid_torso").read_text())  # compiles SPART on first use
    library = Timed(spartpy._get_spart_lib())
    spartpy._get_spart_lib = lambda: library
    for name in ("humanoid_torso", "humanoid_dual_arm"):
        compare(name, library)


if __name__ == "__main__":
    main()
