"""One look for every figure: colours safe for colour-blind readers, units in every label, no global state."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING, Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.figure import Figure

if TYPE_CHECKING:
    from numpy.typing import NDArray

    Floats = NDArray[np.float64]

# Okabe and Ito, "Color Universal Design", 2008.
COLORS = ("#0072B2", "#D55E00", "#009E73", "#CC79A7", "#E69F00", "#56B4E9", "#7F7F7F", "#F0E442", "#000000")
XYZ_COLORS = ("#D55E00", "#009E73", "#0072B2")
DESIRED, OBTAINED = "#000000", "#D62728"
INK, FAINT_INK, FAINT = "#222222", "#8A8A8A", "#D9D9D9"

DPI = 150
MOST_POINTS = 20_000
"""Of one line; longer ones keep the extremes of each stretch."""

_PREFIXES = ((1e-12, "p"), (1e-9, "n"), (1e-6, "µ"), (1e-3, "m"), (1.0, ""), (1e3, "k"), (1e6, "M"))


def new_figure(width: float, height: float, title: str) -> Figure:
    """An empty figure that draws to memory, without pyplot.

    Parameters
    ----------
    width, height : float
        Inches.
    title : str
        Above everything, on the left.
    """
    figure = Figure(figsize=(width, height), dpi=DPI, layout="constrained", facecolor="white")
    FigureCanvasAgg(figure)
    figure.suptitle(title, x=0.01, ha="left", fontsize=11, fontweight="bold", color=INK)
    return figure


def tidy(axes: Axes, x_label: str, y_label: str) -> None:
    """Quiet frame, light grid, labels."""
    axes.set_xlabel(x_label, fontsize=9, color=INK)
    axes.set_ylabel(y_label, fontsize=9, color=INK)
    axes.tick_params(labelsize=8, colors=INK, length=3)
    axes.grid(True, color=FAINT, linewidth=0.6)
    axes.set_axisbelow(True)
    axes.margins(x=0.0)
    for side in ("top", "right"):
        axes.spines[side].set_visible(False)
    axes.yaxis.get_offset_text().set_fontsize(8)


def legend_beside(axes: Axes, **options: Any) -> None:
    """Legend to the right of the axes, where it covers nothing."""
    axes.legend(
        loc="upper left",
        bbox_to_anchor=(1.01, 1.0),
        frameon=False,
        fontsize=8,
        borderaxespad=0.0,
        handlelength=1.4,
        **options,
    )


def with_prefix(peak: float, unit: str) -> tuple[float, str]:
    """Factor and unit such that values up to ``peak`` read between 1 and 1000: ``(1e6, "µm")``."""
    scale, prefix = 1.0, ""
    if np.isfinite(peak) and peak > 0.0:
        fitting = [entry for entry in _PREFIXES if entry[0] <= peak] or [_PREFIXES[0]]
        scale, prefix = fitting[-1]
    return 1.0 / scale, prefix + unit


def plot_lines(
    axes: Axes, time: Floats, columns: Floats, names: Sequence[str], colors: Sequence[str]
) -> None:
    """One line per column of ``columns`` (T, n)."""
    for index, name in enumerate(names):
        x, y = thin(time, columns[:, index])
        axes.plot(x, y, color=colors[index % len(colors)], linewidth=1.3, label=name)


def thin(time: Floats, values: Floats) -> tuple[Floats, Floats]:
    """At most :data:`MOST_POINTS` points of a line that keep the lowest and highest of every stretch."""
    if len(time) <= MOST_POINTS:
        return time, values
    stretches = np.array_split(np.arange(len(time)), MOST_POINTS // 2)
    kept = [s[0] + extreme(values[s[0] : s[-1] + 1]) for s in stretches for extreme in (np.argmin, np.argmax)]
    rows = np.unique([0, *kept, len(time) - 1])
    return time[rows], values[rows]
