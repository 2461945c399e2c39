"""Style of the figures.

The figures have the sizes of a two-column paper, colours for colour-blind readers, units in every label, and
no titles, because captions belong to the page. No global state of matplotlib is changed.
"""

from __future__ import annotations

import io
from collections.abc import Sequence
from typing import TYPE_CHECKING

import numpy as np
from matplotlib.axes import Axes
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.figure import Figure

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from onorbit_rs._core import Trace

    Floats = NDArray[np.float64]

# Okabe and Ito, "Color Universal Design", 2008, without yellow, which is too pale on white
COLORS = ("#0072B2", "#D55E00", "#009E73", "#CC79A7", "#E69F00", "#56B4E9", "#7F7F7F", "#000000")
XYZ_COLORS = ("#D55E00", "#009E73", "#0072B2")
DESIRED, OBTAINED = "#000000", "#D55E00"
INK, FAINT_INK, FAINT = "#222222", "#8A8A8A", "#D9D9D9"

COLUMN, PAGE = 3.5, 7.16
"""Width of one column, and of a two-column page (IEEE), inches."""
SMALL, NORMAL = 7, 8
"""Font sizes in print, points."""
LINE = 1.1
DPI = 300
MOST_POINTS = 4_000
"""Largest number of points of a line between its ends; a printed column has 1050 dots at 300 dpi."""
LONGEST_NAME = 32
"""Largest number of characters of a name in a legend; longer names are shortened."""
MOST_LINES = len(COLORS)
"""Largest number of coloured lines in one plot."""

_CLOCK = ((4 * 86400.0, 86400.0, "d"), (3 * 3600.0, 3600.0, "h"), (1200.0, 60.0, "min"))


SCREEN_DPI = 110
"""Dots per inch of a figure in a notebook."""


class NotebookFigure(Figure):
    """Figure with its own PNG representation, so that notebooks display it without pyplot."""

    def _repr_png_(self) -> bytes:
        """Return the figure as PNG."""
        content = io.BytesIO()
        self.savefig(content, format="png", dpi=SCREEN_DPI)
        return content.getvalue()


def new_figure(width: float, height: float) -> Figure:
    """Return an empty figure of this size in inches that draws to memory, without pyplot."""
    figure = NotebookFigure(figsize=(width, height), dpi=DPI, layout="constrained", facecolor="white")
    FigureCanvasAgg(figure)
    return figure


def tidy(axes: Axes, x_label: str, y_label: str) -> None:
    """Set the axis labels, a light grid and a frame without top and right lines."""
    axes.set_xlabel(x_label, fontsize=NORMAL, color=INK)
    axes.set_ylabel(y_label, fontsize=NORMAL, color=INK)
    axes.tick_params(labelsize=SMALL, colors=INK, length=2.5, width=0.6)
    axes.grid(True, color=FAINT, linewidth=0.5)
    axes.set_axisbelow(True)
    axes.margins(x=0.0)
    for side in ("top", "right"):
        axes.spines[side].set_visible(False)
    for side in ("left", "bottom"):
        axes.spines[side].set_linewidth(0.6)
    axes.yaxis.get_offset_text().set_fontsize(SMALL)


def legend_above(axes: Axes, width: float = COLUMN - 0.5) -> None:
    """Place the legend above the axes, in as many columns as fit into ``width`` inches."""
    handles, names = axes.get_legend_handles_labels()
    axes.legend(
        handles, names, loc="lower left", bbox_to_anchor=(0.0, 1.0), frameon=False, fontsize=SMALL,
        borderaxespad=0.15, borderpad=0.1, handlelength=1.6, handletextpad=0.5, columnspacing=1.0,
        labelspacing=0.25, ncols=legend_columns(names, width),
    )  # fmt: skip


def legend_of_figure(figure: Figure, axes: Axes) -> list[str]:
    """Put the legend of axes above the whole figure, in as many columns as fit; return its names."""
    handles, names = axes.get_legend_handles_labels()
    figure.legend(
        handles, names, loc="outside upper left", frameon=False, fontsize=SMALL,
        ncols=legend_columns(names, PAGE - 0.6), handlelength=1.6, handletextpad=0.5, columnspacing=1.2,
    )  # fmt: skip
    return names


