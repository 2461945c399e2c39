"""Layout of the viewer: the robot with orbit and notes below it, and plots in groups beside it."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING, Any

import numpy as np
import rerun.blueprint as rrb

from onorbit_rs.viewer.colors import BACKGROUND
from onorbit_rs.viewer.flight import flight_bodies, flight_view, is_apart
from onorbit_rs.viewer.frames import FOLLOW
from onorbit_rs.viewer.planet import INERTIAL, shows_sun, to_eye
from onorbit_rs.viewer.plots import plots_in_groups
from onorbit_rs.viewer.scene import COLORS, MOVES, UNTIL_NOW, collisions_of, on_path, trail_of
from onorbit_rs.viewer.trace_rows import TIMELINE

if TYPE_CHECKING:
    from onorbit_rs.viewer.series import Series
    from onorbit_rs.viewer.setting import Setting
    from onorbit_rs.viewer.trace_rows import TraceRows
    from onorbit_rs.viewer.viewpoint import Viewpoint

PLAYS_IN_S = 40.0
"""Longest wall-clock time, s, that playing a recording takes; shorter runs play in real time."""

_SPACE = (12, 14, 20)

_LARGE = ("arrows", "loops", "axes", "flight")
_SOLID, _HIDDEN = ("robot", "target"), 0.02
"""Entities that would hide a short path, and the path length, in sizes of the robot, below which they do."""


def layout(
    rows: TraceRows,
    setting: Setting,
    viewpoint: Viewpoint,
    plots: Sequence[Series],
    duration_s: float,
    *,
    has_notes: bool,
    is_live: bool = False,
) -> rrb.Blueprint:
    """Return the layout of the viewer for a run with one robot."""
    name = f"{setting.label}: camera follows the base, axes of {axes_of_camera(rows)}"
    contents = ["$origin/**", "- $origin/flight/**", "- $origin/near/**"]
    robot = scene_view(name, contents, FOLLOW, viewpoint, [setting])
    below: list[rrb.View] = []
    if "position_eci" in rows:
        below.append(orbit_view(rows, [setting]))
    if is_apart(bodies := flight_bodies(rows, setting), viewpoint.size):
        below.append(flight_view(bodies))
    if has_notes:
        below.append(rrb.TextDocumentView(origin="notes", name="Notes"))
    close_up = near_path(rows, setting, viewpoint) if "reference_pose" in rows and not is_live else None
    top = robot if close_up is None else rrb.Tabs(robot, close_up, active_tab=0)
    left = rrb.Vertical(top, rrb.Horizontal(*below), row_shares=[5, 3]) if below else top
    return with_panels(left, plots_in_groups(plots, duration_s, is_live=is_live), duration_s, is_live=is_live)


def axes_of_camera(rows: TraceRows) -> str:
    """Return the name of the axes in which the camera is fixed."""
    return "W (inertial axes)" if rows.quat_wl is None else "L (local orbital frame)"


def scene_view(
    name: str,
    contents: list[str],
    frame: str,
    viewpoint: Viewpoint,
    settings: Sequence[Setting],
    *,
    has_collisions: bool = False,
) -> rrb.View:
    """Return a 3-D view from a camera that is fixed in a frame; collision shapes are hidden by default."""
    return rrb.Spatial3DView(
        origin="world",
        contents=contents,
        name=name,
        spatial_information=rrb.SpatialInformation(frame, show_axes=False),
        eye_controls=viewpoint.eye(),
        background=BACKGROUND,
        line_grid=False,
        overrides=_overrides(settings, has_collisions=has_collisions),
    )


def _overrides(settings: Sequence[Setting], *, has_collisions: bool = False) -> dict[Any, Any]:
    """Return the overrides of a 3-D view, which end trails at the current time and hide collision shapes.

    With ``has_collisions``, the collision shapes are visible.
    """
    found: dict[Any, Any] = {trail_of(setting, name): UNTIL_NOW for setting in settings for name in COLORS}
    hidden = [] if has_collisions else [setting for setting in settings if setting.collisions]
    return found | {collisions_of(setting): rrb.EntityBehavior(visible=False) for setting in hidden}


def with_panels(
    left: rrb.Container | rrb.View, right: rrb.Container, duration_s: float, *, is_live: bool
) -> rrb.Blueprint:
    """Return a layout of two columns.

    Its time panel plays the run in simulation time or, if ``is_live``, follows the newest data.
    """
    return rrb.Blueprint(
        rrb.Horizontal(left, right, column_shares=[3, 2]),
        rrb.TimePanel(
            state="collapsed",
            timeline=TIMELINE,
            play_state="following" if is_live else "playing",
            loop_mode="off" if is_live else "all",
            playback_speed=playback_speed(duration_s),
        ),
        rrb.BlueprintPanel(state="collapsed"),
        rrb.SelectionPanel(state="collapsed"),
        auto_views=False,
    )


def playback_speed(duration_s: float) -> float:
    """Return the ratio of simulated time to wall-clock time with which a run is played."""
    return max(1.0, duration_s / PLAYS_IN_S)


def near_path(rows: TraceRows, setting: Setting, viewpoint: Viewpoint) -> rrb.View | None:
    """Return a close-up view of the tool's path; None if the path is very short."""
    points, frame = on_path(rows, rows["reference_pose"][:, :3, 3], setting)
    low, high = points.min(axis=0), points.max(axis=0)
    length = float(np.linalg.norm(high - low))
    if length < MOVES * viewpoint.size:
        return None
    center = (low + high) / 2.0
    is_short = length < _HIDDEN * viewpoint.size
    left_out = (*_LARGE, *_SOLID) if is_short else _LARGE
    return rrb.Spatial3DView(
        origin="world",
        contents=["$origin/**", *(f"- /world/{part}/**" for part in left_out)],
        name="Path of the tool, without the robot" if is_short else "Tool and its path",
        spatial_information=rrb.SpatialInformation(frame, show_axes=False),
        eye_controls=rrb.EyeControls3D(
            position=center + 2.2 * length * np.array([0.5, -0.75, 0.45]), look_target=center,
            eye_up=(0.0, 0.0, 1.0),
        ),
        background=BACKGROUND,
        line_grid=False,
        overrides=_overrides([setting]),
    )  # fmt: skip


