"""Figures of the momentum and the energy that systems exchange in captures and releases."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from onorbit_rs._core import COLUMNS
from onorbit_rs.common.display_units import ROUNDING, amount, with_prefix
from onorbit_rs.common.group_momentum import group_momentum, shared_rows
from onorbit_rs.figures.event_marks import mark_events, of_systems
from onorbit_rs.figures.style import (
    COLORS,
    INK,
    PAGE,
    SMALL,
    hide_rounding,
    legend_name,
    legend_of_figure,
    new_figure,
    plot_largest,
    plot_lines,
    tidy,
    time_unit,
)

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from onorbit_rs._core import Model, WorldTrace
    from onorbit_rs.figures.world_subject import EventMark

    Floats = NDArray[np.float64]


SMALLEST = 1e-12
"""Smallest energy lost in events, J, that is drawn."""

_FOR_LABELS = 0.45
"""Space for the labels of the bars, as multiples of the length of the longest bar."""
MOST_EVENTS = 12
"""Largest number of events whose energies are drawn."""


def momentum_exchange(
    trace: WorldTrace, models: Mapping[str, Model], systems: Sequence[str], events: Sequence[EventMark] = ()
) -> Figure:
    """Draw linear and angular momentum of each system and their sum, in axes of W.

    Angular momenta are about the common centre of mass, so that only external wrenches change the sum.
    """
    time, chosen = _common(trace, systems)
    columns = ("momentum", "center_of_mass")
    momenta, centers = ([np.asarray(getattr(trace[name], column))[rows] for name, rows in chosen.items()]
                        for column in columns)  # fmt: skip
    momentum = group_momentum(momenta, centers, [models[name].mass for name in systems])
    scale, clock = time_unit(time)
    figure = new_figure(PAGE, 4.6)
    panels = figure.subplots(3, 2, sharex=True)
    for column, (part, (entries, unit)) in enumerate(COLUMNS["momentum"].parts.items()):
        values = momentum[:, :, entries]
        factor, shown = with_prefix(float(np.abs(values).max()), unit)
        for row, axis in enumerate("xyz"):
            axes = panels[row, column]
            _draw_with_sum(axes, time / scale, factor * values[:, :, row].T, systems)
            hide_rounding(axes, ROUNDING * max(factor, 1.0))
            tidy(axes, f"time [{clock}]" if row == 2 else "", f"{part} {axis} [{shown}]")
            mark_events(axes, of_systems(events, systems), scale, has_names=row == 0)
    legend_of_figure(figure, panels[0, 0])
    return figure


def energy_exchange(trace: WorldTrace, systems: Sequence[str], events: Sequence[EventMark] = ()) -> Figure:
    """Draw the kinetic energy of each system, their sum, and the energy lost in events if there are any."""
    time, chosen = _common(trace, systems)
    scale, clock = time_unit(time)
    energy = np.stack([np.asarray(trace[name].kinetic_energy)[rows] for name, rows in chosen.items()], axis=1)
    own = of_systems(events, systems)
    figure = new_figure(PAGE, 2.5)
    left, *right = figure.subplots(1, 2 if own else 1, squeeze=False)[0]
    factor, unit = with_prefix(float(np.abs(energy.sum(axis=1)).max()), "J")
    _draw_with_sum(left, time / scale, factor * energy, systems)
    hide_rounding(left, ROUNDING * max(factor, 1.0))
    tidy(left, f"time [{clock}]", f"kinetic energy [{unit}]")
    mark_events(left, own, scale, has_names=True)
    legend_of_figure(figure, left)
    for axes in right:
        _draw_losses(axes, own[:MOST_EVENTS])
    return figure


def _draw_losses(axes: Axes, events: Sequence[EventMark]) -> None:
    """Draw a bar for the energy that each event removed or added."""
    lost = np.array([event.energy_lost for event in events])
    largest = float(np.abs(lost).max(initial=0.0))
    if 0.0 < largest < SMALLEST:
        # a capture of frames at relative rest
        lost, largest = np.zeros_like(lost), 0.0
    factor, unit = with_prefix(largest, "J")
    colors = [COLORS[0] if value < 0.0 else COLORS[1] for value in lost]
    axes.barh(np.arange(len(events)), factor * lost, height=0.5, color=colors)
    for row, value in enumerate(lost):
        text = f"{amount(abs(value), 'J')} {'added' if value < 0.0 else 'lost'}" if largest else "below 1 pJ"
        axes.annotate(text, (max(factor * value, 0.0), row), xytext=(3, 0), textcoords="offset points",
                      fontsize=SMALL, color=INK, va="center")  # fmt: skip
    axes.axvline(0.0, color=INK, linewidth=0.6)
    tidy(axes, f"energy lost [{unit}]", "")
    axes.set_yticks(np.arange(len(events)), [legend_name(event.name) for event in events])
    axes.set_ylim(len(events) - 0.4, -0.6)
    low, high = min(factor * lost.min(initial=0.0), 0.0), max(factor * lost.max(initial=0.0), 0.0)
    room = _FOR_LABELS * (high - low or 1.0)
    axes.set_xlim(low - 0.05 * room if low < 0.0 else 0.0, high + room)
    axes.grid(False, axis="y")


def _common(trace: WorldTrace, systems: Sequence[str]) -> tuple[Floats, dict[str, NDArray[np.int64]]]:
    """Return the times common to the systems, s, and the rows of each system at these times."""
    times = [np.asarray(trace[name].time) for name in systems]
    rows = shared_rows(times)
    return times[0][rows[0]], dict(zip(systems, rows, strict=True))


def _draw_with_sum(axes: Axes, time: Floats, values: Floats, systems: Sequence[str]) -> None:
    """Draw one line per system from the columns of ``values`` (T, n), and their sum as a dashed line."""
    plot_largest(axes, time, values, systems)
    plot_lines(axes, time, values.sum(axis=1)[:, None], ("sum",), (INK,))
    axes.lines[-1].set_linestyle((0, (3, 1.5)))
