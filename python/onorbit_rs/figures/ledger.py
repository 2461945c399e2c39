"""The ledger of momentum and energy: what came and went, and what is left unexplained."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from onorbit_rs.figures.style import (
    COLORS,
    INK,
    LINE,
    PAGE,
    XYZ_COLORS,
    calm,
    clock,
    legend_above,
    new_figure,
    plot_lines,
    tidy,
)
from onorbit_rs.units import ROUNDING, with_prefix

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from onorbit_rs._core import Trace

    Floats = NDArray[np.float64]

_STRETCHES = 300


def ledger(trace: Trace) -> Figure:
    """Momentum, energy and work on the left; on the right, what the certificate says should stay zero.

    In W it is `P - ∫ΣF dt` and `L_com - ∫ΣT dt` that stay, and `K - W`, where the work `W` on the robot is
    that of motors and external wrenches less what damping, friction and stops took.
    """
    time, label = clock(trace)
    momentum, impulse = np.asarray(trace.momentum), np.asarray(trace.impulse)
    kinetic, work, lost = (
        np.asarray(column) for column in (trace.kinetic_energy, trace.work, trace.dissipated)
    )
    figure = new_figure(PAGE, 4.5)
    panels = figure.subplots(3, 2, sharex=True)
    unexplained = [
        momentum[:, :3] - impulse[:, :3],
        momentum[:, 3:] - impulse[:, 3:],
        (kinetic - work)[:, None],
    ]
    for row, (what, unit) in enumerate(
        (("linear\nmomentum", "N s"), ("angular\nmomentum", "N m s"), ("energy", "J"))
    ):
        columns, names = momentum[:, 3 * row : 3 * row + 3], ["x", "y", "z"]
        if row == 2:
            columns, names = (
                np.column_stack([kinetic, work, lost]),
                ["kinetic", "work on the robot", "dissipated"],
            )
        if row == 2 and not lost.any():
            columns, names = columns[:, :2], names[:2]
        factor, scaled = with_prefix(float(np.abs(columns).max()), unit)
        plot_lines(panels[row, 0], time, factor * columns, names, COLORS if row == 2 else XYZ_COLORS)
        if row == 2:
            panels[row, 0].lines[1].set_linestyle((0, (3, 1.5)))  # it may lie upon the kinetic energy
        calm(panels[row, 0], ROUNDING * max(factor, 1.0))
        tidy(panels[row, 0], label if row == 2 else "", f"{what} [{scaled}]")
        legend_above(panels[row, 0])
        drift = np.linalg.norm(unexplained[row] - unexplained[row][0], axis=1)
        _plot_unexplained(panels[row, 1], time, drift)
        tidy(panels[row, 1], label if row == 2 else "", f"unexplained [{unit}]")
    return figure


def _plot_unexplained(axes: Axes, time: Floats, drift: Floats) -> None:
    """The largest of each stretch, on a logarithmic scale where anything is above zero."""
    stretches = np.array_split(np.arange(len(time)), min(_STRETCHES, len(time)))
    rows = np.array([stretch[0] + np.argmax(drift[stretch[0] : stretch[-1] + 1]) for stretch in stretches])
    axes.plot(time[rows], drift[rows], color=INK, linewidth=LINE)
    above = drift[rows][drift[rows] > 0.0]
    if above.size:
        axes.set_yscale("log", nonpositive="mask")
        low = max(float(np.quantile(above, 0.02)), float(above.max()) * 1e-9)
        axes.set_ylim(low / 10.0, float(above.max()) * 10.0)
    else:
        axes.set_ylim(-1.0, 1.0)
