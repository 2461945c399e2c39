"""The lines of a run's certificate: what each is called, its unit, its gate, and whether it holds."""

from __future__ import annotations

from typing import Any, NamedTuple

GATE = "certificate_gate_"
"""Before a check's key: the entry of a summary that says what it may be at most."""

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
}
"""Every line a certificate can have, and its unit; a run leaves out those that do not apply to it."""

JOINTS = ("joint_step_doubling_rel",)
"""Lines that a robot without joints does not have."""

SUSPECT = 0.1
"""From this share of its gate on, a difference of steps and halved steps makes the step a suspect."""


class Check(NamedTuple):
    """A line; ``holds`` is None where it does not apply, ``gate`` where an older run left it out."""

    key: str
    name: str
    value: float | None
    gate: float | None
    unit: str
    holds: bool | None


def checks(summary: dict[str, Any]) -> list[Check]:
    """Every line of the certificate in a summary."""
    failed, absent = (_names(summary, f"certificate_{what}") for what in ("failures", "not_evaluated"))
    found = []
    for key, unit in CHECKS.items():
        name = key.removesuffix("_rel").removesuffix("_rad").replace("_", " ")
        if key in summary:
            gate = summary.get(GATE + key)
            found.append(Check(key, name, summary[key], gate, unit, key not in failed))
        elif key in absent:
            found.append(Check(key, name, None, None, unit, None))
    return found


def is_incomplete(summary: dict[str, Any]) -> bool:
    """Whether lines that apply to the run were not evaluated."""
    return any(check.holds is None for check in checks(summary))


def advice(summary: dict[str, Any]) -> str:
    """What to do about a certificate that failed; empty where the summary lacks the integrator's settings.

    A shorter step is named only where steps and halved steps differ, or were not compared.
    """
    if summary.get("integrator") == "dormand_prince":
        return "try a smaller tolerance"
    step = summary.get("time_step_s")
    if not isinstance(step, (int, float)):
        return ""
    shares = [_share(check) for check in checks(summary) if "step_doubling" in check.key]
    if not shares or max(shares) >= SUSPECT:
        return f"try a time_step shorter than {step:g} s"
    return (
        "halved steps give the same motion, so a shorter time_step will not help; check a plant or effects "
        "of your own, else please report it"
    )


def _share(check: Check) -> float:
    """The value as a share of its gate; infinite where that is not known."""
    if check.value is None or not check.gate:
        return 0.0 if check.holds else float("inf")
    return check.value / check.gate


def _names(summary: dict[str, Any], key: str) -> set[str]:
    return {name.strip() for name in str(summary.get(key) or "").split(",")}
