"""Figure of the motion of a captured frame relative to the capturing frame."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from onorbit_rs.common.display_units import ROUNDING, degrees_with_prefix, digits, with_prefix
from onorbit_rs.common.frame_motion import MovingFrame, frame_motion
from onorbit_rs.figures.event_marks import mark_events, of_systems
from onorbit_rs.figures.style import (
    INK,
    PAGE,
    SMALL,
    XYZ_COLORS,
    hide_rounding,
    legend_of_figure,
    new_figure,
    plot_lines,
    tidy,
    time_unit,
)

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from onorbit_rs._core import Model, WorldTrace
    from onorbit_rs.figures.world_subject import EventMark
    from onorbit_rs.scenario.connections import Connection

    Floats = NDArray[np.float64]


MOST_ABOVE = 3.0
"""Largest ratio of the limit of a latch to the peak of the quantity at which the limit is drawn as a line."""


def captured_motion(
    trace: WorldTrace, models: Mapping[str, Model], connection: Connection, events: Sequence[EventMark] = ()
) -> Figure:
    """Draw the motion of a captured frame in axes of the capturing frame, over the whole run.

    The panels show position, attitude (as a rotation vector), velocity and angular velocity: the quantities
    that a latch compares with its limits. Black lines are magnitudes; dashed lines are the limits of the
    latch.
    """
    moving = [
        MovingFrame(models[system], frame, trace[system].q, trace[system].v)
        for system, frame in (connection.by, connection.of)
    ]
    motion = frame_motion(*moving)
    scale, clock = time_unit(times := np.asarray(trace[connection.by[0]].time))
    time, label = times / scale, f"time [{clock}]"
    limits = _limits(connection)
    figure = new_figure(PAGE, 3.9)
    panels = figure.subplots(2, 2, sharex=True)
    quantities = (
        ("position", "m", motion.position, limits[0]),
        ("attitude", "deg", np.degrees(motion.rotation), limits[1]),
        ("velocity", "m/s", motion.velocity, limits[2]),
        ("angular velocity", "deg/s", np.degrees(motion.rate), limits[3]),
    )
    for number, (axes, (name, unit, values, limit)) in enumerate(zip(panels.flat, quantities, strict=True)):
        shown = _draw(axes, time, values, unit, limit)
        tidy(axes, label if number > 1 else "", f"{name} [{shown}]")
        mark_events(axes, of_systems(events, connection.systems), scale, has_names=number < 2)
    legend_of_figure(figure, panels[0, 0])
    return figure


def _limits(connection: Connection) -> list[float | None]:
    """Return the limits of a latch: distance, m, angle, deg, speed, m/s, and angular rate, deg/s.

    A limit that the latch does not have is None.
    """
    latch = connection.latch
    limits = [] if latch is None else [*latch.within, *(latch.slower_than or ())]
    found: list[float | None] = [*limits, *[None] * (4 - len(limits))]
    return [limit if limit is None or number % 2 == 0 else float(np.degrees(limit))
            for number, limit in enumerate(found)]  # fmt: skip


def _draw(axes: Axes, time: Floats, values: Floats, unit: str, limit: float | None) -> str:
    """Draw components and magnitude of a vector and the latch's limit; return the unit with its prefix."""
    size = np.linalg.norm(values, axis=1)
    scaled = degrees_with_prefix if unit.startswith("deg") else with_prefix
    factor, shown = scaled(float(size.max()), unit)
    plot_lines(axes, time, factor * size[:, None], ("magnitude",), (INK,))
    lines = _broken(values) if unit == "deg" else values
    plot_lines(axes, time, factor * lines, ("x", "y", "z"), XYZ_COLORS)
    if limit is not None:
        _draw_limit(axes, factor * limit, factor * float(size.max()), shown)
    hide_rounding(axes, ROUNDING * max(factor, 1.0))
    return shown


def _draw_limit(axes: Axes, limit: float, peak: float, unit: str) -> None:
    """Draw the limit of a latch as a line, or print its value if the line would compress the other lines."""
    if limit <= MOST_ABOVE * peak:
        axes.axhline(limit, color=INK, linewidth=0.7, linestyle=(0, (2, 2)), label="latch")
        return
    text = f"latch: {digits(limit)} {unit}"
    axes.text(0.98, 0.97, text, transform=axes.transAxes, ha="right", va="top", fontsize=SMALL, color=INK)


def _broken(values: Floats) -> Floats:
    """Return rotation vectors (T, 3), deg, with a gap (NaN) at each jump of more than 180 degrees."""
    found = values.copy()
    found[1:][np.linalg.norm(np.diff(values, axis=0), axis=1) > 180.0] = np.nan
    return found
