"""One YAML, checked before anything runs, and the objects built from it."""

from __future__ import annotations

from onorbit_rs.scenario.load import load
from onorbit_rs.scenario.schema import Scenario

__all__ = ["Scenario", "load"]
