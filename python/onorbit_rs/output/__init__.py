"""The folder a run leaves behind: scenario, trace, summary, figures, recording."""

from __future__ import annotations

from onorbit_rs.output.folder import OutputFolder
from onorbit_rs.output.summary import summarize
from onorbit_rs.output.write import write_pictures, write_scenario, write_summary, write_trace

__all__ = [
    "OutputFolder",
    "summarize",
    "write_pictures",
    "write_scenario",
    "write_summary",
    "write_trace",
]
