"""Figures 4 and 5 of the paper: the trajectory in space, desired and obtained."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
from matplotlib.figure import Figure
from mpl_toolkits.mplot3d.art3d import Poly3DCollection  # type: ignore[import-untyped]  # ships no types
from mpl_toolkits.mplot3d.axes3d import Axes3D  # type: ignore[import-untyped]  # ships no types

from onorbit_rs.figures.solids import robot_polygons
from onorbit_rs.figures.space import add_space, fit, label
from onorbit_rs.figures.style import DESIRED, OBTAINED, new_figure

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from onorbit_rs._core import Model, Trace

    Floats = NDArray[np.float64]


def desired_trajectory(trace: Trace, model: Model) -> Figure:
    """Fig. 4: the robot at the first, the middle and the last point of the desired path, in W."""
    path = np.asarray(trace.reference_pose)[:, :3, 3]
    rows = [0, _row_at_half(path), len(path) - 1]
    shapes = [robot_polygons(model, trace.q[row]) for row in rows]
    corners = np.vstack([path, *(face for faces, _ in shapes for face in faces)])
    figure = new_figure(11.0, 4.8, "Desired trajectory of the tool, and the robot tracking it (Fig. 4)")
    for place, (row, (faces, colors)) in enumerate(zip(rows, shapes, strict=True)):
        axes = add_space(figure, 1, 3, place + 1, elevation=14.0, azimuth=-68.0)
        if faces:
            axes.add_collection3d(_solid(faces, colors))
        _path_on_top(axes, path, "desired" if place == 0 else None)
        axes.scatter(*path[row], color=OBTAINED, s=28, depthshade=False, zorder=12)
        axes.set_title(
            f"{('start', 'middle', 'end')[place]}, t = {trace.time[row]:.2f} s", fontsize=9, y=0.97
        )
        fit(axes, corners, zoom=1.12)
        label(axes, "m")
    figure.axes[0].legend(loc="upper left", frameon=False, fontsize=8)
    return figure


def obtained_trajectory(trace: Trace) -> Figure:
    """Fig. 5: the desired path of the tool (black) and the obtained one (red), in W."""
    desired = np.asarray(trace.reference_pose)[:, :3, 3]
    obtained = np.asarray(trace.tool_pose)[:, :3, 3]
    figure = new_figure(7.0, 5.0, "Desired and obtained trajectory of the tool (Fig. 5)")
    axes = add_space(figure, 1, 1, 1, elevation=20.0, azimuth=-60.0)
    axes.plot(*_sparse(desired).T, color=DESIRED, linewidth=4.0, label="desired", solid_capstyle="round")
    axes.plot(*_sparse(obtained).T, color=OBTAINED, linewidth=1.4, label="obtained")
    axes.scatter(
        *desired[0], color="white", edgecolor=DESIRED, s=36, depthshade=False, label="start", zorder=10
    )
    axes.scatter(*desired[-1], color=DESIRED, s=36, depthshade=False, label="end", zorder=10)
    fit(axes, np.vstack([desired, obtained]), least=0.4, zoom=1.12)
    label(axes, "m")
    axes.legend(loc="upper right", frameon=False, fontsize=9)
    return figure


def _solid(faces: list[Floats], colors: list[tuple[float, float, float]]) -> Poly3DCollection:
    """Faces lit from above and the front; edges in the same colour close the seams."""
    light = np.array([0.3, -0.7, 0.65])
    # The diagonals of a face give its normal even where two corners coincide, at a pole.
    normals = np.array([np.cross(face[2] - face[0], face[3] - face[1]) for face in faces])
    normals /= np.linalg.norm(normals, axis=1, keepdims=True)
    shaded = np.array(colors) * (0.66 + 0.34 * (normals @ light))[:, None]
    return Poly3DCollection(faces, facecolors=shaded, edgecolors=shaded, linewidths=0.3, zorder=1)


def _path_on_top(axes: Axes3D, path: Floats, name: str | None) -> None:
    axes.computed_zorder = False
    axes.plot(*_sparse(path).T, color=DESIRED, linewidth=1.8, label=name, zorder=11)


def _row_at_half(path: Floats) -> int:
    """First row at which half of the path's length is behind; the middle row of a path that stands still."""
    length = np.concatenate([[0.0], np.cumsum(np.linalg.norm(np.diff(path, axis=0), axis=1))])
    return int(np.searchsorted(length, length[-1] / 2.0)) if length[-1] > 0.0 else len(path) // 2


def _sparse(path: Floats) -> Floats:
    """Every so many points of a path, and its last."""
    stride = max(1, len(path) // 4000)
    return np.vstack([path[::stride], path[-1:]])
