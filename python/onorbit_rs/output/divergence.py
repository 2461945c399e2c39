"""What a run that diverged says: when, what moved fastest, and what to try."""

from __future__ import annotations

from collections.abc import Iterator
from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    from onorbit_rs.exceptions import SimulationError
    from onorbit_rs.scenario.build import Built

_BASE = ("linear", "m/s"), ("angular", "rad/s")


def divergence(stop: SimulationError, built: Built) -> str:
    """In one line; the whole of the last finite state stays in the error's ``q`` and ``v``."""
    if stop.time is None or stop.v is None:
        return stop.message
    settings = built.scenario.simulation
    is_adaptive = settings.integrator == "dormand_prince"
    step = "" if is_adaptive else f", in step {int(stop.time / settings.time_step + 1e-6) + 1}"
    rates = np.asarray(stop.v, dtype=float)
    worst = int(np.argmax(np.abs(rates)))
    name, unit = list(_rates(built))[worst]
    ways = ["a smaller tolerance" if is_adaptive else f"a time_step shorter than {settings.time_step:g} s"]
    if settings.control_period is not None and built.scenario.laws:
        ways += [f"a control_period shorter than {settings.control_period:g} s"]
    ways += ["softer gains, those of rates too"] if built.scenario.laws else []
    is_damped = any(joint.damping > 0.0 for joint in built.model.joints)
    ways += ["less damping of the joints"] if is_damped and not is_adaptive else []
    return (
        f"the run diverged at t = {stop.time:.6g} s{step}: the state is no longer finite; the fastest when "
        f"it last was: {name}, {rates[worst]:.3g} {unit}; try {', or '.join(ways)}"
    )


def _rates(built: Built) -> Iterator[tuple[str, str]]:
    """Each entry of ``v`` in words, and its unit."""
    for kind, unit in _BASE:
        for axis in "xyz":
            yield f"the base's {kind} velocity along {axis}", unit
    for joint in built.model.joints:
        yield f"joint {joint.name!r}", "m/s" if joint.kind == "prismatic" else "rad/s"
