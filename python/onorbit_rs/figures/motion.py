"""Figures of the motion of the free base: its position and attitude, and its reaction to the arm."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
from matplotlib.figure import Figure

from onorbit_rs._core import COLUMNS
from onorbit_rs.common.coordinates import ANGULAR, POSITION, QUATERNION
from onorbit_rs.common.display_units import ROUNDING, ROUNDING_DEG, degrees_with_prefix, with_prefix
from onorbit_rs.common.rotations import angle_between, roll_pitch_yaw
from onorbit_rs.figures.style import (
    COLUMN,
    INK,
    XYZ_COLORS,
    clock,
    hide_rounding,
    legend_above,
    new_figure,
    plot_angles,
    plot_lines,
    tidy,
)

if TYPE_CHECKING:
    from onorbit_rs._core import Trace

STEEPEST_DEG = 80.0
"""Pitch, degrees, above which roll and yaw are nearly degenerate."""


HALF_TURN_DEG = 180.0
"""Angle, degrees, beyond which angles are drawn between -180° and 180°."""


def base_motion(trace: Trace) -> Figure:
    """Draw the position and attitude of the base in W.

    The attitude is drawn as roll, pitch and yaw, between -180° and 180°, or as a quaternion if the pitch
    reaches 80° at any time.
    """
    time, label = clock(trace)
    position = np.asarray(trace.q)[:, POSITION]
    quat = np.asarray(trace.q)[:, QUATERNION]
    angles = np.degrees(np.unwrap(roll_pitch_yaw(quat), axis=0))
    figure = new_figure(COLUMN, 3.3)
    panels = figure.subplots(2, 1, sharex=True)
    factor, unit = with_prefix(float(np.abs(position).max()), COLUMNS["q"].parts["position"][1])
    plot_lines(panels[0], time, factor * position, ("x", "y", "z"), XYZ_COLORS)
    hide_rounding(panels[0], ROUNDING * max(factor, 1.0))
    tidy(panels[0], "", f"position [{unit}]")
    is_steep, turns = np.abs(angles[:, 1]).max() >= STEEPEST_DEG, np.abs(angles).max() > HALF_TURN_DEG
    if turns and not is_steep:
        plot_angles(panels[1], time, angles, ("roll", "pitch", "yaw"), XYZ_COLORS)
        tidy(panels[1], label, "attitude [deg]")
    elif not is_steep:
        factor, unit = degrees_with_prefix(float(np.abs(angles).max()))
        plot_lines(panels[1], time, factor * angles, ("roll", "pitch", "yaw"), XYZ_COLORS)
        hide_rounding(panels[1], ROUNDING_DEG * factor)
        tidy(panels[1], label, f"attitude [{unit}]")
    else:
        plot_lines(panels[1], time, quat, ("x", "y", "z", "w"), (*XYZ_COLORS, INK))
        tidy(panels[1], label, "quaternion [1]")
    for axes in panels:
        legend_above(axes)
    return figure


def base_reaction(trace: Trace) -> Figure:
    """Draw the angle of rotation of the base since the start, and its angular velocity in base axes."""
    time, label = clock(trace)
    quat = np.asarray(trace.q)[:, QUATERNION]
    turned = np.degrees(angle_between(quat, quat[0]))[:, None]
    rate = np.degrees(np.asarray(trace.v)[:, ANGULAR])
    figure = new_figure(COLUMN, 3.1)
    panels = figure.subplots(2, 1, sharex=True)
    factor, unit = degrees_with_prefix(float(turned.max()))
    plot_lines(panels[0], time, factor * turned, ("turned",), (INK,))
    hide_rounding(panels[0], ROUNDING_DEG * factor)
    tidy(panels[0], "", f"rotation [{unit}]")
    factor, unit = degrees_with_prefix(float(np.abs(rate).max()), "deg/s")
    plot_lines(panels[1], time, factor * rate, ("x", "y", "z"), XYZ_COLORS)
    hide_rounding(panels[1], ROUNDING_DEG * factor)
    tidy(panels[1], label, f"angular rate [{unit}]")
    legend_above(panels[1])
    return figure
