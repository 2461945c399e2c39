"""Whether the certificate of a run is green: every balance within its limit."""

from __future__ import annotations

from collections.abc import Mapping

LIMITS = {
    "linear_momentum_drift_rel": 1e-9,
    "angular_momentum_drift_rel": 1e-9,
    "energy_balance_error_rel": 1e-6,
}
"""Largest value that passes."""


def failures(certificate: Mapping[str, float]) -> list[str]:
    """Names of the balances that are open: above their limit or not finite."""
    return [
        name for name, limit in LIMITS.items() if name in certificate and not abs(certificate[name]) <= limit
    ]