def orbit_view(rows: TraceRows, settings: Sequence[Setting]) -> rrb.View:
    """Return the view of the orbit, with north up and the whole path in the picture.

    With a planet, the camera is above the side on which the run starts. ``rows`` are the rows of the first
    robot.
    """
    setting = settings[0]
    position = rows["position_eci"] / 1e3
    if setting.orbit is not None and setting.orbit.mu is not None:
        center, reach = np.zeros(3), max(float(np.linalg.norm(position, axis=1).max()), 6400.0)
        towards = to_eye(rows, setting)
    else:
        low, high = position.min(axis=0), position.max(axis=0)
        center, reach = (low + high) / 2.0, max(float(np.linalg.norm(high - low)) / 2.0, 1e-3)
        towards = np.array([0.5, -0.75, 0.45]) / np.linalg.norm([0.5, -0.75, 0.45])
    name = "Orbit (inertial axes, km)"
    if shows_sun(setting):  # in the name, because a label in the view would hide other labels
        name = "Orbit (I, km); yellow arrow to the Sun"
    return rrb.Spatial3DView(
        origin="orbit",
        name=name,
        spatial_information=rrb.SpatialInformation(INERTIAL, show_axes=False),
        eye_controls=rrb.EyeControls3D(
            position=center + 3.1 * reach * towards, look_target=center, eye_up=(0.0, 0.0, 1.0)
        ),
        background=_SPACE,
        line_grid=False,
        overrides={setting.orbit_entity("trail"): UNTIL_NOW for setting in settings},
    )
