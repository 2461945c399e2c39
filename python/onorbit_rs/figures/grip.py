"""Figure of the force with which a gripper holds an object."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
from matplotlib.figure import Figure

from onorbit_rs.figures.style import COLUMN, INK, LINE, XYZ_COLORS, clock, legend_above, new_figure, tidy

if TYPE_CHECKING:
    from onorbit_rs._core import Trace


def grip_force(trace: Trace, name: str, force: float) -> Figure:
    """Draw the mean normal force of the fingers of a control while it is active, and the desired force.

    Parameters
    ----------
    trace : Trace
        Trace of the run.
    name : str
        Name of the control.
    force : float
        Desired force, N.
    """
    time, label = clock(trace)
    error = np.asarray(trace.tracking[name])[:, 0]
    # the error is exactly zero while the control is not active
    active = error != 0.0
    figure = new_figure(COLUMN, 2.2)
    axes = figure.subplots()
    axes.plot(time[active], force - error[active], color=XYZ_COLORS[0], linewidth=LINE, label="grip force")
    axes.plot(
        time[active][[0, -1]], [force, force], color=INK, linewidth=LINE, linestyle=":", label="desired"
    )
    tidy(axes, label, "force [N]")
    legend_above(axes)
    return figure
