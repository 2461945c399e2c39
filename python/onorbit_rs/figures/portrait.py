"""Draws a robot in one configuration."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

import numpy as np
from matplotlib.figure import Figure
from mpl_toolkits.mplot3d.axes3d import Axes3D  # type: ignore[import-untyped]  # ships no types

from onorbit_rs.figures.shading import add_surfaces
from onorbit_rs.figures.space import add_space, fit, label
from onorbit_rs.figures.style import INK, NORMAL, PAGE, XYZ_COLORS, new_figure
from onorbit_rs.visuals.solids import robot_polygons

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from onorbit_rs._core import Model

    Floats = NDArray[np.float64]

AXES_LENGTH = 0.12
"""Length of drawn coordinate axes as a fraction of the robot's largest dimension."""


def portrait(model: Model, q: Floats, frames: Sequence[str] = ()) -> Figure:
    """Draw a robot with the coordinate axes of its base and of some frames.

    Parameters
    ----------
    model : Model
        Robot.
    q : (nq,) array
        Configuration.
    frames : sequence of str
        Frames whose axes are drawn beside those of the base: x orange, y green, z blue.

    Returns
    -------
    Figure
        Figure in W; lengths in m.
    """
    ((faces, colors),) = robot_polygons(model, np.asarray(q)[None])
    names = list(dict.fromkeys([model.body_names[0], *frames]))
    poses = [np.asarray(model.frame_pose(q, name)) for name in names]
    corners = np.vstack([faces.reshape(-1, 3), *(pose[None, :3, 3] for pose in poses)])
    length = AXES_LENGTH * max(float(np.ptp(corners, axis=0).max()), 1e-3)
    figure = new_figure(PAGE, 5.4)
    figure.set_layout_engine("none")
    axes = add_space(figure, (0.0, 0.02, 0.98, 0.96), elevation=22.0, azimuth=-58.0)
    axes.computed_zorder = False
    add_surfaces(axes, faces, colors)
    for name, pose in zip(names, poses, strict=True):
        _draw_frame(axes, name, pose, length)
    fit(axes, corners, room=(1.75, 1.75), least=0.3)
    label(axes, "m")
    return figure


def _draw_frame(axes: Axes3D, name: str, pose: Floats, length: float) -> None:
    """Draw the coordinate axes and the name of a frame on top of the robot."""
    origin = pose[:3, 3]
    for direction, color in zip(pose[:3, :3].T, XYZ_COLORS, strict=True):
        axes.plot(*np.array([origin, origin + length * direction]).T, color=color, linewidth=1.4, zorder=10)
    axes.text(
        *(origin + 1.15 * length * pose[:3, 2]), name, fontsize=NORMAL, color=INK, ha="center", zorder=11
    )
