"""Drafts a first scenario for a robot: arm, initial pose and motion, tested by trial runs."""

from __future__ import annotations

from onorbit_rs.tools.new_scenario.source import Source
from onorbit_rs.tools.new_scenario.write import Draft, draft

__all__ = ["Draft", "Source", "draft"]
