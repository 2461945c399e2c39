"""Drafts a first scenario for a robot, or for a robot that captures another robot, and tests the draft."""

from __future__ import annotations

from onorbit_rs.tools.new_scenario.capture import CaptureDraft, draft_capture
from onorbit_rs.tools.new_scenario.source import Source
from onorbit_rs.tools.new_scenario.write import Draft, draft

__all__ = ["CaptureDraft", "Draft", "Source", "draft", "draft_capture"]
