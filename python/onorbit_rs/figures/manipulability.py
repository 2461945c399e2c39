"""Figure of the manipulability of the tool along its path, with a free and with a fixed base."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
from matplotlib.figure import Figure

from onorbit_rs.common import manipulability as yoshikawa
from onorbit_rs.common.coordinates import JOINTS_V
from onorbit_rs.common.decimate import evenly_spaced
from onorbit_rs.figures.style import (
    COLORS,
    COLUMN,
    clock,
    legend_above,
    new_figure,
    plot_lines,
    tidy,
)

if TYPE_CHECKING:
    from collections.abc import Sequence

    from onorbit_rs._core import Model, Trace

_MOST_ROWS = 2_000


def manipulability(trace: Trace, model: Model, tool: str, joints: Sequence[str] | None = None) -> Figure:
    """Draw Yoshikawa's measure `w = √det(J Jᵀ)` with the base free and fixed.

    For a free base, `J` is the generalized Jacobian `Jg` of the tool; for a fixed base, it is the tool's
    Jacobian with respect to the joints.

    The upper panel, drawn for six joints or more, is for linear and angular velocity together, the lower
    panel for linear velocity; both in m³ if all joints are revolute. At zero the tool cannot move in some
    direction.

    Source: Yoshikawa, Int. J. Robotics Research 4(2), 1985; with `Jg` Umetani and Yoshida, 1989.

    Parameters
    ----------
    trace : Trace
        Trace of the run.
    model : Model
        Robot.
    tool : str
        Name of the tool frame.
    joints : sequence of str, optional
        Joints that move the tool; default: all.
    """
    columns = [list(model.joint_names).index(name) for name in joints or model.joint_names]
    time, label = clock(trace)
    rows = evenly_spaced(len(time), _MOST_ROWS)
    q, v = np.ascontiguousarray(trace.q[rows]), np.ascontiguousarray(trace.v[rows])
    free = np.asarray(model.free_floating(q, v, tool).jacobian)[:, :, columns]
    held = np.asarray(model.frame_jacobian(q, tool))[:, :, JOINTS_V][:, :, columns]
    has_prismatic = any(model.joints[index].kind == "prismatic" for index in columns)
    unit = "SI" if has_prismatic else "m³"
    parts = [("w, pose", slice(0, 6))] if len(columns) >= 6 else []
    parts.append(("w, position", slice(0, 3)))
    figure = new_figure(COLUMN, 0.5 + 1.4 * len(parts))
    panels = figure.subplots(len(parts), 1, sharex=True, squeeze=False)[:, 0]
    for axes, (what, part) in zip(panels, parts, strict=True):
        measures = np.column_stack([yoshikawa.manipulability(jacobian[:, part]) for jacobian in (free, held)])
        plot_lines(axes, time[rows], measures, ("base free", "base held"), COLORS)
        axes.lines[1].set_linestyle((0, (3, 1.5)))
        axes.set_ylim(0.0, 1.08 * float(max(measures.max(), 1e-12)))
        tidy(axes, label if axes is panels[-1] else "", f"{what} [{unit}]")
    legend_above(panels[0])
    return figure
