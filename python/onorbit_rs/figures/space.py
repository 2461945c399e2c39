"""3-D axes with true proportions."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np
from matplotlib.figure import Figure
from matplotlib.ticker import MaxNLocator
from mpl_toolkits.mplot3d.axes3d import Axes3D  # type: ignore[import-untyped]  # ships no types

from onorbit_rs.figures.style import FAINT, INK

if TYPE_CHECKING:
    from numpy.typing import NDArray

    Floats = NDArray[np.float64]


def add_space(figure: Figure, *place: Any, elevation: float = 18.0, azimuth: float = -62.0) -> Axes3D:
    """3-D axes in a figure; ``place`` is as in ``Figure.add_subplot``, angles in degrees."""
    axes: Axes3D = figure.add_subplot(*place, projection="3d")
    axes.view_init(elev=elevation, azim=azimuth)
    axes.tick_params(labelsize=7, colors=INK, pad=-1)
    for axis in (axes.xaxis, axes.yaxis, axes.zaxis):
        axis.set_major_locator(MaxNLocator(4))
        axis.set_pane_color((1.0, 1.0, 1.0, 0.0))
        axis._axinfo["grid"].update(color=FAINT, linewidth=0.5)
    return axes


def label(axes: Axes3D, unit: str, frame: str = "") -> None:
    """Names the three axes with their unit."""
    where = f" {frame}" if frame else ""
    axes.set_xlabel(f"x{where} [{unit}]", fontsize=8, labelpad=-2)
    axes.set_ylabel(f"y{where} [{unit}]", fontsize=8, labelpad=-2)
    axes.set_zlabel(f"z{where} [{unit}]", fontsize=8, labelpad=-2)


def fit(axes: Axes3D, points: Floats, *, least: float = 0.0, zoom: float = 1.0) -> None:
    """Limits around (k, 3) points, one metre equally long along all three axes.

    ``least`` keeps a flat direction from vanishing: the smallest side as a part of the largest. ``zoom``
    fills the frame.
    """
    low, high = points.min(axis=0), points.max(axis=0)
    largest = max(float((high - low).max()), 1e-9)
    half = np.maximum((high - low) / 2.0, least * largest / 2.0) + 0.05 * largest
    center = (low + high) / 2.0
    axes.set_xlim(center[0] - half[0], center[0] + half[0])
    axes.set_ylim(center[1] - half[1], center[1] + half[1])
    axes.set_zlim(center[2] - half[2], center[2] + half[2])
    axes.set_box_aspect(tuple(half), zoom=zoom)
