"""Reads and validates scenarios, and builds the objects of the engine from them."""

from __future__ import annotations

from onorbit_rs.scenario.load import load
from onorbit_rs.scenario.schema import Scenario

__all__ = ["Scenario", "load"]
