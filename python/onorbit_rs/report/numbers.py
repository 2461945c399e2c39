"""The summary of a run in words: what a key means, its unit, and its number as a person reads it."""

from __future__ import annotations

import math
from typing import Any, NamedTuple

from onorbit_rs.output.summary import CHECKS

# longest first: `_rad_s` ends in `_s` too
_UNITS = (
    ("_rad_s", "rad/s"), ("_m_s2", "m/s²"), ("_nm", "N m"), ("_rad", "rad"), ("_rel", "relative"),
    ("_m", "m"), ("_s", "s"), ("_j", "J"),
)  # fmt: skip
_GROUPS = (
    ("Tracking", ("tracking_", "control_")),
    ("Motion", ("joint_", "base_")),
    ("Orbit", ("inertial_axes", "velocity_eci", "gravity_mode", "reference_residual", "rereferenced")),
    (
        "Simulation",
        ("simulated_s", "wall_s", "real_time_factor", "rows", "time_step_s", "integrator", "plant"),
    ),
    ("Versions", ("onorbit_rs_version", "instruction_set", "python_version", "numpy_version")),
)
_ELSEWHERE = ("scenario", "status", "warnings", *CHECKS)


class Row(NamedTuple):
    """A line of a table; ``shown`` is ``value`` as a person reads it."""

    key: str
    name: str
    value: Any
    shown: str
    unit: str


def groups(summary: dict[str, Any]) -> list[tuple[str, list[Row]]]:
    """Every entry of a summary that the page does not show elsewhere, under a heading."""
    left = {key: value for key, value in summary.items()
            if key not in _ELSEWHERE and not key.startswith("certificate_")}  # fmt: skip
    found = []
    for title, starts in _GROUPS:
        rows = [row(key, value) for key, value in left.items() if key.startswith(starts)]
        left = {key: value for key, value in left.items() if not key.startswith(starts)}
        found.append((title, rows))
    found.append(("Other", [row(key, value) for key, value in left.items()]))
    return [(title, rows) for title, rows in found if rows]


def row(key: str, value: Any) -> Row:
    """One entry with its unit, which its key ends in."""
    ending, unit = next(((ending, unit) for ending, unit in _UNITS if key.endswith(ending)), ("", ""))
    name = key.removesuffix(ending) if unit != "relative" else key.removesuffix("_rel")
    words = name.replace("_eci_", " inertial ").replace("_", " ")
    return Row(key, words, value, _shown(value, unit), "" if unit == "relative" else unit)


def _shown(value: Any, unit: str) -> str:
    if value is None:
        return "not finite"
    if isinstance(value, bool):
        return "yes" if value else "no"
    if not isinstance(value, float):
        return str(value) if value != "" else "none"
    text = f"{value:.4g}"
    return f"{text} ({math.degrees(value):.3g}°)" if unit == "rad" and abs(value) > 1e-3 else text


def checks(summary: dict[str, Any]) -> list[tuple[Row, bool | None]]:
    """Every line of the certificate, and whether it holds; None where it does not apply to the run."""
    failed = {name.strip() for name in str(summary.get("certificate_failures") or "").split(",")}
    absent = {name.strip() for name in str(summary.get("certificate_not_evaluated") or "").split(",")}
    rows: list[tuple[Row, bool | None]] = []
    for name in CHECKS:
        if name in summary:
            rows.append((row(name, summary[name]), name not in failed))
        elif name in absent:
            rows.append((Row(name, row(name, None).name, None, "not evaluated", ""), None))
    return rows
