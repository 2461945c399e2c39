"""Figures 6 and 7 of the OnOrbitROS paper: tracking errors and joint torques."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from onorbit_rs._core import COLUMNS
from onorbit_rs.common.display_units import OR, ROUNDING, JointUnits, joint_units, with_prefix
from onorbit_rs.figures.style import (
    COLUMN,
    INK,
    LINE,
    XYZ_COLORS,
    clock,
    hide_rounding,
    legend_above,
    legend_height,
    new_figure,
    plot_largest,
    plot_lines,
    tidy,
)

if TYPE_CHECKING:
    from collections.abc import Sequence

    from numpy.typing import NDArray

    from onorbit_rs._core import Model, Trace

    Floats = NDArray[np.float64]


def tracking_errors(trace: Trace) -> Figure:
    """Draw desired minus obtained position and attitude of the tool in W: Fig. 6 of the OnOrbitROS paper.

    The attitude error is a rotation vector.
    """
    time, label = clock(trace)
    figure = new_figure(COLUMN, 3.3)
    panels = figure.subplots(2, 1, sharex=True)
    _plot_errors(panels, time, (trace.position_error, trace.attitude_error))
    tidy(panels[1], label, panels[1].get_ylabel())
    return figure


def control_errors(
    trace: Trace, name: str, joints: list[str], model: Model | None = None, *, are_rates: bool = False
) -> Figure:
    """Draw the errors of one of several controllers.

    Parameters
    ----------
    trace : Trace
        Trace of the run.
    name : str
        Name of the control.
    joints : list of str
        Joints of the control; empty for a control of a tool, whose errors are drawn as by
        :func:`tracking_errors`.
    model : Model, optional
        Robot, which determines the kinds of the joints: errors of prismatic joints, m, have a separate panel.
    are_rates : bool
        Whether the errors are those of joint rates, rad/s and m/s, as for a PID with the interface
        ``velocity``.
    """
    time, label = clock(trace)
    errors = np.asarray(trace.tracking[name])
    if not joints:
        figure = new_figure(COLUMN, 3.3)
        panels = figure.subplots(2, 1, sharex=True)
        _plot_errors(panels, time, np.split(errors, 2, axis=1))
        tidy(panels[1], label, panels[1].get_ylabel())
        return figure
    groups = [
        (rows, "joint rate error", units.rate) if are_rates else (rows, "joint error", units.position)
        for rows, units in _by_kind(joints, model)
    ]
    return _many(time, label, errors, joints, groups)


def joint_torques(trace: Trace, model: Model) -> Figure:
    """Draw the torque of revolute joints, and in a separate panel the force of prismatic joints.

    This is Fig. 7 of the OnOrbitROS paper.
    """
    time, label = clock(trace)
    names = list(model.joint_names)
    groups = [
        (rows, "torque" if units == joint_units(["revolute"]) else "force", units.effort)
        for rows, units in _by_kind(names, model)
    ]
    return _many(time, label, np.asarray(trace.tau), names, groups)


def _by_kind(names: Sequence[str], model: Model | None) -> list[tuple[list[int], JointUnits]]:
    """Return columns and units of revolute and of prismatic joints; one group if the kinds are unknown."""
    kinds = {} if model is None else {joint.name: joint.kind for joint in model.joints}
    if not all(name in kinds for name in names):
        return [(list(range(len(names))), joint_units(()))]
    prismatic = [kinds[name] == "prismatic" for name in names]
    rows = ([index for index, is_one in enumerate(prismatic) if is_one == kind] for kind in (False, True))
    return [(found, joint_units(kinds[names[index]] for index in found)) for found in rows if found]


def _many(
    time: Floats, label: str, columns: Floats, names: list[str], groups: list[tuple[list[int], str, str]]
) -> Figure:
    """Draw one panel per group (columns, quantity, unit), with one line per joint."""
    figure = new_figure(COLUMN, 2.2)
    panels = figure.subplots(len(groups), 1, sharex=True, squeeze=False)[:, 0]
    height = 0.2
    for axes, (rows, what, unit) in zip(panels, groups, strict=True):
        shown, scaled = _plot_joints(axes, time, columns[:, rows], [names[row] for row in rows], unit)
        tidy(axes, label if axes is panels[-1] else "", f"{what} [{scaled}]")
        legend_above(axes)
        height += 1.8 + legend_height(shown)
    figure.align_ylabels(list(panels))
    figure.set_figheight(height)
    return figure


def _plot_joints(
    axes: Axes, time: Floats, columns: Floats, names: list[str], unit: str
) -> tuple[list[str], str]:
    """Draw lines on an axis symmetric about zero; return the legend entries and the unit with its prefix."""
    peak = max(float(np.abs(columns).max()), ROUNDING)
    factor, scaled = with_prefix(peak, unit) if peak < 0.1 or peak >= 1e3 else (1.0, unit)
    if OR in unit:
        factor, scaled = 1.0, unit
    shown = plot_largest(axes, time, factor * columns, names)
    axes.set_ylim(-1.08 * factor * peak, 1.08 * factor * peak)
    axes.axhline(0.0, color=INK, linewidth=0.5, zorder=0)
    return shown, scaled


def _plot_errors(panels: Sequence[Axes], time: Floats, errors: Sequence[Floats]) -> None:
    """Draw position and attitude errors (T, 3) in separate panels."""
    for axes, error, name in zip(panels, errors, ("position_error", "attitude_error"), strict=True):
        _plot_error(axes, time, np.asarray(error), COLUMNS[name].unit, name.replace("_", " "))


def _plot_error(axes: Axes, time: Floats, error: Floats, unit: str, what: str) -> None:
    norm = np.linalg.norm(error, axis=1)
    factor, scaled_unit = with_prefix(float(norm.max()), unit)
    plot_lines(axes, time, factor * error, ("x", "y", "z"), XYZ_COLORS)
    plot_lines(axes, time, factor * norm[:, None], ("norm",), (INK,))
    axes.lines[-1].set(linestyle=(0, (3, 1.5)), linewidth=0.8 * LINE)
    hide_rounding(axes, ROUNDING * factor)
    tidy(axes, "", f"{what} [{scaled_unit}]")
    legend_above(axes)
