"""Figures 6 and 7 of the paper: tracking errors and torques."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from onorbit_rs.figures.style import (
    COLUMN,
    INK,
    LINE,
    XYZ_COLORS,
    clock,
    legend_above,
    legend_height,
    new_figure,
    plot_largest,
    plot_lines,
    tidy,
)
from onorbit_rs.units import OR, joint_units, with_prefix

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from onorbit_rs._core import Model, Trace

    Floats = NDArray[np.float64]


def tracking_errors(trace: Trace) -> Figure:
    """Fig. 6: desired minus obtained position and attitude (rotation vector) of the tool, W axes."""
    time, label = clock(trace)
    figure = new_figure(COLUMN, 3.3)
    panels = figure.subplots(2, 1, sharex=True)
    _plot_error(panels[0], time, np.asarray(trace.position_error), "m", "position error")
    _plot_error(panels[1], time, np.asarray(trace.attitude_error), "rad", "attitude error")
    tidy(panels[1], label, panels[1].get_ylabel())
    return figure


def control_errors(trace: Trace, name: str, joints: list[str], model: Model | None = None) -> Figure:
    """The errors of one of several controllers: of its tool as in Fig. 6, or of each of its joints.

    ``model`` tells which joints slide: their errors are in m, those of the others in rad.
    """
    time, label = clock(trace)
    errors = np.asarray(trace.tracking[name])
    if not joints:
        figure = new_figure(COLUMN, 3.3)
        panels = figure.subplots(2, 1, sharex=True)
        _plot_error(panels[0], time, errors[:, :3], "m", "position error")
        _plot_error(panels[1], time, errors[:, 3:], "rad", "attitude error")
        tidy(panels[1], label, panels[1].get_ylabel())
        return figure
    kinds = {} if model is None else {joint.name: joint.kind for joint in model.joints}
    unit = joint_units(kinds[joint] for joint in joints if joint in kinds).position
    return _many(time, label, errors, joints, "joint error", unit)


def joint_torques(trace: Trace, model: Model) -> Figure:
    """Fig. 7: the torque of every joint, held over each control step."""
    time, label = clock(trace)
    unit = joint_units(joint.kind for joint in model.joints).effort
    what = "torque" if unit == "N m" else "effort"
    return _many(time, label, np.asarray(trace.tau), list(model.joint_names), what, unit)


def _many(time: Floats, label: str, columns: Floats, names: list[str], what: str, unit: str) -> Figure:
    """One plot of a line for each joint, symmetric about zero."""
    peak = max(float(np.abs(columns).max()), 1e-12)
    factor, scaled = with_prefix(peak, unit) if peak < 0.1 or peak >= 1e3 else (1.0, unit)
    if OR in unit:
        factor, scaled = 1.0, unit
    figure = new_figure(COLUMN, 2.2)
    axes = figure.subplots()
    shown = plot_largest(axes, time, factor * columns, names)
    axes.set_ylim(-1.08 * factor * peak, 1.08 * factor * peak)
    axes.axhline(0.0, color=INK, linewidth=0.5, zorder=0)
    tidy(axes, label, f"{what} [{scaled}]")
    legend_above(axes)
    figure.set_figheight(2.0 + legend_height(shown))
    return figure


def _plot_error(axes: Axes, time: Floats, error: Floats, unit: str, what: str) -> None:
    norm = np.linalg.norm(error, axis=1)
    factor, scaled_unit = with_prefix(float(norm.max()), unit)
    plot_lines(axes, time, factor * error, ("x", "y", "z"), XYZ_COLORS)
    plot_lines(axes, time, factor * norm[:, None], ("norm",), (INK,))
    axes.lines[-1].set(linestyle=(0, (3, 1.5)), linewidth=0.8 * LINE)
    tidy(axes, "", f"{what} [{scaled_unit}]")
    legend_above(axes)
