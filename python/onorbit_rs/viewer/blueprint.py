"""How the viewer is laid out: the robot large, orbit and notes below it, the plots beside."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

import numpy as np
import rerun.blueprint as rrb

from onorbit_rs.geometry import Shape, shapes
from onorbit_rs.viewer.series import Series

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from onorbit_rs._core import Model, Trace

    Floats = NDArray[np.float64]

TIMELINE = "simulation_time"
PLAYS_IN_S = 40.0
"""Longest wall-clock time a recording takes to play; shorter runs play in real time."""

_FIRST = (
    "plots/joint_torque",
    "plots/tool_position_error",
    "plots/tool_attitude_error",
    "plots/base_attitude",
)
_FIRST_ADRIFT = (
    "plots/base_attitude_lvlh",
    "plots/base_attitude",
    "plots/joint_position",
    "plots/angular_momentum",
    "plots/energy",
)
_BACKGROUND = (28, 31, 38)
_UNTIL_NOW = rrb.VisibleTimeRange(
    TIMELINE, start=rrb.TimeRangeBoundary.infinite(), end=rrb.TimeRangeBoundary.cursor_relative()
)


def layout(trace: Trace, model: Model, plots: Sequence[Series], *, has_notes: bool) -> rrb.Blueprint:
    """The views of one run."""
    center, size = _extent(trace, model)
    seen_from = center + 1.2 * size * np.array([0.44, -0.84, 0.32])
    eye = rrb.EyeControls3D(position=seen_from, look_target=center, eye_up=(0.0, 0.0, 1.0))
    robot = rrb.Spatial3DView(
        origin="world",
        name="Robot in W (inertial axes, m)",
        eye_controls=eye,
        background=_BACKGROUND,
        line_grid=False,
        overrides={"world/tool/obtained/trail": rrb.VisibleTimeRanges([_UNTIL_NOW])},
    )
    below: list[rrb.View] = []
    if "position_eci" in trace.columns():
        below.append(
            rrb.Spatial3DView(
                origin="orbit", name="Orbit (inertial axes, km)", background=_BACKGROUND, line_grid=False
            )
        )
    if has_notes:
        below.append(rrb.TextDocumentView(origin="notes", name="Notes"))
    left = rrb.Vertical(robot, rrb.Horizontal(*below), row_shares=[3, 1]) if below else robot
    wanted = _FIRST if "position_error" in trace.columns() else _FIRST_ADRIFT
    by_path = {plot.path: plot for plot in plots}
    chosen = [by_path[path] for path in wanted if path in by_path][:4]
    others = [plot for plot in plots if plot not in chosen]
    whole = _duration(trace)
    right = rrb.Vertical(
        *(_plot(plot, whole) for plot in chosen), rrb.Tabs(*(_plot(plot, whole) for plot in others))
    )
    return rrb.Blueprint(
        rrb.Horizontal(left, right, column_shares=[3, 2]),
        rrb.TimePanel(
            state="collapsed",
            timeline=TIMELINE,
            play_state="playing",
            loop_mode="all",
            playback_speed=max(1.0, whole / PLAYS_IN_S),
        ),
        rrb.BlueprintPanel(state="collapsed"),
        rrb.SelectionPanel(state="collapsed"),
        auto_views=False,
    )


def _plot(series: Series, duration_s: float) -> rrb.TimeSeriesView:
    """A plot that shows the whole run from the start."""
    whole = rrb.TimeRange(
        start=rrb.TimeRangeBoundary.absolute(seconds=0.0),
        end=rrb.TimeRangeBoundary.absolute(seconds=duration_s),
    )
    return rrb.TimeSeriesView(
        origin=series.path,
        name=f"{series.title} [{series.unit}]",
        axis_x=rrb.TimeAxis(view_range=whole),
        plot_legend=rrb.PlotLegend(rrb.Corner2D.RightTop),
    )


def _duration(trace: Trace) -> float:
    return float(trace.time[-1])


def _extent(trace: Trace, model: Model) -> tuple[Floats, float]:
    """Where the robot is at the start, and how far the eye should be: m."""
    q = np.asarray(trace.q)[0]
    corners = np.vstack([_corners(model, q, shape) for shape in shapes(model)])
    low, high = corners.min(axis=0), corners.max(axis=0)
    return (low + high) / 2.0, max(float(np.linalg.norm(high - low)), 0.3)


def _corners(model: Model, q: Floats, shape: Shape) -> Floats:
    """(8, 3) corners of a box around a shape, W, m; a mesh counts as a small one."""
    half = {
        "box": np.array(shape.size) / 2.0,
        "sphere": np.full(3, shape.size[0] if shape.size else 0.0),
        "mesh": np.full(3, 0.1),
    }.get(shape.kind)
    if half is None:
        radius, length = shape.size
        half = np.array([radius, radius, length / 2.0 + (radius if shape.kind == "capsule" else 0.0)])
    signs = np.array([[x, y, z] for x in (-1, 1) for y in (-1, 1) for z in (-1, 1)])
    pose = np.asarray(model.frame_pose(q, shape.link)).reshape(4, 4) @ shape.pose
    corners: Floats = signs * half @ pose[:3, :3].T + pose[:3, 3]
    return corners
