"""Output folder of a run: scenario, trace, summary, figures, recording and checkpoint."""

from __future__ import annotations

from onorbit_rs.output.checkpoint import (
    CheckpointWriter,
    has_checkpoint,
    read_checkpoint,
    scenario_digest,
)
from onorbit_rs.output.folder import OutputFolder
from onorbit_rs.output.summary import summarize
from onorbit_rs.output.world import summarize_world
from onorbit_rs.output.write import (
    with_absolute_paths,
    write_pictures,
    write_scenario,
    write_summary,
    write_trace,
)

__all__ = [
    "CheckpointWriter",
    "OutputFolder",
    "has_checkpoint",
    "read_checkpoint",
    "scenario_digest",
    "summarize",
    "summarize_world",
    "with_absolute_paths",
    "write_pictures",
    "write_scenario",
    "write_summary",
    "write_trace",
]
