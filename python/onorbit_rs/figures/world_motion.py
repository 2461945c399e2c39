"""Figure of the paths of several systems relative to the reference orbit, and of their distances."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from onorbit_rs.common.coordinates import POSITION
from onorbit_rs.common.decimate import evenly_spaced
from onorbit_rs.common.display_units import with_prefix
from onorbit_rs.common.group_momentum import shared_rows
from onorbit_rs.common.pairs import pairs_of
from onorbit_rs.common.rotations import local_orbital_axes
from onorbit_rs.figures.event_marks import mark_events
from onorbit_rs.figures.relative import MOST_ROWS, WORTH_A_PATH, set_window
from onorbit_rs.figures.style import (
    COLORS,
    INK,
    LINE,
    PAGE,
    legend_above,
    legend_name,
    legend_of_figure,
    new_figure,
    plot_largest,
    tidy,
    time_unit,
)
from onorbit_rs.visuals.geometry import extent
from onorbit_rs.visuals.shapes import shapes

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from onorbit_rs._core import Model, WorldTrace
    from onorbit_rs.figures.world_subject import EventMark

    Floats = NDArray[np.float64]


def formation_motion(trace: WorldTrace, events: Sequence[EventMark] = ()) -> Figure:
    """Draw the paths of all bases in L of the reference orbit, and the distances between the bases."""
    figure = new_figure(PAGE, 4.7)
    panels = figure.subplot_mosaic([["plane", "across"], ["distance", "distance"]], height_ratios=[2.0, 1.0])
    paths = [path[evenly_spaced(len(path), MOST_ROWS)] for path in paths_of_systems(trace)]
    points = np.vstack([*paths, np.zeros((1, 3))])
    factor, unit = with_prefix(float(np.ptp(points, axis=0).max()), "m")
    for panel, across, name in (("plane", 0, "radial"), ("across", 2, "cross-track")):
        axes = panels[panel]
        for index, (system, path) in enumerate(zip(trace.names, paths, strict=True)):
            _plot_system(axes, factor * path[:, [1, across]], COLORS[index % len(COLORS)], system)
        for marker, end in (("o", "start"), ("s", "end")):
            axes.plot([], [], marker, color="none", markeredgecolor=INK, markersize=5, label=end)
        axes.plot(0.0, 0.0, "+", color=INK, markersize=7, linestyle="none", label="reference")
        tidy(axes, f"along track [{unit}]", f"{name} [{unit}]")
        set_window(axes, factor * points, across)
    legend_of_figure(figure, panels["plane"])
    time, apart = distances(trace)
    scale, clock = time_unit(time)
    values = np.stack(list(apart.values()), axis=1)
    factor, unit = with_prefix(float(values.max()), "m")
    plot_largest(panels["distance"], time / scale, factor * values, list(apart))
    tidy(panels["distance"], f"time [{clock}]", f"distance [{unit}]")
    mark_events(panels["distance"], events, scale, has_names=True)
    legend_above(panels["distance"], PAGE - 0.7)
    return figure


def _plot_system(axes: Axes, path: Floats, color: str, name: str) -> None:
    """Draw a path (T, 2) with markers at its start and its end, which distinguish paths on one ellipse."""
    axes.plot(*path.T, color=color, linewidth=LINE, label=legend_name(name))
    axes.plot(*path[0], "o", color="white", markeredgecolor=color, markersize=6, zorder=3)
    axes.plot(*path[-1], "s", color=color, markersize=3, zorder=3)


def paths_of_systems(trace: WorldTrace) -> list[Floats]:
    """Return the positions (T, 3) of each base in L of the reference orbit of the world, m."""
    traces = [trace[name] for name in trace.names]
    rows = shared_rows([np.asarray(own.time) for own in traces])
    reference = traces[0].reference_position_eci, traces[0].reference_velocity_eci
    rot_wl = local_orbital_axes(*(np.asarray(values)[rows[0]] for values in reference))
    return [
        np.einsum("tji,tj->ti", rot_wl, np.asarray(own.q)[chosen][:, POSITION])
        for own, chosen in zip(traces, rows, strict=True)
    ]


def distances(trace: WorldTrace) -> tuple[Floats, dict[str, Floats]]:
    """Return the times common to all systems, s, and the distances, m, of the bases of :func:`pairs_of`."""
    names = list(trace.names)
    rows = dict(zip(names, shared_rows([np.asarray(trace[name].time) for name in names]), strict=True))
    place = {name: np.asarray(trace[name].q)[rows[name]][:, POSITION] for name in names}
    time = np.asarray(trace[names[0]].time)[rows[names[0]]]
    return time, {f"{a} - {b}": np.linalg.norm(place[b] - place[a], axis=1) for a, b in pairs_of(names)}


def is_apart(trace: WorldTrace, models: Mapping[str, Model]) -> bool:
    """Return True if any distance exceeds :data:`WORTH_A_PATH` times the size of the largest system."""
    sizes = [extent(model, shapes(model), np.asarray(trace[name].q)[:1])[1] for name, model in models.items()]
    _, apart = distances(trace)
    return max(float(values.max()) for values in apart.values()) > WORTH_A_PATH * max(sizes, default=np.inf)
