"""Figure of the motion of the base and of targets relative to the reference orbit."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from onorbit_rs.common.coordinates import POSITION
from onorbit_rs.common.decimate import evenly_spaced
from onorbit_rs.common.display_units import with_prefix
from onorbit_rs.common.rotations import local_orbital_axes
from onorbit_rs.figures.style import (
    COLORS,
    INK,
    LINE,
    OBTAINED,
    PAGE,
    legend_of_figure,
    new_figure,
    tidy,
)
from onorbit_rs.visuals.geometry import extent
from onorbit_rs.visuals.shapes import shapes

if TYPE_CHECKING:
    from collections.abc import Sequence

    from numpy.typing import NDArray

    from onorbit_rs._core import Model, Trace
    from onorbit_rs.scenario.targets import Target

    Floats = NDArray[np.float64]

WORTH_A_PATH = 3.0
"""Extent of the base's path in L, in sizes of the robot, above which the figure is drawn."""
_SIDES = 1.35
"""Ratio of the width of a panel to its height."""
_NEAR = 10.0
"""Ratio of the paths' distance from the reference to their extent below which the reference is drawn."""
MOST_ROWS = 3_000


def relative_motion(trace: Trace, targets: Sequence[Target] = ()) -> Figure:
    """Draw the paths of base and targets in L of the reference orbit: in its plane, and across it.

    The axes of L are radial, along track, and along the orbit normal. On a circular orbit, the relative path
    of a free base that does not drift is a Hill ellipse, twice as long along track as in radial direction.
    All axes have the same scale.
    """
    paths = [path[evenly_spaced(len(path), MOST_ROWS)] for path in paths_in_orbit(trace, targets)]
    points = np.vstack(paths)
    is_near = np.linalg.norm(points, axis=1).max() < _NEAR * np.ptp(points, axis=0).max()
    if is_near:
        points = np.vstack([points, np.zeros(3)])
    factor, unit = with_prefix(float(np.ptp(points, axis=0).max()), "m")
    figure = new_figure(PAGE, 3.0)
    panels = figure.subplots(1, 2)
    for axes, across, name in zip(panels, (0, 2), ("radial", "cross-track"), strict=True):
        for index, path in enumerate(paths):
            _plot_path(axes, factor * path[:, 1], factor * path[:, across], index)
        if is_near:
            axes.plot(0.0, 0.0, "+", color=INK, markersize=7, label="reference")
        tidy(axes, f"along track [{unit}]", f"{name} [{unit}]")
        set_window(axes, factor * points, across)
    legend_of_figure(figure, panels[0])
    return figure


def _plot_path(axes: Axes, x: Floats, y: Floats, index: int) -> None:
    """Draw the path of the base (index 0) or of a target; the legend names each kind once."""
    path, start, end = ("base", "start", "end") if index == 0 else ("target", "_nolegend_", "_nolegend_")
    path = "_nolegend_" if index > 1 else path
    axes.plot(x, y, color=COLORS[0] if index == 0 else COLORS[2], linewidth=LINE, label=path)
    axes.plot(x[0], y[0], "o", color="none", markeredgecolor=INK, markersize=6, label=start)
    axes.plot(x[-1], y[-1], "s", color=OBTAINED, markersize=3, label=end)


def paths_in_orbit(trace: Trace, targets: Sequence[Target] = ()) -> list[Floats]:
    """Return the positions (T, 3) of the base and of each target in L, m."""
    rot_wl = local_orbital_axes(trace.reference_position_eci, trace.reference_velocity_eci)
    places = [
        np.asarray(trace.q)[:, POSITION],
        *(target.position_at(np.asarray(trace.time)) for target in targets),
    ]
    return [np.einsum("tji,tj->ti", rot_wl, place) for place in places]


def goes_far(trace: Trace, model: Model) -> bool:
    """Return True if the base's path in L extends over more than :data:`WORTH_A_PATH` robot sizes."""
    (base,) = paths_in_orbit(trace)
    _, size = extent(model, shapes(model), np.asarray(trace.q)[:1])
    return float(np.ptp(base, axis=0).max()) > WORTH_A_PATH * size


def set_window(axes: Axes, points: Floats, across: int) -> None:
    """Set the limits of a panel around the points (k, 3) in L.

    The along-track axis points to the right, and the axis with index ``across`` points upward. The scale is
    the same in both panels.
    """
    low, high = points.min(axis=0), points.max(axis=0)
    sides = high - low
    height = 1.15 * float(max(sides[1] / _SIDES, sides[0], sides[2]))
    middle = (low + high) / 2.0
    axes.set_xlim(middle[1] - _SIDES * height / 2.0, middle[1] + _SIDES * height / 2.0)
    axes.set_ylim(middle[across] - height / 2.0, middle[across] + height / 2.0)
    axes.set_aspect("equal")
    axes.ticklabel_format(useOffset=False)
