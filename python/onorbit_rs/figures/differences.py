"""Where two runs part."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
from matplotlib.figure import Figure

from onorbit_rs.figures.style import COLORS, FAINT_INK, INK, new_figure, thin, tidy

if TYPE_CHECKING:
    from onorbit_rs.comparison import Comparison

COLUMNS = 2
LOWEST = 1e-12
"""Of a panel, as a share of its top."""


def differences(compared: Comparison) -> Figure:
    """Differences over time, one panel per measure: dashed what is allowed, a dot where the runs part."""
    measured = compared.differences
    lines = -(-len(measured) // COLUMNS)
    figure = new_figure(9.0, 0.9 + 1.55 * lines, f"{compared.b}\nagainst {compared.a}")
    panels = figure.subplots(lines, COLUMNS, sharex=True, squeeze=False)
    for axes in panels.flat[len(measured) :]:
        axes.set_visible(False)
    for axes, difference in zip(panels.flat, measured, strict=False):
        values = np.where(np.isfinite(difference.values), difference.values, np.nan)
        axes.plot(*thin(compared.time, values), color=COLORS[0], linewidth=1.2)
        axes.axhline(difference.allowed, color=FAINT_INK, linewidth=0.9, linestyle="--")
        where = axes.get_yaxis_transform()
        axes.text(
            1.0, difference.allowed, "allowed", transform=where, fontsize=7, color=FAINT_INK, ha="right"
        )
        tidy(axes, "", f"[{difference.unit}]")
        axes.set_title(difference.name, loc="left", fontsize=9, color=INK)
        above = values[values > 0.0]
        top = max(difference.allowed, float(above.max()) if above.size else 0.0)
        axes.set_yscale("log", nonpositive="mask")
        axes.set_ylim(max(float(above.min()) if above.size else 0.0, top * LOWEST) / 3.0, top * 10.0)
        if difference.parts_at is not None:
            axes.plot(difference.parts_at, difference.allowed, "o", color=COLORS[1], markersize=5)
    for axes in panels[-1]:
        axes.set_xlabel("time [s]", fontsize=9, color=INK)
    return figure
