"""Figures 6 and 7 of the paper: tracking errors and torques."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
from matplotlib.figure import Figure

from onorbit_rs.figures.style import (
    COLORS,
    INK,
    XYZ_COLORS,
    legend_beside,
    new_figure,
    plot_lines,
    tidy,
    with_prefix,
)

if TYPE_CHECKING:
    from onorbit_rs._core import Model, Trace


def tracking_errors(trace: Trace) -> Figure:
    """Fig. 6: desired minus obtained position and attitude (rotation vector) of the tool, W axes."""
    figure = new_figure(8.0, 5.0, "Tracking error of the tool (Fig. 6)")
    panels = figure.subplots(2, 1, sharex=True)
    rows = [
        (trace.position_error, "m", "a) position error"),
        (trace.attitude_error, "rad", "b) attitude error"),
    ]
    for axes, (column, unit, name) in zip(panels, rows, strict=True):
        error = np.asarray(column)
        norm = np.linalg.norm(error, axis=1)
        factor, scaled_unit = with_prefix(float(norm.max()), unit)
        plot_lines(axes, trace.time, factor * error, ("x", "y", "z"), XYZ_COLORS)
        plot_lines(axes, trace.time, factor * norm[:, None], ("norm",), (INK,))
        axes.lines[-1].set(linestyle="--", linewidth=1.0)
        tidy(axes, "", f"{name} [{scaled_unit}]")
        legend_beside(axes)
    panels[-1].set_xlabel("time [s]", fontsize=9, color=INK)
    return figure


def joint_torques(trace: Trace, model: Model) -> Figure:
    """Fig. 7: the torque of every joint, held over each control step."""
    tau = np.asarray(trace.tau)
    figure = new_figure(8.0, 3.8, "Control action: joint torques (Fig. 7)")
    axes = figure.subplots()
    peak = max(float(np.abs(tau).max()), 1e-12)
    factor, unit = with_prefix(peak, "N m") if peak < 0.1 else (1.0, "N m")
    plot_lines(axes, trace.time, factor * tau, list(model.joint_names), COLORS)
    axes.set_ylim(-1.08 * factor * peak, 1.08 * factor * peak)
    axes.axhline(0.0, color=INK, linewidth=0.6, zorder=0)
    tidy(axes, "time [s]", f"torque [{unit}]")
    legend_beside(axes, ncols=1 + len(model.joint_names) // 15)
    return figure
