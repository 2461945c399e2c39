"""Reads and validates scenarios, and builds the objects of the engine from them."""

from __future__ import annotations

from onorbit_rs.scenario.load import load
from onorbit_rs.scenario.schema import Scenario
from onorbit_rs.scenario.world import WorldScenario

__all__ = ["Scenario", "WorldScenario", "load"]
