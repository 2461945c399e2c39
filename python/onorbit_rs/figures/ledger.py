"""Figure of momentum and energy, and of the part of their change that impulse and work do not explain."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from onorbit_rs._core import COLUMNS
from onorbit_rs.common.display_units import ROUNDING, with_prefix
from onorbit_rs.figures.style import (
    COLORS,
    INK,
    LINE,
    PAGE,
    XYZ_COLORS,
    clock,
    hide_rounding,
    legend_above,
    new_figure,
    plot_lines,
    tidy,
)

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from onorbit_rs._core import Trace

    Floats = NDArray[np.float64]

_INTERVALS = 300


def ledger(trace: Trace) -> Figure:
    """Draw momentum, energy and work on the left, and the drift of their balances on the right.

    In W, `P - ∫ΣF dt`, `L_com - ∫ΣT dt` and `K - W` are constant: linear momentum and angular momentum about
    the centre of mass less the impulses of the external forces and torques, and kinetic energy less work. The
    work `W` on the robot is the work of motors, springs and external wrenches minus the energy dissipated in
    damping, friction and stops.
    """
    time, label = clock(trace)
    momentum, impulse = np.asarray(trace.momentum), np.asarray(trace.impulse)
    kinetic, work, lost = (
        np.asarray(column) for column in (trace.kinetic_energy, trace.work, trace.dissipated)
    )
    figure = new_figure(PAGE, 4.5)
    panels = figure.subplots(3, 2, sharex=True)
    residual = momentum - impulse
    quantities = [
        (f"{part}\nmomentum", unit, momentum[:, entries], ["x", "y", "z"], residual[:, entries])
        for part, (entries, unit) in COLUMNS["momentum"].parts.items()
    ]
    energies = {"kinetic": kinetic, "work on the robot": work} | ({"dissipated": lost} if lost.any() else {})
    if trace.spring_energy is not None:
        energies["in springs"] = np.asarray(trace.spring_energy)
    columns, balance = np.column_stack(list(energies.values())), (kinetic - work)[:, None]
    quantities.append(("energy", COLUMNS["kinetic_energy"].unit, columns, list(energies), balance))
    for row, (what, unit, columns, names, unexplained) in enumerate(quantities):
        factor, scaled = with_prefix(float(np.abs(columns).max()), unit)
        plot_lines(panels[row, 0], time, factor * columns, names, COLORS if row == 2 else XYZ_COLORS)
        if row == 2:
            panels[row, 0].lines[1].set_linestyle((0, (3, 1.5)))  # a solid line could hide the kinetic energy
        hide_rounding(panels[row, 0], ROUNDING * max(factor, 1.0))
        tidy(panels[row, 0], label if row == 2 else "", f"{what} [{scaled}]")
        legend_above(panels[row, 0])
        drift = np.linalg.norm(unexplained - unexplained[0], axis=1)
        _plot_unexplained(panels[row, 1], time, drift)
        tidy(panels[row, 1], label if row == 2 else "", f"unexplained [{unit}]")
    return figure


def _plot_unexplained(axes: Axes, time: Floats, drift: Floats) -> None:
    """Draw the largest value of each time interval, on a logarithmic scale if any is above zero."""
    intervals = np.array_split(np.arange(len(time)), min(_INTERVALS, len(time)))
    rows = np.array(
        [interval[0] + np.argmax(drift[interval[0] : interval[-1] + 1]) for interval in intervals]
    )
    axes.plot(time[rows], drift[rows], color=INK, linewidth=LINE)
    above = drift[rows][drift[rows] > 0.0]
    if above.size:
        axes.set_yscale("log", nonpositive="mask")
        low = max(float(np.quantile(above, 0.02)), float(above.max()) * 1e-9)
        axes.set_ylim(low / 10.0, float(above.max()) * 10.0)
    else:
        axes.set_ylim(-1.0, 1.0)
