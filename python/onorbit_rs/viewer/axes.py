"""Coordinate axes: x red, y green, z blue, with names at their tips."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
import rerun as rr

from onorbit_rs.viewer.font import shown
from onorbit_rs.viewer.frames import BESIDE, COMPASS, DESIRED, FOLLOW, fix_frame, put_in

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from onorbit_rs.viewer.setting import Setting

    Floats = NDArray[np.float64]

_COLORS = np.array([(235, 80, 70), (80, 200, 100), (90, 145, 250)])
_NAME = (235, 235, 235)


def log_axes(
    recording: rr.RecordingStream,
    path: str,
    frame: str,
    length: float,
    names: tuple[str, ...] = (),
    *,
    origin: Floats | None = None,
    brightness: float = 1.0,
    thickness: float = 1.0,
) -> None:
    """Log static axes of a frame with a length, m, and with ``names`` at their tips.

    ``origin``, (3,), m, is the position of the axes in the frame; default: the origin of the frame.
    """
    colors = (_COLORS * brightness).astype(np.uint8)
    start = np.zeros(3) if origin is None else origin
    put_in(recording, path, frame)
    arrows = rr.Arrows3D(
        vectors=np.eye(3) * length,
        origins=np.tile(start, (3, 1)),
        colors=colors,
        radii=[thickness * length / 70.0],
    )
    recording.log(path, arrows, static=True, strict=True)
    if names:
        put_in(recording, f"{path}/names", frame)
        labels = rr.Points3D(
            start + 1.1 * length * np.eye(3),
            colors=colors,
            radii=[0.0],
            labels=[shown(name) for name in names],
            show_labels=True,
        )
        recording.log(f"{path}/names", labels, static=True, strict=True)


def log_name(recording: rr.RecordingStream, path: str, frame: str, name: str, place: Floats) -> None:
    """Log a static name at ``place``, (3,), m, in a frame."""
    put_in(recording, path, frame)
    label = rr.Points3D([place], colors=[_NAME], radii=[0.0], labels=[shown(name)], show_labels=True)
    recording.log(path, label, static=True, strict=True)


def log_all_axes(
    recording: rr.RecordingStream,
    setting: Setting,
    size: float,
    places: tuple[Floats, Floats],
    *,
    near: float,
    tool_name_at: Floats | None,
    in_orbit: bool,
    has_reference: bool,
) -> None:
    """Log the axes of the tool and of its desired pose, and beside the robot those of the base, I and L.

    Parameters
    ----------
    recording : RecordingStream
        Stream to the recording.
    setting : Setting
        Robot, orbit and targets.
    size : float
        Size of the robot, m.
    places : pair of (3,) arrays, m
        Positions of the axes of I and of L in the frame ``follow``.
    near : float
        Length of the tool's axes in the close-up view of its path, m; 0 omits these axes.
    tool_name_at : (3,) array, m, optional
        Position of the tool's name in its axes.
    in_orbit : bool
        Whether L is defined.
    has_reference : bool
        Whether the tool has a desired pose.
    """
    entity, follow, compass = setting.entity, setting.frame(FOLLOW), setting.frame(COMPASS)
    desired = setting.frame(DESIRED)
    log_axes(recording, entity("axes/base"), setting.frame(BESIDE), 0.2 * size, ("x B", "y B", "z B"))
    if setting.tool is not None:
        tool = setting.frame_of(setting.tool)
        log_axes(recording, entity("axes/tool"), tool, 0.1 * size)
        if near > 0.0:
            log_axes(recording, entity("near/tool"), tool, near)
        if tool_name_at is not None:
            log_name(recording, entity("axes/tool/names"), tool, setting.tool, tool_name_at)
    if has_reference:
        log_axes(recording, entity("axes/desired"), desired, 0.1 * size, brightness=0.6)
        if near > 0.0:
            log_axes(recording, entity("near/desired"), desired, near, brightness=0.6)
    log_compass(recording, entity("axes"), (follow, compass), size, places, in_orbit=in_orbit)


def log_compass(
    recording: rr.RecordingStream,
    path: str,
    frames: tuple[str, str],
    size: float,
    places: tuple[Floats, Floats],
    *,
    in_orbit: bool,
) -> None:
    """Log the axes of I and, in an orbit, of L beside a robot.

    ``frames`` are the frame of the camera and the inertial frame; ``places`` are the positions, m, of the
    axes of I and of L in the frame of the camera.
    """
    (follow, compass), (inertial, local) = frames, places
    if in_orbit:
        names = ("x L: out", "y L: along track", "z L: normal")
        log_axes(recording, f"{path}/lvlh", follow, 0.2 * size, names, origin=local)
    else:
        pose = np.eye(4)
        pose[:3, 3] = inertial
        fix_frame(recording, follow, compass, pose)
    log_axes(recording, f"{path}/inertial", compass, 0.2 * size, ("x I", "y I", "z I"))
