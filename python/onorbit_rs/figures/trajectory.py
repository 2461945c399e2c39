"""Figures 4 and 5 of the OnOrbitROS paper: the trajectory in space, desired and obtained."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
from matplotlib.colors import to_rgb
from matplotlib.figure import Figure

from onorbit_rs.common.display_units import with_prefix
from onorbit_rs.figures.shading import add_surfaces
from onorbit_rs.figures.space import add_space, fit, keep_labels_visible, label, legend_of
from onorbit_rs.figures.style import (
    COLUMN,
    DESIRED,
    OBTAINED,
    clock,
    new_figure,
)
from onorbit_rs.visuals.solids import robot_polygons

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from onorbit_rs._core import Model, Trace

    Floats = NDArray[np.float64]

_SHARES = (0.25, 0.5, 1.0)
"""Opacity of the robot's colours on white at the start, the middle and the end of the path."""

_APART = 0.08
"""Displacement, in sizes of the robot, up to which a face of an earlier configuration is not drawn."""

NEARLY_STILL = 0.02
"""Ratio of a path's size to its distance from W's origin below which it is drawn relative to its start."""


def desired_trajectory(trace: Trace, model: Model) -> Figure:
    """Draw the robot at the start, the middle and the end of the desired path of its tool, in axes of W.

    This is Fig. 4 of the OnOrbitROS paper.

    The colours of the robot are paler at earlier times. The obtained path is drawn over the desired one.
    """
    desired = np.asarray(trace.reference_pose)[:, :3, 3]
    obtained = np.asarray(trace.tool_pose)[:, :3, 3]
    rows = [0, _row_at_half(desired), len(desired) - 1]
    drawn = robot_polygons(model, np.asarray(trace.q)[rows])
    faces, colors = _overlaid(drawn)
    figure = new_figure(COLUMN, 3.6)
    figure.set_layout_engine("none")
    axes = add_space(figure, (0.02, 0.03, 0.90, 0.83), elevation=14.0, azimuth=-68.0)
    add_surfaces(axes, faces, colors)
    axes.computed_zorder = False
    axes.plot(*_sparse(desired).T, color=DESIRED, linewidth=2.4, zorder=11, label="desired")
    axes.plot(*_sparse(obtained).T, color=OBTAINED, linewidth=0.9, zorder=12, label="obtained")
    time, time_label = clock(trace)
    unit = time_label.removeprefix("time [").removesuffix("]")
    for row, share, where in zip(rows, _SHARES, ("start", "middle", "end"), strict=True):
        tint = [1.0 - share * (1.0 - part) for part in to_rgb(OBTAINED)]
        axes.scatter(
            *desired[row], color=[tint], edgecolor=DESIRED, s=22, depthshade=False, zorder=13,
            label=f"{where}, {time[row]:.4g} {unit}",
        )  # fmt: skip
    fit(axes, np.vstack([desired, obtained, faces.reshape(-1, 3)]), room=(1.5, 1.75))
    label(axes, "m", pad=-4.0)
    keep_labels_visible(figure, axes)
    legend_of(figure, axes, columns=3)
    return figure


def obtained_trajectory(trace: Trace) -> Figure:
    """Draw the desired and the obtained path of the tool in W.

    This is Fig. 5 of the OnOrbitROS paper.

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
    keep_labels_visible(figure, axes)
    legend_of(figure, axes, columns=4)
    return figure


def _overlaid(drawn: list[tuple[Floats, Floats]]) -> tuple[Floats, Floats]:
    """Return faces and colours of all configurations, of which the earlier ones are paler.

    Faces of earlier configurations that are near the same face of the last one are omitted.
    """
    last, _ = drawn[-1]
    size = float(np.ptp(last.reshape(-1, 3), axis=0).max())
    found = []
    for share, (faces, colors) in zip(_SHARES, drawn, strict=True):
        apart = np.linalg.norm(faces - last, axis=2).max(axis=1)
        kept = (apart > _APART * size) | (share == 1.0)
        found.append((faces[kept], 1.0 - share * (1.0 - colors[kept])))
    return np.concatenate([faces for faces, _ in found]), np.concatenate([colors for _, colors in found])


def _along(path: Floats) -> Floats:
    """Return the arc length of the path up to each row, m."""
    return np.concatenate([[0.0], np.cumsum(np.linalg.norm(np.diff(path, axis=0), axis=1))])


def _row_at_half(path: Floats) -> int:
    """Return the first row at or after half of the path's length; the middle row if the length is zero."""
    length = _along(path)
    return int(np.searchsorted(length, length[-1] / 2.0)) if length[-1] > 0.0 else len(path) // 2


def _sparse(path: Floats) -> Floats:
    """Return at most 2000 points of a path, including its last point."""
    stride = max(1, len(path) // 1000)
    return np.vstack([path[::stride], path[-1:]])
