"""Entries of a summary for the report: label, unit and formatted value."""

from __future__ import annotations

import math
import re
from typing import Any, NamedTuple

from onorbit_rs.common.display_units import digits, with_prefix
from onorbit_rs.output.checks import CHECKS
from onorbit_rs.output.summary_labels import goal_of, tracking

# longest first, because `_rad_s` also ends in `_s`
_UNITS = (
    ("_nms", "N m s"), ("_ns", "N s"),
    ("_rad_s", "rad/s"), ("_m_s2", "m/s²"), ("_m_s", "m/s"), ("_nm", "N m"), ("_rad", "rad"),
    ("_rel", "relative"), ("_m", "m"), ("_s", "s"), ("_j", "J"), ("_n", "N"),
)  # fmt: skip
_LEAST_SCALED = 1e-9
"""Smallest value shown with a unit prefix; smaller values are rounding errors, shown with an exponent."""
_SCALED = ("m", "rad", "N m", "N", "J", "m/s²", "rad/s", "m/s", "N s", "N m s")
_NAMES = {
    "wall_s": "wall-clock time of the loop",
    "real_time_factor": "real-time factor",
    "base_rotation_max_rad": "base rotation in W, largest",
    "base_displacement_max_m": "base displacement in W, largest",
    "joint_force_max_n": "force of a prismatic joint, largest",
    "joint_rate_final_max_m_s": "rate of a prismatic joint at the end, largest",
    "rows": "rows of the trace",
    "rereferenced": "changes of reference orbit due to drift",
    "velocity_eci_source": "inertial velocity from",
    "onorbit_rs_version": "onorbit_rs",
    "python_version": "Python",
    "numpy_version": "numpy",
}
_GROUPS = (
    ("Tracking", ("tracking_", "control_")),
    ("Motion", ("joint_", "base_")),
    ("Closed loops", ("loop_",)),
    ("Orbit", ("inertial_axes", "velocity_eci", "gravity_mode", "reference_residual", "rereferenced")),
    (
        "Simulation",
        ("simulated_s", "wall_s", "real_time_factor", "rows", "time_step_s", "integrator", "engine"),
    ),
    (
        "Versions",
        (
            "onorbit_rs_version",
            "instruction_set",
            "python_version",
            "numpy_version",
            "mujoco_version",
            "robot_fingerprint",
        ),
    ),
)
_ONLY_IF_ANY = ("rereferenced", "joint_dissipation_j")
"""Entries that are omitted if their value is 0."""
_ELSEWHERE = ("scenario", "status", "warnings", *CHECKS)


class Row(NamedTuple):
    """A row of a table; ``shown`` is the formatted ``value``."""

    key: str
    name: str
    value: Any
    shown: str
    unit: str


def groups(summary: dict[str, Any]) -> list[tuple[str, list[Row]]]:
    """Return every entry of a summary that is not shown elsewhere on the page, by heading."""
    left = {key: value for key, value in summary.items()
            if key not in _ELSEWHERE and not key.startswith("certificate_")}  # fmt: skip
    found = []
    for title, starts in _GROUPS:
        rows = [
            row(key, value)
            for key, value in left.items()
            if key.startswith(starts) and not (key in _ONLY_IF_ANY and value == 0)
        ]
        left = {key: value for key, value in left.items() if not key.startswith(starts)}
        found.append((title, rows))
    found.append(("Other", [row(key, value) for key, value in left.items()]))
    return [(title, rows) for title, rows in found if rows]


def row(key: str, value: Any) -> Row:
    """Return one entry of a summary as a table row; its unit follows from the ending of the key."""
    ending, unit = next(((ending, unit) for ending, unit in _UNITS if key.endswith(ending)), ("", ""))
    words = _NAMES.get(key) or _words(key, key.removesuffix(ending))
    shown = value.replace("_", " ") if goal_of(key) and isinstance(value, str) else value
    if unit in _SCALED and isinstance(value, float) and _LEAST_SCALED <= abs(value) < 0.5:
        factor, unit = with_prefix(abs(value), unit)
        shown = factor * value
    if unit in ("rad", "mrad") and isinstance(value, float) and abs(value) > 0.01:
        unit += f" ({math.degrees(value):.3g}°)"
    return Row(key, words, value, _shown(shown), "" if unit == "relative" else unit)


def _words(key: str, stem: str) -> str:
    error, owner = tracking(key), goal_of(key)
    if error is not None:
        return error.label
    if owner is not None:
        return f"{owner}: goal"
    return re.sub(r" max$", ", largest", re.sub(r" final\b", " at the end", stem.replace("_", " ")))


def _shown(value: Any) -> str:
    if value is None:
        return "not finite"
    if isinstance(value, bool):
        return "yes" if value else "no"
    if not isinstance(value, float):
        return str(value) if value != "" else "none"
    return digits(value)
