"""Checks of a certificate in a summary: name, unit, gate, and whether each passed."""

from __future__ import annotations

from typing import Any, NamedTuple

GATE = "certificate_gate_"
"""Prefix of the summary key of a check's gate, the largest value that passes."""

CHECKS = {
    "linear_momentum_drift_rel": "relative",
    "angular_momentum_drift_rel": "relative",
    "energy_balance_error_rel": "relative",
    "center_of_mass_error_rel": "relative",
    "base_rows_residual_rel": "relative",
    "attitude_consistency": "relative",
    "attitude_step_doubling_rad": "rad",
    "joint_step_doubling_rel": "relative",
    "position_step_doubling_rel": "relative",
    "loop_opening": "m or rad",
}
"""Unit of every check that a certificate can have; checks that do not apply to a run are omitted."""

JOINTS = ("joint_step_doubling_rel",)
"""Checks that do not apply to a robot without joints."""

LOOPS = ("loop_opening",)
"""Checks that apply only to robots with closed loops or mimic joints, for which they are always evaluated."""

SUSPECT = 0.1
"""Smallest ratio of the step-doubling error to its gate that suggests that the time step is too long."""


class Check(NamedTuple):
    """One check of a certificate; ``holds`` is None if it was not evaluated, ``gate`` if it is unknown."""

    key: str
    name: str
    value: float | None
    gate: float | None
    unit: str
    holds: bool | None


def checks(summary: dict[str, Any]) -> list[Check]:
    """Return every check of the certificate in a summary."""
    failed, absent = (_names(summary, f"certificate_{what}") for what in ("failures", "not_evaluated"))
    found = []
    for key, unit in CHECKS.items():
        name = _in_words(key)
        if key in summary:
            gate = summary.get(GATE + key)
            found.append(Check(key, name, summary[key], gate, unit, key not in failed))
        elif key in absent:
            found.append(Check(key, name, None, None, unit, None))
    return found


def world_checks(summary: dict[str, Any]) -> list[Check]:
    """Return the checks of groups and events in the summary of a world; their names begin with ``OWNER/``."""
    found = []
    for row in summary["certificate"]:
        owner, _, key = row["name"].rpartition("/")
        values = (row["value"], row["gate"], row["unit"], row["passed"])
        found.append(Check(row["name"], f"{owner}/{_in_words(key)}", *values))
    return found


def _in_words(key: str) -> str:
    return key.removesuffix("_rel").removesuffix("_rad").replace("_", " ")


def is_incomplete(summary: dict[str, Any]) -> bool:
    """Return True if checks that apply to the run were not evaluated."""
    if "systems" in summary:
        return summary.get("certificate_complete") is False
    return any(check.holds is None for check in checks(summary))


def advice(summary: dict[str, Any]) -> str:
    """Return advice for a failed certificate; empty if the summary contains no time step.

    A shorter step is suggested only if halving the step changes the motion, or if that was not evaluated.
    """
    if summary.get("engine") == "mujoco" and any(
        event["kind"] == "capture" for event in summary.get("events", ())
    ):
        return (
            "the connections of the engine mujoco are soft, so a shorter time_step will not make them exact; "
            "a longer weld_time_constant reduces the error of the energy balance, and the native engine has "
            "exact connections"
        )
    if summary.get("integrator") == "dormand_prince":
        return "try a smaller tolerance"
    step = summary.get("time_step_s")
    if not isinstance(step, (int, float)):
        return ""
    parts = summary.get("systems", {"": summary}).values()
    found = [check for part in parts for check in checks(part)]
    ratios = [_gate_ratio(check) for check in found if "step_doubling" in check.key]
    if not ratios or max(ratios) >= SUSPECT:
        return f"try a time_step shorter than {step:g} s"
    return (
        "halving the step does not change the motion, so a shorter time_step will not help; check custom "
        "engines and effects, or report a bug"
    )


def _gate_ratio(check: Check) -> float:
    """Return the ratio of value to gate; if either is unknown, 0 if the check holds, otherwise infinity."""
    if check.value is None or not check.gate:
        return 0.0 if check.holds else float("inf")
    return check.value / check.gate


def _names(summary: dict[str, Any], key: str) -> set[str]:
    return {name.strip() for name in str(summary.get(key) or "").split(",")}
