"""Figures 4 and 5 of the OnOrbitROS paper: the trajectory in space, desired and obtained."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
from matplotlib.figure import Figure
from mpl_toolkits.mplot3d.axes3d import Axes3D  # type: ignore[import-untyped]  # ships no types

from onorbit_rs.common.display_units import with_prefix
from onorbit_rs.figures.shading import add_surfaces
from onorbit_rs.figures.space import add_space, fit, label
from onorbit_rs.figures.style import (
    COLUMN,
    DESIRED,
    INK,
    NORMAL,
    OBTAINED,
    PAGE,
    SMALL,
    clock,
    new_figure,
)
from onorbit_rs.visuals.solids import robot_polygons

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from onorbit_rs._core import Model, Trace

    Floats = NDArray[np.float64]

NEARLY_STILL = 0.02
"""Ratio of a path's size to its distance from W's origin below which it is drawn relative to its start."""


def desired_trajectory(trace: Trace, model: Model) -> Figure:
    """Draw Fig. 4: the robot at the first, the middle and the last point of the desired path, in W."""
    path = np.asarray(trace.reference_pose)[:, :3, 3]
    rows = [0, _row_at_half(path), len(path) - 1]
    drawn = robot_polygons(model, np.asarray(trace.q)[rows])
    corners = np.vstack([path, *(faces.reshape(-1, 3) for faces, _ in drawn)])
    figure = new_figure(PAGE, 3.1)
    figure.set_layout_engine("none")
    time, time_label = clock(trace)
    for place, (row, (faces, colors)) in enumerate(zip(rows, drawn, strict=True)):
        axes = add_space(figure, (0.002 + place * 0.325, 0.09, 0.325, 0.86), elevation=14.0, azimuth=-68.0)
        add_surfaces(axes, faces, colors)
        _path_on_top(axes, path)
        axes.scatter(*path[row], color=OBTAINED, s=14, depthshade=False, zorder=12)
        unit = time_label.removeprefix("time [").removesuffix("]")
        where = f"{('start', 'middle', 'end')[place]}, t = {time[row]:.4g} {unit}"
        figure.text(0.17 + place * 0.325, 0.945, where, fontsize=NORMAL, ha="center", color=INK)
        fit(axes, corners, room=(1.38, 1.86))
        label(axes, "m")
    return figure


def obtained_trajectory(trace: Trace) -> Figure:
    """Draw Fig. 5: the desired and the obtained path of the tool in W.

    A path that is small compared with its distance from the origin of W is drawn relative to its start.
    """
    desired = np.asarray(trace.reference_pose)[:, :3, 3]
    obtained = np.asarray(trace.tool_pose)[:, :3, 3]
    both = np.vstack([desired, obtained])
    size = float(np.ptp(both, axis=0).max())
    is_small = size < NEARLY_STILL * float(np.abs(both).max())
    factor, unit = with_prefix(size, "m") if is_small else (1.0, "m")
    origin = desired[0] if is_small else np.zeros(3)
    desired, obtained = factor * (desired - origin), factor * (obtained - origin)
    figure = new_figure(COLUMN, 2.9)
    figure.set_layout_engine("none")
    axes = add_space(figure, (0.0, 0.07, 0.9, 0.84), elevation=20.0, azimuth=-60.0)
    axes.plot(*_sparse(desired).T, color=DESIRED, linewidth=3.0, label="desired", solid_capstyle="round")
    axes.plot(*_sparse(obtained).T, color=OBTAINED, linewidth=1.0, label="obtained")
    axes.scatter(
        *desired[0], color="white", edgecolor=DESIRED, s=22, depthshade=False, label="start", zorder=10
    )
    axes.scatter(*desired[-1], color=DESIRED, s=22, depthshade=False, label="end", zorder=10)
    fit(axes, np.vstack([desired, obtained]), room=(1.9, 1.75), least=0.4)
    label(axes, unit, pad=-4.0, change="Δ" if is_small else "")
    figure.legend(
        *axes.get_legend_handles_labels(), loc="upper center", frameon=False, fontsize=SMALL, ncols=4,
        columnspacing=1.2, handlelength=1.6, handletextpad=0.5,
    )  # fmt: skip
    return figure


def _path_on_top(axes: Axes3D, path: Floats) -> None:
    axes.computed_zorder = False
    axes.plot(*_sparse(path).T, color=DESIRED, linewidth=1.2, zorder=11)


def _along(path: Floats) -> Floats:
    """Return the arc length of the path up to each row, m."""
    return np.concatenate([[0.0], np.cumsum(np.linalg.norm(np.diff(path, axis=0), axis=1))])


def _row_at_half(path: Floats) -> int:
    """Return the first row after half of the path's length, or the middle row of a path of zero length."""
    length = _along(path)
    return int(np.searchsorted(length, length[-1] / 2.0)) if length[-1] > 0.0 else len(path) // 2


def _sparse(path: Floats) -> Floats:
    """Return at most 2000 points of a path, including its last point."""
    stride = max(1, len(path) // 1000)
    return np.vstack([path[::stride], path[-1:]])
