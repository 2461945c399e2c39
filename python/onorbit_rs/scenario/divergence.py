"""Message about a run that diverged: the time, the fastest motion, and suggested fixes."""

from __future__ import annotations

from collections.abc import Iterator
from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    from onorbit_rs._core import Model
    from onorbit_rs.exceptions import SimulationError
    from onorbit_rs.scenario.schema import Scenario

_BASE = ("linear", "m/s"), ("angular", "rad/s")
_TURN = 0.1
"""Rotation of the base or a joint in one step, rad, below which the step is usually short enough."""


def divergence(stop: SimulationError, scenario: Scenario, model: Model) -> str:
    """Return the message about a diverged run, in one line; ``stop`` has the last finite ``q`` and ``v``."""
    if stop.time is None or stop.v is None:
        return stop.message
    settings = scenario.simulation
    is_adaptive = settings.integrator == "dormand_prince"
    step = "" if is_adaptive else f", in step {int(stop.time / settings.time_step + 1e-6) + 1}"
    rates = np.asarray(stop.v, dtype=float)
    worst = int(np.argmax(np.abs(rates)))
    name, unit = list(_rates(model))[worst]
    turned = 0.0 if scenario.laws else _fastest_turn(stop, model) * settings.time_step
    shorter = min(1.0, _TURN / max(turned, _TURN)) * settings.time_step
    fixes = ["a smaller tolerance" if is_adaptive else f"a time_step shorter than {shorter:.2g} s"]
    if settings.control_period is not None and scenario.laws:
        fixes += [f"a control_period shorter than {settings.control_period:g} s"]
    fixes += ["lower gains, including those of rates"] if scenario.laws else []
    fixes += ["lower initial rates"] if turned > 1.0 else []
    is_damped = any(joint.damping > 0.0 for joint in model.joints)
    fixes += ["less joint damping"] if is_damped and not is_adaptive else []
    has_springs = any(joint.stiffness or joint.cubic_stiffness for joint in model.joints)
    fixes += ["softer springs at joints"] if has_springs and not is_adaptive else []
    return (
        f"the run diverged at t = {stop.time:.6g} s{step}: the state is not finite; the largest rate "
        f"in the last finite state is that of {name}, {rates[worst]:.3g} {unit}; try {', or '.join(fixes)}"
    )


def _fastest_turn(stop: SimulationError, model: Model) -> float:
    """Return the largest initial angular rate about an axis of the base or of a revolute joint, rad/s.

    Later rates are a result of the divergence. If no row was recorded, the last finite state is used.
    """
    has_rows = stop.trace is not None and len(stop.trace) > 0
    start = np.asarray(stop.trace.v)[0] if has_rows else np.asarray(stop.v)
    is_angular = [unit == "rad/s" for _, unit in _rates(model)]
    return float(np.abs(start[is_angular]).max())


def _rates(model: Model) -> Iterator[tuple[str, str]]:
    """Yield a description and the unit of each entry of ``v``."""
    for kind, unit in _BASE:
        for axis in "xyz":
            yield f"the base's {kind} motion along {axis}", unit
    for joint in model.joints:
        yield f"joint {joint.name!r}", "m/s" if joint.kind == "prismatic" else "rad/s"
