"""Summary of a run: a flat mapping; the keys of quantities end in their unit."""

from __future__ import annotations

import platform
from typing import TYPE_CHECKING, Any

import numpy as np

from onorbit_rs import _core
from onorbit_rs.common.blocks import largest
from onorbit_rs.common.coordinates import BASE_NQ, POSITION, QUATERNION
from onorbit_rs.common.printable import json_value
from onorbit_rs.common.rotations import angle_between
from onorbit_rs.engines import versions
from onorbit_rs.output.checks import CHECKS, GATE, JOINTS, LOOPS
from onorbit_rs.output.joints import (
    efforts_at_limit,
    joint_errors,
    joint_loads,
    loads_exceeded,
    single_errors,
)
from onorbit_rs.robots.fingerprint import fingerprint
from onorbit_rs.scenario.control import GripForceController, JointLaw

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from onorbit_rs._core import Orbit, Trace, WorldTrace
    from onorbit_rs.scenario import Scenario, WorldScenario
    from onorbit_rs.scenario.build import Built

    Floats = NDArray[np.float64]

Summary = dict[str, Any]


def summarize(
    trace: Trace,
    built: Built,
    *,
    status: str = "complete",
) -> Summary:
    """Return the summary of a run.

    Parameters
    ----------
    trace : Trace
        Trace of the run.
    built : Built
        The scenario and the objects built from it.
    status : str
        ``complete``, ``interrupted`` (Ctrl-C or a signal), ``diverged``, or ``failed`` if another error ended
        the run, such as an error of a custom controller, the orbit or the environment.

    Returns
    -------
    dict
        Content of ``summary.json``, with None for non-finite numbers. ``wall_s`` is the wall-clock time
        of the simulation loop, s.
    """
    scenario = built.scenario
    summary = (
        {"scenario": scenario.name, "status": status}
        | _tracking(trace)
        | single_errors(trace, built)
        | _controls(trace, built)
        | _motion(trace, built)
        | _losses(trace, built)
        | _loops(trace)
        | _certificate(trace)
        | {"rereferenced": len(trace.rereferenced)}
        | run_numbers(trace, scenario)
        | _orbit(trace, scenario, built.orbit)
        | {
            "warnings": "\n".join((*built.model.warnings, *built.warnings)),
            "robot_fingerprint": fingerprint(built.model),
        }
    )
    return {key: json_value(value) for key, value in summary.items()}


def _certificate(trace: Trace) -> Summary:
    """Return the evaluated checks, their gates, the verdict, and the names of failed and missing checks."""
    rows = trace.certificate()
    balances: Summary = {name: value for name, value, _, _ in rows if value is not None}
    gates = {GATE + name: gate for name, value, gate, _ in rows if value is not None}
    failed = [name for name, _, _, passed in rows if not passed]
    has_joints = np.shape(trace.q)[1] > BASE_NQ
    inapplicable = LOOPS if has_joints else JOINTS + LOOPS
    absent = [name for name in CHECKS if name not in balances and name not in inapplicable]
    return (
        balances
        | {
            "certificate_passed": not failed,
            "certificate_failures": ", ".join(failed),
            "certificate_complete": not absent,
            "certificate_not_evaluated": ", ".join(absent),
        }
        | gates
    )


def _tracking(trace: Trace) -> Summary:
    if "position_error" not in trace.columns():
        return {}
    position, attitude = trace.position_error, trace.attitude_error
    return {
        "tracking_position_error_max_m": largest(_norms, position),
        "tracking_position_error_final_m": _norms(position[-1:])[0],
        "tracking_attitude_error_max_rad": largest(_norms, attitude),
        "tracking_attitude_error_final_rad": _norms(attitude[-1:])[0],
    }


def _norms(rows: Floats) -> Floats:
    """Return the magnitude of each row."""
    magnitudes: Floats = np.linalg.norm(rows, axis=1)
    return magnitudes


