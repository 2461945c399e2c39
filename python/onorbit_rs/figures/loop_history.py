"""Figure of the force, the moment and the opening of a closed loop."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from onorbit_rs.common.display_units import ROUNDING, with_prefix
from onorbit_rs.figures.style import (
    COLORS,
    INK,
    PAGE,
    XYZ_COLORS,
    clock,
    hide_rounding,
    legend_of_figure,
    new_figure,
    plot_lines,
    tidy,
)

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from onorbit_rs._core import Trace

    Floats = NDArray[np.float64]

SMALLEST_OPENING = 1e-18
"""Opening, m or rad, at the lower end of the logarithmic scale; smaller ones are drawn there."""


def loop_history(trace: Trace, name: str) -> Figure:
    """Draw force and moment of a closed loop in W, and its opening on a logarithmic scale.

    Black lines are magnitudes.

    Parameters
    ----------
    trace : Trace
        Trace of the robot.
    name : str
        Name of the loop, or of the capture that closes it.
    """
    loop = trace.loops[name]
    time, label = clock(trace)
    figure = new_figure(PAGE, 3.9)
    panels = figure.subplots(2, 2, sharex=True)
    for axes, what, unit in ((panels[0, 0], "force", "N"), (panels[0, 1], "moment", "N m")):
        shown = _draw_vector(axes, time, np.asarray(getattr(loop, what)), unit)
        tidy(axes, "", f"{what} [{shown}]")
    opening = np.asarray(loop.opening)
    for number, (axes, what, unit) in enumerate(
        ((panels[1, 0], "opening", "m"), (panels[1, 1], "opening angle", "rad"))
    ):
        _draw_opening(axes, time, opening[:, [number]], what)
        tidy(axes, label, f"{what} [{unit}]")
    legend_of_figure(figure, panels[0, 0])
    return figure


def _draw_opening(axes: Axes, time: Floats, values: Floats, what: str) -> None:
    """Draw an opening (T, 1) on a logarithmic scale, or on a linear one if it is always zero."""
    if not values.any():
        plot_lines(axes, time, values, (what,), COLORS)
        axes.set_ylim(-1.0, 1.0)
        return
    drawn = np.maximum(values, SMALLEST_OPENING)
    plot_lines(axes, time, drawn, (what,), COLORS)
    axes.set_yscale("log")
    axes.set_ylim(SMALLEST_OPENING, max(10.0 * float(drawn.max()), 1e-14))


def _draw_vector(axes: Axes, time: Floats, values: Floats, unit: str) -> str:
    """Draw components and magnitude of a vector (T, 3); return the unit with its prefix."""
    size = np.linalg.norm(values, axis=1, keepdims=True)
    peak = float(size.max(initial=0.0))
    factor, shown = with_prefix(peak, unit) if peak > ROUNDING else (1.0, unit)
    plot_lines(axes, time, factor * size, ("magnitude",), (INK,))
    plot_lines(axes, time, factor * values, ("x", "y", "z"), XYZ_COLORS)
    hide_rounding(axes, ROUNDING * max(factor, 1.0))
    return shown
