"""Writes the files of a run."""

from __future__ import annotations

import json
from pathlib import Path
from types import MappingProxyType
from typing import TYPE_CHECKING, Any

import numpy as np
import yaml

from onorbit_rs import _core
from onorbit_rs.output.folder import OutputFolder
from onorbit_rs.output.manifest import FIGURES, RECORDING, SCENARIO, SUMMARY, TRACE
from onorbit_rs.output.pickling import arrays_of
from onorbit_rs.output.replacement import Replacement
from onorbit_rs.output.world import world_arrays
from onorbit_rs.scenario.build import Built
from onorbit_rs.scenario.build_world import BuiltWorld
from onorbit_rs.scenario.connections import connections, touching

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable, Mapping

    from onorbit_rs._core import Trace, WorldTrace
    from onorbit_rs.figures import Drawing
    from onorbit_rs.scenario import Scenario, WorldScenario


def write_scenario(folder: OutputFolder, scenario: Scenario | WorldScenario) -> None:
    """Write ``scenario.yaml`` with all defaults, SI units and absolute paths, to run from any folder."""
    source = scenario.file or "Python"
    header = f"# resolved by onorbit_rs from {source}; run it again with: onorbit run scenario.yaml\n"
    with folder.writing(SCENARIO) as path:
        text = yaml.safe_dump(
            with_absolute_paths(scenario),
            sort_keys=False,
            default_flow_style=None,
            width=110,
            allow_unicode=True,
        )
        path.write_text(header + text, encoding="utf-8")


def write_trace(
    files: Replacement, trace: Trace | WorldTrace, more: Mapping[str, Any] = MappingProxyType({})
) -> None:
    """Write ``trace.npz``, which contains every column of the trace by path, and the columns ``more``."""
    with files.writing(TRACE) as path, path.open("wb") as stream:
        if isinstance(trace, _core.WorldTrace):
            columns = world_arrays(trace)
        else:
            columns = arrays_of(trace)
            if len(trace.rereferenced):
                columns["rereferenced"] = np.asarray(trace.rereferenced)
        np.savez(stream, allow_pickle=False, **columns, **more)


def write_summary(files: Replacement, summary: dict[str, Any]) -> None:
    """Write ``summary.json``."""
    with files.writing(SUMMARY) as path:
        path.write_text(json.dumps(summary, indent=2, allow_nan=False) + "\n", encoding="utf-8")


def write_pictures(
    folder: OutputFolder,
    trace: Trace | WorldTrace,
    summary: dict[str, Any],
    built: Built | BuiltWorld,
    *,
    tell: Callable[[str], None] = lambda doing: None,
) -> None:
    """Write the figures, if the trace has several rows, and the recording; ``tell`` is called with each task.

    For a world, the file names of a system's figures begin with the name of the system.
    """
    if isinstance(trace, _core.WorldTrace):
        assert isinstance(built, BuiltWorld)
        _write_pictures_of_world(folder, trace, summary, built, tell)
        return
    assert isinstance(built, Built)
    _write_figures(folder, trace, built, "", tell)
    from onorbit_rs import viewer  # imported here because rerun takes a second to import

    tell("writing the recording")
    with folder.writing(RECORDING) as path:
        setting = viewer.Setting.of(built)
        viewer.write_recording(path, trace, setting, notes=viewer.notes(summary, built.scenario))


def _write_pictures_of_world(
    folder: OutputFolder,
    trace: WorldTrace,
    summary: dict[str, Any],
    built: BuiltWorld,
    tell: Callable[[str], None],
) -> None:
    """Write the figures of all systems together, those of each system, and the recording."""
    from onorbit_rs import figures

    if len(trace.time) > 1:
        models = {name: alone.model for name, alone in built.systems.items()}
        events, found = figures.marks_of(summary), connections(built.scenario)
        subject = figures.WorldSubject(trace, models, events, found, touching(built.scenario, models))
        _draw(folder, figures.world_drawings(subject), "", tell)
    for name, alone in built.systems.items():
        _write_figures(folder, trace[name], alone, f"{name}_", tell)
    from onorbit_rs import viewer

    tell("writing the recording")
    with folder.writing(RECORDING) as path:
        text = viewer.world_notes(summary, built.scenario)
        viewer.write_world_recording(path, trace, viewer.WorldSetting.of(built), notes=text)


def _write_figures(
    folder: OutputFolder, trace: Trace, built: Built, prefix: str, tell: Callable[[str], None]
) -> None:
    from onorbit_rs import figures  # imported here because matplotlib takes a second to import

    if len(trace.time) > 1:
        subject = figures.subject_of(trace, built.scenario, built.model, built.orbit, built.earth)
        _draw(folder, figures.drawings(subject), prefix, tell)


def _draw(
    folder: OutputFolder, drawings: Iterable[Drawing], prefix: str, tell: Callable[[str], None]
) -> None:
    """Write figures as PNG."""
    from onorbit_rs import figures

    with folder.replacing() as files:
        for drawing in drawings:
            tell(f"drawing {prefix}{drawing.name}")
            with files.writing(f"{FIGURES}/{prefix}{drawing.name}.png") as path:
                path.write_bytes(figures.as_bytes(drawing.draw(), "png"))


def with_absolute_paths(scenario: Scenario | WorldScenario) -> dict[str, Any]:
    """Return the resolved scenario with absolute paths and explicit control periods."""
    data = scenario.resolved(scenario.file.parent if scenario.file else Path())
    step = data["simulation"]["time_step"]
    for settings in data["systems"].values() if "systems" in data else [data["simulation"]]:
        settings.setdefault("control_period", step)
    return data
