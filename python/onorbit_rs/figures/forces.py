"""Figure of the forces and torques of the environment on each body."""

from __future__ import annotations

import textwrap
from typing import TYPE_CHECKING

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from onorbit_rs._core import COLUMNS
from onorbit_rs.common.display_units import ROUNDING
from onorbit_rs.figures.style import (
    COLORS,
    FAINT_INK,
    PAGE,
    SMALL,
    clock,
    legend_height,
    legend_name,
    legend_of_figure,
    new_figure,
    others_of,
    thin,
    tidy,
)

if TYPE_CHECKING:
    from collections.abc import Sequence

    from numpy.typing import NDArray

    from onorbit_rs._core import Trace

    Floats = NDArray[np.float64]

_PARTS = COLUMNS["wrenches"].parts

MOST_BODIES = len(COLORS)
"""Largest number of bodies drawn in colour; the others are grey."""
LEAST = 1e-16
"""Smallest value that is drawn, N or N m; smaller values are the rounding error of a removed acceleration."""
NOTE_WIDTH = 120
"""Number of characters of a line of the note on forces and torques that are not drawn."""
DECADES = 1e5
"""Ratio of the largest value of all bodies to the lower end of the axis."""


def environment_forces(trace: Trace, bodies: Sequence[str]) -> Figure:
    """Draw force and torque of every effect on every body; torques are about the body's centre of mass.

    Rounding errors are not drawn. For an effect, these are magnitudes below
    :data:`~onorbit_rs.common.display_units.ROUNDING` times the largest of three values: the largest magnitude
    of the same quantity (force or torque) over all effects, and the largest force, N, and the largest torque,
    N m, of the effect itself. Magnitudes below 1e-16 N or N m are never drawn. A force or torque without
    larger values has no panel and is listed below the panels.

    Parameters
    ----------
    trace : Trace
        Trace of a run with ``record_wrenches``.
    bodies : sequence of str
        Names of the bodies, ``model.body_names``.
    """
    time, label = clock(trace)
    wrenches = {name: np.asarray(rows) for name, rows in trace.wrenches.items()}
    shown = _largest(wrenches)
    rounding = _rounding(wrenches)
    drawn = {effect: [part for part in _PARTS if _size(rows, part).max() > rounding[effect, part]]
             for effect, rows in wrenches.items()}  # fmt: skip
    rows_drawn = [effect for effect, parts in drawn.items() if parts]
    figure = new_figure(PAGE, 2.0)
    grid = figure.add_gridspec(max(len(rows_drawn), 1), 2)
    for row, effect in enumerate(rows_drawn):
        alone = len(drawn[effect]) == 1
        for column, part in enumerate(drawn[effect]):
            axes = figure.add_subplot(grid[row, :] if alone else grid[row, column])
            size, (_, unit) = _size(wrenches[effect], part), _PARTS[part]
            _plot_bodies(axes, time, size, bodies, shown, rounding[effect, part])
            name = f"{legend_name(effect.replace('_', ' '))}\n" if column == 0 else ""
            tidy(axes, label if effect == rows_drawn[-1] else "", f"{name}{part} [{unit}]")
    if not rows_drawn:
        figure.add_subplot(grid[:, :]).set_axis_off()
    names = legend_of_figure(figure, figure.axes[0]) if rows_drawn else []
    note = _note([(effect, part) for effect, parts in drawn.items() for part in _PARTS if part not in parts])
    if note:
        figure.supxlabel(note, fontsize=SMALL, x=0.01, ha="left")
    lines = 1 + note.count("\n") if note else 0
    height = 0.5 + 1.35 * max(len(rows_drawn), 0.2) + 0.15 * lines
    figure.set_figheight(height + legend_height(names, PAGE - 0.6))
    return figure


def _rounding(wrenches: dict[str, Floats]) -> dict[tuple[str, str], float]:
    """Return the rounding error of force and torque of each effect, N and N m."""
    peaks = {effect: [_size(rows, part).max() for part in _PARTS] for effect, rows in wrenches.items()}
    top = np.max(list(peaks.values()), axis=0)
    return {
        (effect, part): max(ROUNDING * max(largest, *peaks[effect]), LEAST)
        for effect in wrenches
        for part, largest in zip(_PARTS, top, strict=True)
    }


def _note(absent: Sequence[tuple[str, str]]) -> str:
    """Return the forces and torques without a panel as text; empty if every one has a panel."""
    if not absent:
        return ""
    listed = ", ".join(f"{part} of {legend_name(effect.replace('_', ' '))}" for effect, part in absent)
    return textwrap.fill(f"zero or rounding: {listed}", NOTE_WIDTH)


def _size(rows: Floats, part: str) -> Floats:
    """Return the magnitude (T, bodies), N or N m, of ``force`` or ``torque`` of wrenches (T, bodies, 6)."""
    entries, _ = _PARTS[part]
    size: Floats = np.linalg.norm(rows[:, :, entries], axis=2)
    return size


def _largest(wrenches: dict[str, Floats]) -> list[int]:
    """Return the indices of the bodies with the largest wrenches, relative to the peak of each effect."""
    fractions = [
        peak / max(peak.max(), 1e-300)
        for rows in wrenches.values()
        for peak in (_size(rows, part).max(axis=0) for part in _PARTS)
    ]
    order = np.argsort(-np.max(fractions, axis=0), kind="stable")
    return sorted(int(body) for body in order[:MOST_BODIES])


def _plot_bodies(
    axes: Axes, time: Floats, size: Floats, bodies: Sequence[str], shown: list[int], rounding: float
) -> None:
    """Draw one line for each body on a logarithmic scale, because bodies differ by orders of magnitude."""
    others = [body for body in range(len(bodies)) if body not in shown]
    for body in others:
        axes.plot(*thin(time, size[:, body]), color=FAINT_INK, linewidth=0.5, label="_nolegend_")
    if others:
        axes.lines[-1].set_label(others_of(len(others)))
    for color, body in zip(COLORS, shown, strict=False):
        axes.plot(*thin(time, size[:, body]), color=color, linewidth=0.9, label=legend_name(bodies[body]))
    peak = float(size.max())
    axes.set_yscale("log", nonpositive="mask")
    axes.set_ylim(max(peak / DECADES, rounding), 3.0 * peak)
