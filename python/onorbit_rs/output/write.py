"""Writes the files of a run."""

from __future__ import annotations

import json
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
import yaml

from onorbit_rs.exceptions import OrbitError
from onorbit_rs.output.folder import FIGURES, OutputFolder
from onorbit_rs.scenario.earth import make_earth

if TYPE_CHECKING:
    from collections.abc import Callable

    from onorbit_rs._core import Trace
    from onorbit_rs.scenario import Scenario
    from onorbit_rs.scenario.build import Built


def write_scenario(folder: OutputFolder, scenario: Scenario) -> None:
    """``scenario.yaml``: every default written out, SI; it runs again from where it lies."""
    source = scenario.file or "Python"
    header = f"# resolved by onorbit_rs from {source}; run it again with: onorbit run scenario.yaml\n"
    with folder.writing("scenario.yaml") as path:
        text = yaml.safe_dump(
            with_absolute_paths(scenario),
            sort_keys=False,
            default_flow_style=None,
            width=110,
            allow_unicode=True,
        )
        path.write_text(header + text, encoding="utf-8")


def write_trace(folder: OutputFolder, trace: Trace) -> None:
    """``trace.npz``: the columns of the trace under their own names, and the errors of each controller."""
    with folder.writing("trace.npz") as path, path.open("wb") as stream:
        columns = {name: np.asarray(getattr(trace, name)) for name in trace.columns()}
        columns |= {f"tracking_{name}": np.asarray(errors) for name, errors in trace.tracking.items()}
        columns |= {f"wrench_{name}": np.asarray(rows) for name, rows in trace.wrenches.items()}
        if len(trace.rereferenced):
            columns["rereferenced"] = np.asarray(trace.rereferenced)
        np.savez(stream, allow_pickle=False, **columns)


def write_summary(folder: OutputFolder, summary: dict[str, Any]) -> None:
    """``summary.json``."""
    with folder.writing("summary.json") as path:
        path.write_text(json.dumps(summary, indent=2, allow_nan=False) + "\n", encoding="utf-8")


def write_pictures(
    folder: OutputFolder,
    trace: Trace,
    summary: dict[str, Any],
    built: Built,
    *,
    tell: Callable[[str], None] = lambda doing: None,
) -> None:
    """Figures and recording; ``tell`` is called with what is being written."""
    # Imported here: matplotlib and rerun take a second that a run without output should not pay.
    from onorbit_rs import figures, viewer

    has_planet = built.orbit is not None and built.orbit.mu is not None
    if len(trace.time) > 1:
        scenario = built.scenario
        beside = scenario.file.parent if scenario.file else Path()
        earth = make_earth(scenario, built.orbit, beside)
        subject = figures.subject_of(trace, scenario, built.model, built.orbit, earth)
        with folder.refusals(FIGURES):
            figures.save_all(subject, folder.path / FIGURES, tell=lambda name: tell(f"drawing {name}"))
    tell("writing the recording")
    with folder.writing("run.rrd") as path:
        viewer.write_recording(
            path,
            trace,
            built.model,
            title=built.scenario.name,
            notes=notes(summary, built.scenario),
            orbit_path=path_around_planet(built.orbit),
            has_planet=has_planet,
        )


def with_absolute_paths(scenario: Scenario) -> dict[str, Any]:
    """The resolved scenario with paths that hold from any folder, and the period of control."""
    data = scenario.resolved(scenario.file.parent if scenario.file else Path())
    settings = data["simulation"]
    settings.setdefault("control_period", settings["time_step"])
    return data


def notes(summary: dict[str, Any], scenario: Scenario) -> str:
    """The summary as Markdown."""
    rows = "\n".join(f"| {key} | {_short(value)} |" for key, value in summary.items())
    return f"# {scenario.name}\n\n{scenario.description}\n\n| | |\n|-|-|\n{rows}\n"


def path_around_planet(orbit: Any, points: int = 361) -> Any:
    """(k, 3) positions along a closed orbit or a whole path, m; None where there is none around a planet."""
    if orbit is None or orbit.mu is None:
        return None
    period = getattr(orbit, "period", None)
    start, end = getattr(orbit, "span", (0.0, period))
    if end is None or not np.isfinite(end):
        return None
    try:
        return np.asarray(orbit.state(np.linspace(start, end, points))[0])
    except OrbitError:  # decays within its first revolution
        return None


def _short(value: Any) -> str:
    return f"{value:.4g}" if isinstance(value, float) else str(value)
