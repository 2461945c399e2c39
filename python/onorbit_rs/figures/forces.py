"""What the environment does to each body."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from onorbit_rs.figures.style import (
    COLORS,
    FAINT_INK,
    PAGE,
    SMALL,
    clock,
    legend_columns,
    legend_height,
    legend_name,
    new_figure,
    others_of,
    thin,
    tidy,
)
from onorbit_rs.units import ROUNDING

if TYPE_CHECKING:
    from collections.abc import Sequence

    from numpy.typing import NDArray

    from onorbit_rs._core import Trace

    Floats = NDArray[np.float64]

MOST_BODIES = len(COLORS)
"""Each with a colour of its own; the others are grey."""
LEAST = 1e-16
"""N, N m; less is what is left of rounding where all of an effect is taken away, as of a carried body."""
DECADES = 1e5
"""Below the largest of all bodies nothing is shown."""


def environment_forces(trace: Trace, bodies: Sequence[str]) -> Figure:
    """Size of the force of every effect on every body, and of its torque about the body's centre of mass.

    Rounding is no signal: nothing is drawn below :data:`~onorbit_rs.units.ROUNDING` of the largest force or
    torque of all effects, and of what the effect's own have on a lever of 1 m.
    Needs a run with ``record_wrenches``; ``bodies`` are ``model.body_names``.
    """
    time, label = clock(trace)
    wrenches = {name: np.asarray(rows) for name, rows in trace.wrenches.items()}
    shown = _largest(wrenches)
    peaks = {effect: (_size(rows, 0).max(), _size(rows, 1).max()) for effect, rows in wrenches.items()}
    top = np.max(list(peaks.values()), axis=0)
    figure = new_figure(PAGE, 2.0)
    panels = figure.subplots(len(wrenches), 2, sharex=True, squeeze=False)
    for row, (effect, rows) in enumerate(wrenches.items()):
        is_last = row == len(wrenches) - 1
        for column, (what, unit) in enumerate((("force", "N"), ("torque", "N m"))):
            axes = panels[row, column]
            rounding = max(ROUNDING * max(top[column], *peaks[effect]), LEAST)
            _plot_bodies(axes, time, _size(rows, column), bodies, shown, rounding)
            name = f"{legend_name(effect.replace('_', ' '))}\n" if column == 0 else ""
            tidy(axes, label if is_last else "", f"{name}{what} [{unit}]")
    handles, names = panels[0, 0].get_legend_handles_labels()
    figure.legend(
        handles, names, loc="outside upper left", frameon=False, fontsize=SMALL,
        ncols=legend_columns(names, PAGE - 0.6), handlelength=1.6, handletextpad=0.5, columnspacing=1.2,
    )  # fmt: skip
    figure.set_figheight(0.5 + 1.35 * len(wrenches) + legend_height(names, PAGE - 0.6))
    return figure


def _size(rows: Floats, part: int) -> Floats:
    """Of the force (0) or torque (1), (T, bodies), of wrenches (T, bodies, 6)."""
    size: Floats = np.linalg.norm(rows[:, :, 3 * part : 3 * part + 3], axis=2)
    return size


def _largest(wrenches: dict[str, Floats]) -> list[int]:
    """The bodies that some effect acts on most, each effect counted as a share of its own largest."""
    shares = [
        peak / max(peak.max(), 1e-300)
        for rows in wrenches.values()
        for peak in (_size(rows, 0).max(axis=0), _size(rows, 1).max(axis=0))
    ]
    order = np.argsort(-np.max(shares, axis=0), kind="stable")
    return sorted(int(body) for body in order[:MOST_BODIES])


def _plot_bodies(
    axes: Axes, time: Floats, size: Floats, bodies: Sequence[str], shown: list[int], rounding: float
) -> None:
    """One line for each body, on a logarithmic scale: a hand and its station are far apart."""
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
        said = "none" if peak == 0.0 else "none above rounding"
        axes.text(0.5, 0.5, said, transform=axes.transAxes, ha="center", va="center", fontsize=SMALL)
        axes.set_ylim(1.0, 2.0)  # where no zero is
        axes.set_yticks([])
