"""How the base moves, and what is conserved while it does."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from onorbit_rs.figures.style import (
    COLORS,
    FAINT_INK,
    INK,
    XYZ_COLORS,
    legend_beside,
    new_figure,
    plot_lines,
    tidy,
    with_prefix,
)
from onorbit_rs.rotations import roll_pitch_yaw

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from onorbit_rs._core import Trace

    Floats = NDArray[np.float64]


def base_motion(trace: Trace) -> Figure:
    """Position and attitude of the base that nothing holds, in W."""
    position = np.asarray(trace.q)[:, :3]
    angles = np.degrees(np.unwrap(roll_pitch_yaw(np.asarray(trace.q)[:, 3:7]), axis=0))
    figure = new_figure(8.0, 5.0, "Motion of the free base")
    panels = figure.subplots(2, 1, sharex=True)
    factor, unit = with_prefix(float(np.abs(position).max()), "m")
    plot_lines(panels[0], trace.time, factor * position, ("x", "y", "z"), XYZ_COLORS)
    plot_lines(panels[1], trace.time, angles, ("roll", "pitch", "yaw"), XYZ_COLORS)
    tidy(panels[0], "", f"base position [{unit}]")
    tidy(panels[1], "time [s]", "base attitude [deg]")
    for axes in panels:
        legend_beside(axes)
    return figure


def conservation(trace: Trace) -> Figure:
    """What the certificate checks: momentum less the impulse of external wrenches, energy less the work done.

    In W it is `P - ∫ΣF dt` and `L_com - ∫ΣT dt` that stay, and `K - ∫ power dt`.
    """
    momentum = np.asarray(trace.momentum) - np.asarray(trace.impulse)
    drift = np.abs(momentum - momentum[0])
    balance = np.asarray(trace.kinetic_energy) - np.asarray(trace.work)
    energy = np.column_stack([trace.kinetic_energy, np.abs(balance - balance[0])])
    figure = new_figure(8.0, 6.4, "Conservation: change of what should not change")
    panels = figure.subplots(3, 1, sharex=True)
    rows = [
        (drift[:, :3], ("x", "y", "z"), XYZ_COLORS, "linear momentum\n[N s]"),
        (drift[:, 3:], ("x", "y", "z"), XYZ_COLORS, "angular momentum\n[N m s]"),
        (energy, ("kinetic energy", "its change less\nthe work done"), (FAINT_INK, COLORS[0]), "energy\n[J]"),
    ]
    for axes, (columns, names, colors, y_label) in zip(panels, rows, strict=True):
        plot_lines(axes, trace.time, columns, names, colors)
        tidy(axes, "", y_label)
        _log_scale(axes, columns)
        legend_beside(axes)
    panels[-1].set_xlabel("time [s]", fontsize=9, color=INK)
    return figure


def _log_scale(axes: Axes, values: Floats) -> None:
    """Logarithmic where anything is above zero; at most 17 decades."""
    above = values[values > 0.0]
    if above.size:
        axes.set_yscale("log", nonpositive="mask")
        axes.set_ylim(max(float(above.min()), float(above.max()) * 1e-17) / 3.0, float(above.max()) * 3.0)
