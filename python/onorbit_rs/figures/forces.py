"""Figure of the forces and torques of the environment on each body."""

from __future__ import annotations

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
DECADES = 1e5
"""Ratio of the largest value of all bodies to the lower end of the axis."""


def environment_forces(trace: Trace, bodies: Sequence[str]) -> Figure:
    """Draw force and torque of every effect on every body; torques are about the body's centre of mass.

    Rounding errors are not drawn. In the panel of an effect, these are magnitudes below
    :data:`~onorbit_rs.common.display_units.ROUNDING` times the largest of three values: the largest magnitude
    of the same quantity (force or torque) over all effects, and the largest force, N, and the largest torque,
    N m, of the effect itself. Magnitudes below 1e-16 N or N m are never drawn.

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
    peaks = {effect: [_size(rows, part).max() for part in _PARTS] for effect, rows in wrenches.items()}
    top = np.max(list(peaks.values()), axis=0)
    figure = new_figure(PAGE, 2.0)
    panels = figure.subplots(len(wrenches), 2, sharex=True, squeeze=False)
    for row, (effect, rows) in enumerate(wrenches.items()):
        is_last = row == len(wrenches) - 1
        for column, (what, (_, unit)) in enumerate(_PARTS.items()):
            axes = panels[row, column]
            rounding = max(ROUNDING * max(top[column], *peaks[effect]), LEAST)
            _plot_bodies(axes, time, _size(rows, what), bodies, shown, rounding)
            name = f"{legend_name(effect.replace('_', ' '))}\n" if column == 0 else ""
            tidy(axes, label if is_last else "", f"{name}{what} [{unit}]")
    names = legend_of_figure(figure, panels[0, 0])
    figure.set_figheight(0.5 + 1.35 * len(wrenches) + legend_height(names, PAGE - 0.6))
    return figure


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
    if peak > rounding:
        axes.set_yscale("log", nonpositive="mask")
        axes.set_ylim(max(peak / DECADES, rounding), 3.0 * peak)
    else:
        text = "none" if peak == 0.0 else "none above rounding"
        axes.text(0.5, 0.5, text, transform=axes.transAxes, ha="center", va="center", fontsize=SMALL)
        axes.set_ylim(1.0, 2.0)  # a logarithmic axis cannot show zero
        axes.set_yticks([])
