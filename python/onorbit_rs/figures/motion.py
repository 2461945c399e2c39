"""How the base that nothing holds moves: where it goes, and how it turns as the arm pushes it."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
from matplotlib.figure import Figure

from onorbit_rs.figures.style import (
    COLUMN,
    INK,
    XYZ_COLORS,
    calm,
    clock,
    legend_above,
    new_figure,
    plot_lines,
    tidy,
)
from onorbit_rs.rotations import angle_between, roll_pitch_yaw
from onorbit_rs.units import ROUNDING, ROUNDING_DEG, degrees_with_prefix, with_prefix

if TYPE_CHECKING:
    from onorbit_rs._core import Trace

STEEPEST_DEG = 80.0
"""Pitch from which roll and yaw say little."""


def base_motion(trace: Trace) -> Figure:
    """Position and attitude of the base in W: three angles, or the quaternion where these would jump."""
    time, label = clock(trace)
    position = np.asarray(trace.q)[:, :3]
    quat = np.asarray(trace.q)[:, 3:7]
    angles = np.degrees(np.unwrap(roll_pitch_yaw(quat), axis=0))
    figure = new_figure(COLUMN, 3.3)
    panels = figure.subplots(2, 1, sharex=True)
    factor, unit = with_prefix(float(np.abs(position).max()), "m")
    plot_lines(panels[0], time, factor * position, ("x", "y", "z"), XYZ_COLORS)
    calm(panels[0], ROUNDING * max(factor, 1.0))
    tidy(panels[0], "", f"position [{unit}]")
    if np.abs(angles[:, 1]).max() < STEEPEST_DEG:
        factor, unit = degrees_with_prefix(float(np.abs(angles).max()))
        plot_lines(panels[1], time, factor * angles, ("roll", "pitch", "yaw"), XYZ_COLORS)
        calm(panels[1], ROUNDING_DEG * factor)
        tidy(panels[1], label, f"attitude [{unit}]")
    else:
        plot_lines(panels[1], time, quat, ("x", "y", "z", "w"), (*XYZ_COLORS, INK))
        tidy(panels[1], label, "quaternion [1]")
    for axes in panels:
        legend_above(axes)
    return figure


def base_reaction(trace: Trace) -> Figure:
    """Angle that the base has turned by since the start, and its angular velocity in its own axes."""
    time, label = clock(trace)
    quat = np.asarray(trace.q)[:, 3:7]
    turned = np.degrees(angle_between(quat, quat[0]))[:, None]
    rate = np.degrees(np.asarray(trace.v)[:, 3:6])
    figure = new_figure(COLUMN, 3.1)
    panels = figure.subplots(2, 1, sharex=True)
    factor, unit = degrees_with_prefix(float(turned.max()))
    plot_lines(panels[0], time, factor * turned, ("turned",), (INK,))
    calm(panels[0], ROUNDING_DEG * factor)
    tidy(panels[0], "", f"turned by [{unit}]")
    factor, unit = degrees_with_prefix(float(np.abs(rate).max()), "deg/s")
    plot_lines(panels[1], time, factor * rate, ("x", "y", "z"), XYZ_COLORS)
    calm(panels[1], ROUNDING_DEG * factor)
    tidy(panels[1], label, f"turn rate [{unit}]")
    legend_above(panels[1])
    return figure
