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
}
"""Every line a certificate can have, and its unit; a run leaves out those that do not apply to it."""


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


def way_out(summary: dict[str, Any]) -> str:
    """What to try where balances do not hold; empty where the summary has not the integrator's settings."""
    if summary.get("integrator") == "dormand_prince":
        return "a smaller tolerance"
    step = summary.get("time_step_s")
    return f"a time_step shorter than {step:g} s" if isinstance(step, (int, float)) else ""


def _names(summary: dict[str, Any], key: str) -> set[str]:
    return {name.strip() for name in str(summary.get(key) or "").split(",")}