def legend_height(names: Sequence[str], width: float = COLUMN - 0.5) -> float:
    """Return the height, inches, of the legend that :func:`legend_above` draws for these names."""
    return 0.13 * -(-len(names) // legend_columns(names, width))


def legend_columns(names: Sequence[str], width: float) -> int:
    """Return the number of legend columns that fit into ``width`` inches."""
    longest = min(max((len(name) for name in names), default=0), LONGEST_NAME)
    entry = 0.34 + SMALL * 0.55 / 72.0 * longest
    return max(1, min(len(names), int(width / entry)))


def legend_name(name: str) -> str:
    """Return a user-defined name for a legend: shortened in the middle, with ``$`` escaped.

    A leading underscore, with which matplotlib omits a line from the legend, is preceded by a space.
    """
    half = LONGEST_NAME // 2
    name = name if len(name) <= LONGEST_NAME else f"{name[:half]}…{name[-half:]}"
    name = name.replace("$", r"\$")
    return f" {name}" if name.startswith("_") else name


def hide_rounding(axes: Axes, rounding: float) -> None:
    """Set the y axis to ±1 if all plotted magnitudes are smaller than ``rounding`` (in the plotted unit)."""
    if all(np.abs(line.get_ydata()).max() < rounding for line in axes.lines):
        axes.set_ylim(-1.0, 1.0)


def clock(trace: Trace) -> tuple[Floats, str]:
    """Return the time of each row in a unit that suits the duration, and the label of the time axis."""
    time = np.asarray(trace.time)
    scale, unit = time_unit(time)
    return time / scale, f"time [{unit}]"


def time_unit(time: Floats) -> tuple[float, str]:
    """Return the number of seconds in a unit that suits these times, s, and the name of the unit."""
    span = float(time[-1] - time[0])
    return next(((scale, unit) for least, scale, unit in _CLOCK if span >= least), (1.0, "s"))


def plot_lines(
    axes: Axes, time: Floats, columns: Floats, names: Sequence[str], colors: Sequence[str] = COLORS
) -> None:
    """Draw one line per column of ``columns`` (T, n)."""
    for index, name in enumerate(names):
        x, y = thin(time, columns[:, index])
        axes.plot(x, y, color=colors[index], linewidth=LINE, label=legend_name(name))


def plot_angles(
    axes: Axes, time: Floats, degrees: Floats, names: Sequence[str], colors: Sequence[str] = COLORS
) -> None:
    """Draw continuous angles (T, n), degrees, wrapped to the range from -180° to 180°.

    A line is interrupted where it leaves the range.
    """
    for index, name in enumerate(names):
        x, y = thin(time, degrees[:, index])
        wrapped = (y + 180.0) % 360.0 - 180.0
        passes = np.flatnonzero(np.abs(np.diff(wrapped)) > 180.0) + 1
        x, y = np.insert(x, passes, np.nan), np.insert(wrapped, passes, np.nan)
        axes.plot(x, y, color=colors[index], linewidth=LINE, label=legend_name(name))
    axes.set_ylim(-180.0, 180.0)
    axes.set_yticks(range(-180, 181, 90))


def plot_largest(axes: Axes, time: Floats, columns: Floats, names: Sequence[str]) -> list[str]:
    """Draw the columns with the largest peaks in colours, the others in grey; return the legend entries."""
    names = list(names)
    if len(names) <= MOST_LINES:
        plot_lines(axes, time, columns, names)
        return names
    peaks = np.abs(columns).max(axis=0)
    largest = np.sort(np.argsort(-peaks)[: MOST_LINES - 1])
    others = np.setdiff1d(np.arange(len(names)), largest)
    for index in others:
        x, y = thin(time, columns[:, index])
        axes.plot(x, y, color=FAINT_INK, linewidth=0.5, alpha=0.6, label="_nolegend_")
    rest = others_of(len(others))
    axes.lines[-1].set_label(rest)
    chosen = [names[index] for index in largest]
    plot_lines(axes, time, columns[:, largest], chosen)
    return [rest, *chosen]


def others_of(count: int) -> str:
    """Return the legend entry for ``count`` grey lines."""
    return f"{count} other{'s' if count > 1 else ''}, smaller"


def thin(time: Floats, values: Floats) -> tuple[Floats, Floats]:
    """Return the end points of a line, and the minimum and the maximum of each of many equal intervals.

    These are at most :data:`MOST_POINTS` points between the ends. A shorter line is returned whole.
    """
    if len(time) <= MOST_POINTS:
        return time, values
    intervals = np.array_split(np.arange(len(time)), MOST_POINTS // 2)
    kept = [s[0] + extreme(values[s[0] : s[-1] + 1]) for s in intervals for extreme in (np.argmin, np.argmax)]
    rows = np.unique([0, *kept, len(time) - 1])
    return time[rows], values[rows]
