"""Figure of the differences between two runs."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from onorbit_rs.figures.style import (
    COLORS,
    FAINT_INK,
    INK,
    LINE,
    NORMAL,
    PAGE,
    SMALL,
    new_figure,
    thin,
    tidy,
)

if TYPE_CHECKING:
    from onorbit_rs.tools.comparison import Comparison, Difference

COLUMNS = 2
LOWEST = 1e-12
"""Smallest value that a panel shows, as a fraction of the largest value."""


def differences(compared: Comparison) -> Figure:
    """Draw differences over time, one panel per quantity; a dot marks the first value above the limit."""
    measured = compared.differences
    lines = -(-len(measured) // COLUMNS)
    figure = new_figure(PAGE, 0.5 + 1.15 * lines)
    title = f"{compared.b} against {compared.a}".replace("$", r"\$")  # $ would start a formula
    figure.suptitle(title, x=0.01, ha="left", fontsize=NORMAL, color=INK)
    panels = figure.subplots(lines, COLUMNS, sharex=True, squeeze=False)
    for axes in panels.flat[len(measured) :]:
        axes.set_visible(False)
    for axes, difference in zip(panels.flat, measured, strict=False):
        _draw(axes, compared, difference)
    for axes in panels.flat[max(0, len(measured) - COLUMNS) : len(measured)]:  # lowest panel of each column
        axes.set_xlabel("time [s]", fontsize=NORMAL, color=INK)
        axes.tick_params(labelbottom=True)
    return figure


def _draw(axes: Axes, compared: Comparison, difference: Difference) -> None:
    values = np.where(np.isfinite(difference.values), difference.values, np.nan)
    axes.plot(*thin(compared.time, values), color=COLORS[0], linewidth=LINE)
    axes.axhline(difference.allowed, color=FAINT_INK, linewidth=0.8, linestyle="--")
    label: Any = {"fontsize": SMALL, "color": FAINT_INK, "va": "bottom"}
    axes.text(0.01, difference.allowed, "allowed", transform=axes.get_yaxis_transform(), **label)
    if difference.parts_at is not None:
        axes.plot(difference.parts_at, difference.allowed, "o", color=COLORS[1], markersize=4)
    tidy(axes, "", f"[{difference.unit}]")
    axes.set_title(difference.name, loc="left", fontsize=NORMAL, color=INK)
    above = values[values > 0.0]
    if not above.size:
        axes.text(0.5, 0.5, "no difference", transform=axes.transAxes, ha="center", **label)
    least, top = (float(above.min()), float(above.max())) if above.size else (0.0, 0.0)
    top = max(difference.allowed, top)
    axes.set_yscale("log", nonpositive="clip")  # a single value among zeros remains visible
    axes.set_ylim(max(least, top * LOWEST) / 3.0, top * 20.0)
