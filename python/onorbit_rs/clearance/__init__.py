"""Distances between links and keep-out zones, evaluated on the rows of a trace."""

from onorbit_rs.clearance.evaluate import Clearance, Prepared, clearances, prepare
from onorbit_rs.clearance.intervals import Violation
from onorbit_rs.clearance.watches import KeepOut, MinimumDistance, Watch

__all__ = [
    "Clearance",
    "KeepOut",
    "MinimumDistance",
    "Prepared",
    "Violation",
    "Watch",
    "clearances",
    "prepare",
]
