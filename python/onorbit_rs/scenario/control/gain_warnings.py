"""Warnings about gains that are too high for the control period.

Torques are held for the control period `h`. For a double integrator under `a = -kp e - kd ė`, the error and
rate at the next sample are linear in those at the present sample, and by Jury's criterion they decay only if
`kp h / 2 < kd < 2 / h`. Errors therefore grow above `kd h = 2` and, for any damping, above `kp h² = 4`.

Source: Franklin, Powell and Workman, Digital Control of Dynamic Systems, 3rd ed., 1998 (zero-order hold).
"""

from __future__ import annotations

from collections.abc import Iterator
from typing import TYPE_CHECKING

import numpy as np

from onorbit_rs.scenario.control.initial_mobility import InitialMobility

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from onorbit_rs._core import Model
    from onorbit_rs.scenario.schema import Scenario

_ROUNDING = 1e-9


def gain_warnings(scenario: Scenario, model: Model, q: NDArray[np.float64]) -> Iterator[str]:
    """Yield a warning for each gain with which errors would grow, given the robot's initial inertia."""
    settings = scenario.simulation
    period = settings.control_period or settings.time_step
    mobility = InitialMobility(model, q, scenario.tool, scenario.reference)
    for index, law in enumerate(scenario.laws):
        where = "controller" if scenario.controllers is None else f"controllers[{index}]"
        for name, order, matrix in law.sampled_gains(mobility):
            # kd h, or sqrt(kp) h
            if not np.isfinite(matrix).all():  # overflow: the run raises an error
                continue
            rate = float(np.abs(np.linalg.eigvals(matrix)).max(initial=0.0)) ** (1.0 / order)
            if rate * period > 2.0 * (1.0 + _ROUNDING):
                yield (
                    f"{where}.{name} corrects errors at a rate of {rate:.3g} 1/s; with a control period of "
                    f"{period:g} s, the product of both is {rate * period:.3g}, and errors grow if this "
                    f"product exceeds 2; use a control_period below {2.0 / rate:.2g} s, or a smaller gain"
                )
