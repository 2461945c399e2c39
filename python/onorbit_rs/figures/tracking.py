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
    calm,
    clock,
    legend_above,
    legend_height,
    new_figure,
    plot_largest,
    plot_lines,
    tidy,
)
from onorbit_rs.units import OR, ROUNDING, JointUnits, joint_units, with_prefix

if TYPE_CHECKING:
    from collections.abc import Sequence

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

    ``model`` tells which joints slide: their errors are in m, in a panel of their own.
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
    groups = [(rows, "joint error", units.position) for rows, units in _by_kind(joints, model)]
    return _many(time, label, errors, joints, groups)


def joint_torques(trace: Trace, model: Model) -> Figure:
    """Fig. 7: the torque of every joint over each control step; apart, the force of those that slide."""
    time, label = clock(trace)
    names = list(model.joint_names)
    groups = [
        (rows, "torque" if units.effort == "N m" else "force", units.effort)
        for rows, units in _by_kind(names, model)
    ]
    return _many(time, label, np.asarray(trace.tau), names, groups)


def _by_kind(names: Sequence[str], model: Model | None) -> list[tuple[list[int], JointUnits]]:
    """The joints that turn and those that slide, with their units; all together where that is not known."""
    kinds = {} if model is None else {joint.name: joint.kind for joint in model.joints}
    if not all(name in kinds for name in names):
        return [(list(range(len(names))), joint_units(()))]
    slides = [kinds[name] == "prismatic" for name in names]
    rows = ([index for index, slide in enumerate(slides) if slide == kind] for kind in (False, True))
    return [(found, joint_units(kinds[names[index]] for index in found)) for found in rows if found]


def _many(
    time: Floats, label: str, columns: Floats, names: list[str], groups: list[tuple[list[int], str, str]]
) -> Figure:
    """A panel for each of ``groups`` (columns, what they are, unit): a line for each joint."""
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
    """Symmetric about zero; returns what the legend says, and the unit with its prefix."""
    peak = max(float(np.abs(columns).max()), ROUNDING)
    factor, scaled = with_prefix(peak, unit) if peak < 0.1 or peak >= 1e3 else (1.0, unit)
    if OR in unit:
        factor, scaled = 1.0, unit
    shown = plot_largest(axes, time, factor * columns, names)
    axes.set_ylim(-1.08 * factor * peak, 1.08 * factor * peak)
    axes.axhline(0.0, color=INK, linewidth=0.5, zorder=0)
    return shown, scaled


def _plot_error(axes: Axes, time: Floats, error: Floats, unit: str, what: str) -> None:
    norm = np.linalg.norm(error, axis=1)
    factor, scaled_unit = with_prefix(float(norm.max()), unit)
    plot_lines(axes, time, factor * error, ("x", "y", "z"), XYZ_COLORS)
    plot_lines(axes, time, factor * norm[:, None], ("norm",), (INK,))
    axes.lines[-1].set(linestyle=(0, (3, 1.5)), linewidth=0.8 * LINE)
    calm(axes, ROUNDING * factor)
    tidy(axes, "", f"{what} [{scaled_unit}]")
    legend_above(axes)
