"""Writes the files of a run."""

from __future__ import annotations

import json
from functools import partial
from pathlib import Path
from types import MappingProxyType
from typing import TYPE_CHECKING, Any, NamedTuple, cast

import numpy as np
import yaml

from onorbit_rs.output.folder import OutputFolder
from onorbit_rs.output.manifest import FIGURES, RECORDING, SCENARIO, SUMMARY, TRACE
from onorbit_rs.output.names import names_of
from onorbit_rs.output.npz import write_arrays
from onorbit_rs.output.painters import Album, painters
from onorbit_rs.output.pickling import arrays_of
from onorbit_rs.output.replacement import Replacement
from onorbit_rs.output.streamed_trace import StreamedTrace, StreamedWorldTrace
from onorbit_rs.output.world import world_arrays
from onorbit_rs.scenario.build import Built
from onorbit_rs.scenario.build_world import BuiltWorld
from onorbit_rs.scenario.connections import connections, touching

if TYPE_CHECKING:
    from collections.abc import Callable, Mapping

    from onorbit_rs._core import Trace, WorldTrace
    from onorbit_rs.figures import Drawing
    from onorbit_rs.scenario import Scenario, WorldScenario


class Outputs(NamedTuple):
    """Selection of the pictures that a run writes, and whether it compresses ``trace.npz``."""

    figures: bool = True
    recording: bool = True
    compress: bool = False


ALL = Outputs()


def write_scenario(folder: OutputFolder, scenario: Scenario | WorldScenario) -> None:
    """Write ``scenario.yaml`` with all defaults, SI units and absolute paths; it runs from any folder."""
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
    files: Replacement,
    trace: Trace | WorldTrace,
    built: Built | BuiltWorld,
    more: Mapping[str, Any] = MappingProxyType({}),
    *,
    compress: bool = False,
) -> None:
    """Write ``trace.npz``, uncompressed or compressed with deflate.

    It contains every column of the trace by path, the columns ``more``, and the names of the joints and
    bodies of each robot.
    """
    alone = built.systems if isinstance(built, BuiltWorld) else {"": built}
    names = {path: values for system, one in alone.items()
             for path, values in names_of(one.model, f"{system}/" if system else "").items()}  # fmt: skip
    with files.writing(TRACE) as path, path.open("wb") as stream:
        if isinstance(built, BuiltWorld):
            columns = world_arrays(cast("WorldTrace", trace))
        else:
            single = cast("Trace", trace)
            columns = arrays_of(single)
            if len(single.rereferenced):
                columns["rereferenced"] = np.asarray(single.rereferenced)
        write_arrays(stream, {**columns, **more, **names}, compress=compress)


def write_summary(files: Replacement, summary: dict[str, Any]) -> None:
    """Write ``summary.json``."""
    with files.writing(SUMMARY) as path:
        path.write_text(json.dumps(summary, indent=2, allow_nan=False) + "\n", encoding="utf-8")


def write_pictures(
    folder: OutputFolder,
    trace: Trace | WorldTrace,
    summary: dict[str, Any],
    built: Built | BuiltWorld,
    wanted: Outputs = ALL,
    *,
    tell: Callable[[str], None] = lambda doing: None,
) -> None:
    """Write the figures and the recording, as ``wanted`` selects; a trace of one row has no figures.

    ``tell`` is called with the description of each task. The figures are drawn by several processes, see
    :mod:`onorbit_rs.output.painters`.

    For a world, the file names of a system's figures begin with the name of the system.
    """
    if isinstance(trace, StreamedTrace | StreamedWorldTrace) and (wanted.figures or wanted.recording):
        trace = cast("Trace | WorldTrace", trace.decimated())
    albums = _albums(trace, summary, built) if wanted.figures else []
    if not albums:
        if wanted.recording:
            _write_recording(folder, trace, summary, built, tell)
        return
    from onorbit_rs.figures.painter import drawings_of

    found = list(drawings_of(albums))
    draw = [partial(_png, drawing) for _, drawing in found]
    with painters(albums, draw) as helpers, folder.replacing() as files:
        if wanted.recording:  # here, because the recording is the largest task
            _write_recording(folder, trace, summary, built, tell)
        tell(f"drawing {len(found)} figures")
        for number, content in helpers.contents():
            name = found[number][0]
            tell(f"drawing {name}")
            with files.writing(f"{FIGURES}/{name}.png") as path:
                path.write_bytes(content)


def _png(drawing: Drawing) -> bytes:
    from onorbit_rs import figures

    return figures.as_bytes(drawing.draw(), "png")


def _albums(trace: Trace | WorldTrace, summary: dict[str, Any], built: Built | BuiltWorld) -> list[Album]:
    """Return the figures of all systems together and those of each system; a trace of one row has none."""
    from onorbit_rs import figures  # imported here because matplotlib takes a second to import

    def alone(prefix: str, own: Trace, one: Built) -> list[Album]:
        if len(own.time) < 2:
            return []
        subject = figures.subject_of(own, one.scenario, one.model, one.orbit, one.earth)
        if isinstance(built, BuiltWorld):
            whole = cast("WorldTrace", trace)
            subject = figures.with_fingers(subject, prefix.removesuffix("_"), built.scenario, whole)
        return [Album(prefix, subject)]

    if isinstance(built, Built):
        return alone("", cast("Trace", trace), built)
    albums = []
    trace = cast("WorldTrace", trace)
    if len(trace.time) > 1:
        models = {name: one.model for name, one in built.systems.items()}
        events, found = figures.marks_of(summary), connections(built.scenario)
        shared = figures.WorldSubject(trace, models, events, found, touching(built.scenario, models))
        albums.append(Album("", shared))
    for name, one in built.systems.items():
        albums += alone(f"{name}_", trace[name], one)
    return albums


def _write_recording(
    folder: OutputFolder,
    trace: Trace | WorldTrace,
    summary: dict[str, Any],
    built: Built | BuiltWorld,
    tell: Callable[[str], None],
) -> None:
    tell("writing the recording")
    with folder.writing(RECORDING) as path:
        write_recording(path, trace, summary, built)


def write_recording(
    path: Path, trace: Trace | WorldTrace, summary: dict[str, Any], built: Built | BuiltWorld
) -> None:
    """Write the recording of a run for the viewer, with notes from its summary."""
    from onorbit_rs import viewer  # imported here because rerun takes a second to import

    if isinstance(built, BuiltWorld):
        text = viewer.world_notes(summary, built.scenario)
        viewer.write_world_recording(
            path, cast("WorldTrace", trace), viewer.WorldSetting.of(built), notes=text
        )
    else:
        text = viewer.notes(summary, built.scenario)
        viewer.write_recording(path, cast("Trace", trace), viewer.Setting.of(built), notes=text)


def with_absolute_paths(scenario: Scenario | WorldScenario) -> dict[str, Any]:
    """Return the resolved scenario with absolute paths and explicit control periods."""
    data = scenario.resolved(scenario.file.parent if scenario.file else Path())
    step = data["simulation"]["time_step"]
    for settings in data["systems"].values() if "systems" in data else [data["simulation"]]:
        settings.setdefault("control_period", step)
    return data
