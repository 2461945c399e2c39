"""Recordings for the rerun viewer. Only this folder imports rerun."""

from __future__ import annotations

from onorbit_rs.viewer import silence  # noqa: F401  # before rerun is imported
from onorbit_rs.viewer.notes import notes, world_notes
from onorbit_rs.viewer.recording import recorded_rows, write_recording
from onorbit_rs.viewer.setting import Setting
from onorbit_rs.viewer.trace_rows import TIMELINE
from onorbit_rs.viewer.world_recording import write_world_recording
from onorbit_rs.viewer.world_setting import WorldSetting

__all__ = [
    "TIMELINE",
    "Setting",
    "WorldSetting",
    "notes",
    "recorded_rows",
    "world_notes",
    "write_recording",
    "write_world_recording",
]