def _controls(trace: Trace, built: Built) -> Summary:
    """Return the tracking errors of ``controllers`` and the outcomes of their goals, if they have any.

    The errors are the largest ones; for a control of a grip force, the error is that at the end.
    """
    scenario = built.scenario
    if scenario.controllers is None:
        return {}
    summary: Summary = {}
    for control in scenario.controllers:
        errors = trace.tracking.get(control.name, np.empty((0, 0)))
        if not np.size(errors):
            continue
        key = f"tracking_{control.name}"
        if isinstance(control, JointLaw):
            summary |= joint_errors(key, errors, built, control.joints, are_rates=control.tracks_rates)
        elif isinstance(control, GripForceController):
            summary[f"{key}_force_error_final_n"] = errors[-1, 0]
        else:
            summary[f"{key}_position_error_max_m"] = largest(lambda rows: _norms(rows[:, :3]), errors)
            summary[f"{key}_attitude_error_max_rad"] = largest(lambda rows: _norms(rows[:, 3:]), errors)
    with_goals = {control.name for control in scenario.controllers if control.goal is not None}
    results = {f"control_{result['name']}_result": result["outcome"] for result in trace.results
               if result["name"] in with_goals}  # fmt: skip
    return summary | results


def _motion(trace: Trace, built: Built) -> Summary:
    start = np.array(trace.q[0])
    motion = joint_loads(trace, built) | efforts_at_limit(trace, built)
    motion["base_rotation_max_rad"] = largest(
        lambda q: angle_between(q[:, QUATERNION], start[QUATERNION]), trace.q
    )
    motion["base_displacement_max_m"] = largest(lambda q: _norms(q[:, POSITION] - start[POSITION]), trace.q)
    return motion


def _losses(trace: Trace, built: Built) -> Summary:
    """Return the energy dissipated in the joints, J, and the joints beyond a limit; empty without joints."""
    if np.shape(trace.q)[1] == BASE_NQ:
        return {}
    losses: Summary = {}
    if "dissipated" in trace.columns():
        losses["joint_dissipation_j"] = float(trace.dissipated[-1])
        losses["joint_limits_exceeded"] = ", ".join(trace.joint_limits_exceeded())
    return losses | loads_exceeded(trace, built.model)


def _loops(trace: Trace) -> Summary:
    """Return the largest force, N, moment, N m, and opening, m and rad, of every closed loop."""
    loops: Summary = {}
    for name, loop in trace.loops.items():
        distance, angle = largest(lambda rows: rows, loop.opening)
        for what, value in (
            ("force_max_n", largest(_norms, loop.force)),
            ("moment_max_nm", largest(_norms, loop.moment)),
            ("opening_max_m", distance),
            ("opening_angle_max_rad", angle),
        ):
            loops[f"loop_{name}_{what}"] = value
    return loops


def run_numbers(trace: Trace | WorldTrace, scenario: Scenario | WorldScenario) -> Summary:
    """Return the duration, wall-clock time, number of rows, settings and software versions of a run."""
    simulated_s, settings = float(trace.time[-1] - trace.time[0]), scenario.simulation
    return (
        {"simulated_s": simulated_s, "wall_s": trace.wall_s}
        | {"real_time_factor": simulated_s / max(trace.wall_s, 1e-9), "rows": len(trace.time)}
        | versions(scenario.engine)
        | {"time_step_s": settings.time_step, "integrator": settings.integrator}
        | _versions()
    )


def _orbit(trace: Trace, scenario: Scenario, orbit: Orbit | None) -> Summary:
    """Return the entries of the summary about the orbit; empty without an orbit.

    They are the inertial axes, the source of the inertial velocity, the gravity mode if the orbit has a
    gravitational parameter, and the largest residual acceleration of the reference, m/s², if it was recorded.
    """
    if orbit is None:
        return {}
    summary: Summary = {"inertial_axes": orbit.axes, "velocity_eci_source": orbit.velocity_source}
    if orbit.mu is not None:
        summary["gravity_mode"] = scenario.gravity_mode
    if "reference_residual" in trace.columns():
        summary["reference_residual_max_m_s2"] = largest(_norms, trace.reference_residual)
    return summary


def _versions() -> Summary:
    info = _core.build_info()
    return {
        "onorbit_rs_version": info["version"],
        "instruction_set": info["instruction_set"],
        "python_version": platform.python_version(),
        "numpy_version": np.__version__,
    }
