"""Recordings for the rerun viewer. This folder alone imports rerun."""

from __future__ import annotations

from onorbit_rs.viewer.blueprint import TIMELINE
from onorbit_rs.viewer.recording import recorded_rows, write_recording
from onorbit_rs.viewer.screenshot import take_screenshot

__all__ = ["TIMELINE", "recorded_rows", "take_screenshot", "write_recording"]
