"""Figure of the touches and the smallest distances of all contacts over the whole run."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from onorbit_rs.common.counting import count
from onorbit_rs.common.display_units import amount, with_prefix
from onorbit_rs.common.touches import Touch, touches_of
from onorbit_rs.figures.style import (
    COLORS,
    FAINT_INK,
    INK,
    LINE,
    MOST_LINES,
    PAGE,
    SMALL,
    legend_above,
    legend_name,
    new_figure,
    thin,
    tidy,
    time_unit,
)

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from onorbit_rs._core import WorldTrace
    from onorbit_rs.figures.world_subject import EventMark

    Floats = NDArray[np.float64]

MOST_BARS = 24
"""Largest number of contacts with a row of bars."""
DETAIL = 0.02
"""Smallest distance or depth, as a fraction of the plotted range, that a linear scale resolves."""


def contact_overview(trace: WorldTrace, events: Sequence[EventMark] = ()) -> Figure:
    """Draw a bar from touch-down to lift-off for each touch of each contact, and the gaps over time.

    The scale of the gaps is linear. If the closest approach or the depth would not be visible, the scale is
    logarithmic in both directions, except for a linear part around zero.

    Parameters
    ----------
    trace : WorldTrace
        Trace of the run.
    events : sequence of EventMark
        Events of the run, of which the touch-downs and lift-offs are drawn.
    """
    names = list(trace.contacts)
    time = {name: np.asarray(trace[system].time) for system in trace.names
            for name in trace[system].contacts}  # fmt: skip
    end = max(float(own[-1]) for own in time.values())
    scale, clock = time_unit(np.array([0.0, end]))
    rows = min(len(names), MOST_BARS)
    bars = 0.35 + 0.2 * rows
    figure = new_figure(PAGE, bars + 2.3)
    upper, lower = figure.subplots(2, 1, sharex=True, height_ratios=[bars, 2.3])
    touches = touches_of(events, end)
    for row, name in enumerate(names[:MOST_BARS]):
        _draw_touches(upper, row, touches.get(name, []), int(trace.contacts[name].touches[-1]), scale)
    tidy(upper, "", "")
    upper.set_yticks(range(rows), [legend_name(name) for name in names[:MOST_BARS]])
    upper.set_ylim(rows - 0.4, -0.6)
    upper.grid(False, axis="y")
    _draw_gaps(lower, {name: (time[name] / scale, np.asarray(trace.contacts[name].gap)) for name in names})
    lower.set_xlabel(f"time [{clock}]")
    lower.set_xlim(0.0, end / scale)
    return figure


def _draw_touches(axes: Axes, row: int, touches: Sequence[Touch], number: int, scale: float) -> None:
    """Draw the touches of a contact; beside them, print number and duration, or how many are drawn."""
    ranges = [(start / scale, (stop - start) / scale) for start, stop in touches]
    color = COLORS[row % len(COLORS)]
    axes.broken_barh(ranges, (row - 0.3, 0.6), facecolor=color, edgecolor=color, linewidth=1.0)
    text = "no touch"
    if touches:
        total = amount(sum(stop - start for start, stop in touches), "s")
        text = f"{count(number, 'touch', 'touches')}, {total}"
        if len(touches) < number:
            text = f"{len(touches)} of {number} touches drawn"
    axes.annotate(text, (1.0, row), xycoords=axes.get_yaxis_transform(), xytext=(4, 0), va="center",
                  textcoords="offset points", fontsize=SMALL, color=INK, annotation_clip=False)  # fmt: skip


def _draw_gaps(axes: Axes, gaps: Mapping[str, tuple[Floats, Floats]]) -> None:
    """Draw the gap of each contact, given times and values, with a line at zero."""
    values = [gap for _, gap in gaps.values()]
    factor, unit = with_prefix(max(float(np.abs(gap).max()) for gap in values), "m")
    axes.axhline(0.0, color=FAINT_INK, linewidth=0.8)
    for index, (name, (time, gap)) in enumerate(gaps.items()):
        x, y = thin(time, factor * gap)
        color = COLORS[index] if len(gaps) <= MOST_LINES else FAINT_INK
        axes.plot(x, y, color=color, linewidth=LINE, label=legend_name(name))
    tidy(axes, "", f"gap [{unit}]")
    linear = linear_part(values)
    if linear is not None:
        axes.set_yscale("symlog", linthresh=factor * linear)
    if 1 < len(gaps) <= MOST_LINES:
        legend_above(axes, PAGE - 0.7)


def linear_part(gaps: Sequence[Floats]) -> float | None:
    """Return the half width, m, of the linear part of a logarithmic scale for gaps; None for a linear scale.

    The half width is the smallest depth or closest distance of a contact, but at least 1e-6 of the range of
    the gaps, rounded down to a power of ten.
    """
    span = max(float(gap.max()) for gap in gaps) - min(float(gap.min()) for gap in gaps)
    nearest = [abs(float(gap.min())) for gap in gaps if gap.min() != 0.0]
    if not nearest or min(nearest) >= DETAIL * span:
        return None
    return float(10.0 ** math.floor(math.log10(max(min(nearest), 1e-6 * span))))
