"""Gains that are too high for how often the controller runs.

A correction is held for the control period `h`. Of a double integrator under `a = -kp e - kd ė` the next
error and rate are linear in the last, and by Jury's criterion both shrink only where `kp h / 2 < kd < 2 / h`.
So beyond `kd h = 2`, and beyond `kp h² = 4` whatever the damping, errors grow from sample to sample.

Source: Franklin, Powell and Workman, Digital Control of Dynamic Systems, 3rd ed., 1998 (zero-order hold).
"""

from __future__ import annotations

from collections.abc import Iterator
from typing import TYPE_CHECKING, Any, Literal

import numpy as np

from onorbit_rs.scenario import control as laws
from onorbit_rs.scenario.make_control import columns_of, tool_of

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from onorbit_rs._core import Model
    from onorbit_rs.scenario.schema import Scenario

    Floats = NDArray[np.float64]

_ROUNDING = 1e-9


def sampled_too_slowly(scenario: Scenario, model: Model, q: Floats) -> Iterator[str]:
    """A line for each gain under which errors will grow, by the robot's inertia at the start."""
    settings = scenario.simulation
    period = settings.control_period or settings.time_step
    for index, law in enumerate(scenario.laws):
        where = "controller" if scenario.controllers is None else f"controllers[{index}]"
        for name, order, matrix in _gains(law, scenario, model, q):
            # kd h, or sqrt(kp) h
            if not np.isfinite(matrix).all():  # the products overflow: the engine says so when it runs
                continue
            rate = float(np.abs(np.linalg.eigvals(matrix)).max(initial=0.0)) ** (1.0 / order)
            if rate * period > 2.0 * (1.0 + _ROUNDING):
                yield (
                    f"{where}.{name} corrects errors at {rate:.3g} 1/s and is held for a control period of "
                    f"{period:g} s, the product of which is {rate * period:.3g}: above 2 errors grow instead "
                    f"of shrinking. Take a control_period below {2.0 / rate:.2g} s, or a smaller gain"
                )


def _gains(
    law: Any, scenario: Scenario, model: Model, q: Floats
) -> Iterator[tuple[str, Literal[1, 2], Floats]]:
    """The key of each gain, and the acceleration that it answers a rate (1) or a position (2) with."""
    joints = len(columns_of(law, model.joint_names))
    if isinstance(law, laws.ComputedTorqueController):
        yield "kd", 1, _square(law.kd, 6)
        yield "kp", 2, _square(law.kp, 6)
        yield "null_space_damping", 1, _square(law.null_space_damping, 1)
    elif isinstance(law, laws.JointComputedTorqueController):
        yield "kd", 1, _square(law.kd, joints)
        yield "kp", 2, _square(law.kp, joints)
    elif isinstance(law, laws.JointPidController) and law.interface != "effort":
        mobility, leads_rates = _joint_mobility(law, model, q), law.interface == "velocity"
        yield "p", 1 if leads_rates else 2, mobility @ _square(law.p, joints)
        if not leads_rates:
            yield "d", 1, mobility @ _square(law.d, joints)
    elif isinstance(law, laws.ComplianceController) and _is_in_w(law, scenario):
        mobility = _tool_mobility(law, scenario, model, q)
        yield "damping", 1, mobility @ _square(law.damping, 6)
        yield "stiffness", 2, mobility @ _square(law.stiffness, 6)


def _joint_mobility(law: Any, model: Model, q: Floats) -> Floats:
    """`(Mmm - Mmb Mbb⁻¹ Mbm)⁻¹` of the law's joints; the others held, which makes no joint lighter."""
    mass = np.asarray(model.mass_matrix(q))
    rows = [6 + column for column in columns_of(law, model.joint_names)]
    coupling = mass[:6][:, rows]
    left = mass[np.ix_(rows, rows)] - coupling.T @ np.linalg.solve(mass[:6, :6], coupling)
    return np.asarray(np.linalg.inv(left), dtype=np.float64)


def _tool_mobility(law: Any, scenario: Scenario, model: Model, q: Floats) -> Floats:
    """`Jg M*⁻¹ Jgᵀ`: what a wrench that the law wants at the tool accelerates it by."""
    tool = tool_of(law, scenario.tool)
    assert tool is not None  # the schema lets no task without one through
    columns = columns_of(law, model.joint_names)
    jacobian = np.asarray(model.free_floating(q, np.zeros(model.nv), tool).jacobian)[:, columns]
    mobility: Floats = jacobian @ _joint_mobility(law, model, q) @ jacobian.T
    return mobility


def _is_in_w(law: Any, scenario: Scenario) -> bool:
    """Not relative to the base, where the Jacobian is another."""
    return getattr(getattr(law, "reference", None) or scenario.reference, "frame", None) != "base"


def _square(gain: Any, size: int) -> Floats:
    """A number, one each, or all of a matrix."""
    gain = np.asarray(gain, dtype=np.float64)
    return gain if gain.ndim == 2 else np.diag(np.broadcast_to(gain, size))
