"""3-D axes with true proportions."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
from matplotlib.figure import Figure
from matplotlib.ticker import MaxNLocator
from mpl_toolkits.mplot3d.axes3d import Axes3D  # type: ignore[import-untyped]  # ships no types

from onorbit_rs.figures.style import FAINT, INK, NORMAL, SMALL

if TYPE_CHECKING:
    from numpy.typing import NDArray

    Floats = NDArray[np.float64]

_MARGIN = 0.01
"""Smallest distance of a label from the edge of a figure, as a fraction of the figure."""

_STEPS = 6


def add_space(
    figure: Figure,
    place: tuple[float, float, float, float],
    *,
    elevation: float = 18.0,
    azimuth: float = -62.0,
) -> Axes3D:
    """Add 3-D axes at ``place`` (left, bottom, width, height, from 0 to 1); view angles are in degrees."""
    axes: Axes3D = figure.add_axes(place, projection="3d")
    axes.set_in_layout(False)
    axes.patch.set_visible(False)  # the background would cover the labels of neighbouring axes
    axes.view_init(elev=elevation, azim=azimuth)
    axes.tick_params(labelsize=SMALL, colors=INK, pad=-2)
    for axis in (axes.xaxis, axes.yaxis, axes.zaxis):
        axis.set_major_locator(MaxNLocator(4, min_n_ticks=2))
        axis.set_pane_color((1.0, 1.0, 1.0, 0.0))
        axis._axinfo["grid"].update(color=FAINT, linewidth=0.4)
        axis.line.set_linewidth(0.6)
    return axes


def label(axes: Axes3D, unit: str, pad: float = -5.0, change: str = "") -> None:
    """Label the three axes with their names and unit; ``change`` is a prefix of the names, such as ``Δ``."""
    axes.set_xlabel(f"{change}x [{unit}]", fontsize=NORMAL, labelpad=pad)
    axes.set_ylabel(f"{change}y [{unit}]", fontsize=NORMAL, labelpad=pad)
    axes.set_zlabel(f"{change}z [{unit}]", fontsize=NORMAL, labelpad=pad)


def legend_of(figure: Figure, axes: Axes3D, columns: int) -> None:
    """Add the legend of 3-D axes at the top of a figure."""
    figure.legend(
        *axes.get_legend_handles_labels(), loc="upper center", frameon=False, fontsize=SMALL, ncols=columns,
        columnspacing=1.2, handlelength=1.6, handletextpad=0.5,
    )  # fmt: skip


def keep_labels_visible(figure: Figure, axes: Axes3D) -> None:
    """Shrink and move 3-D axes until their labels, which matplotlib places outside them, are in the figure.

    The labels may use the area of the axes, extended to the left, right and lower edges of the figure. Labels
    keep their size, so the axes are shrunk in several steps.
    """
    area = axes.get_position()
    for _ in range(_STEPS):
        figure.canvas.draw()
        found = axes.get_tightbbox(figure.canvas.get_renderer())  # type: ignore[attr-defined]
        box = found.transformed(figure.transFigure.inverted())
        excess = max(box.width - 1.0 + 2.0 * _MARGIN, box.height - area.y1 + _MARGIN, 0.0)
        place = axes.get_position()
        shrunk = 1.0 - min(excess, 0.5)
        right = max(_MARGIN - box.x0, 0.0) - max(box.x1 - 1.0 + _MARGIN, 0.0)
        up = max(_MARGIN - box.y0, 0.0) - max(box.y1 - area.y1, 0.0)
        if excess == 0.0 and abs(right) + abs(up) < 1e-4:
            return
        width, height = shrunk * place.width, shrunk * place.height
        left = place.x0 + (place.width - width) / 2.0 + right
        axes.set_position((left, place.y0 + (place.height - height) / 2.0 + up, width, height))


def fit(axes: Axes3D, points: Floats, *, room: tuple[float, float], least: float = 0.0) -> None:
    """Set limits around points (k, 3), with the same scale along all three axes.

    Parameters
    ----------
    axes : Axes3D
        Axes whose limits are set.
    points : (k, 3) array
        Points that must be visible.
    room : pair of float
        Width and height available for the projected box, relative to half its space diagonal.
    least : float
        Smallest side of the box as a fraction of the largest side.
    """
    low, high = points.min(axis=0), points.max(axis=0)
    largest = max(float((high - low).max()), 1e-9)
    half = np.maximum((high - low) / 2.0, least * largest / 2.0) + 0.05 * largest
    center = (low + high) / 2.0
    axes.set_xlim(center[0] - half[0], center[0] + half[0])
    axes.set_ylim(center[1] - half[1], center[1] + half[1])
    axes.set_zlim(center[2] - half[2], center[2] + half[2])
    width, height = _projected_size(half / np.linalg.norm(half), axes.elev, axes.azim)
    axes.set_box_aspect(tuple(half), zoom=min(room[0] / width, room[1] / height))
    for axis, length in zip((axes.xaxis, axes.yaxis, axes.zaxis), half / half.max(), strict=True):
        axis.set_major_locator(MaxNLocator(4 if length > 0.7 else 3 if length > 0.45 else 2, min_n_ticks=1))


def _projected_size(half: Floats, elevation_deg: float, azimuth_deg: float) -> tuple[float, float]:
    """Return the width and height of the projection of a box with these half side lengths."""
    elevation, azimuth = np.radians([elevation_deg, azimuth_deg])
    right = np.array([-np.sin(azimuth), np.cos(azimuth), 0.0])
    up = np.array(
        [-np.sin(elevation) * np.cos(azimuth), -np.sin(elevation) * np.sin(azimuth), np.cos(elevation)]
    )
    return float(2.0 * np.abs(half * right).sum()), float(2.0 * np.abs(half * up).sum())
