"""Named frames, as tf has them: W → L → base in orbit → base → links, each moving in the one before it.

The frame ``follow`` has the axes of L (of W where there is no orbit) and its origin on the base: what is
drawn in it stays sharp in 32 bits however far the robot drifts, and the eye rides in it.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
import pyarrow as pa  # type: ignore[import-untyped]  # ships no types
import rerun as rr

from onorbit_rs.rotations import conjugate, product, quaternion_from_matrix
from onorbit_rs.viewer.letters import shown

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from onorbit_rs._core import Joint
    from onorbit_rs.viewer.rows import Rows
    from onorbit_rs.viewer.setting import Setting

    Floats = NDArray[np.float64]

WORLD, LOCAL, FOLLOW, COMPASS = "W", "L", "follow", "compass"
DESIRED, GOAL = "desired", "goal"
AT_REST = np.array([0.0, 0.0, 0.0, 1.0])
ORIGIN = np.zeros(3)


def of_link(link: str) -> str:
    """Name of the frame of a link or of a frame fixed to one."""
    return f"robot/{shown(link)}"


def send_frame(
    recording: rr.RecordingStream,
    time: rr.TimeColumn,
    parent: str,
    child: str,
    translation: Floats,
    quat_xyzw: Floats,
) -> None:
    """How a frame moves in another: (T, 3) or (3,), m, and (T, 4) or (4,), child to parent."""
    count = len(time.times)
    columns = rr.Transform3D.columns(
        translation=np.broadcast_to(np.asarray(translation, np.float32), (count, 3)),
        quaternion=np.broadcast_to(np.asarray(quat_xyzw, np.float32), (count, 4)),
        parent_frame=pa.repeat(parent, count),  # each row names its frames, or rerun takes the entity's own
        child_frame=pa.repeat(child, count),
    )
    recording.send_columns(path_of(child), [time], columns, strict=True)


def fix_frame(recording: rr.RecordingStream, parent: str, child: str, pose: Floats) -> None:
    """A frame that does not move in another, from a (4, 4) pose, m."""
    fixed = rr.Transform3D(
        translation=pose[:3, 3],
        quaternion=rr.Quaternion(xyzw=quaternion_from_matrix(pose[:3, :3])),
        parent_frame=parent,
        child_frame=child,
    )
    recording.log(path_of(child), fixed, static=True, strict=True)


def path_of(frame: str) -> str:
    """Entity that says where a frame is."""
    return rr.new_entity_path(["frames", *frame.split("/")])


def put_in(recording: rr.RecordingStream, path: str, frame: str) -> None:
    """Everything logged at an entity is in this frame."""
    recording.log(path, rr.CoordinateFrame(frame), static=True, strict=True)


def send_fixed_frames(recording: rr.RecordingStream, setting: Setting) -> None:
    """Links that are one with another link, and the tool."""
    model = setting.model
    moving = set(model.body_names)
    wanted = {shape.link for shape in setting.shapes} | ({setting.tool} if setting.tool else set())
    for frame in model.frames:
        if frame.name in wanted - moving:
            fix_frame(recording, of_link(frame.body), of_link(frame.name), np.array(frame.pose))


def send_moving_frames(recording: rr.RecordingStream, rows: Rows, setting: Setting, compass: Floats) -> None:
    """L, the base and every joint; ``compass`` is where inertial axes are shown in ``follow``, m."""
    q, time = rows["q"], rows.times
    if rows.quat_wl is None or rows.quat_lb is None or rows.rot_wl is None:
        send_frame(recording, time, WORLD, FOLLOW, q[:, :3], AT_REST)
        send_frame(recording, time, FOLLOW, of_link(setting.base), ORIGIN, q[:, 3:7])
    else:
        base_l = np.einsum("tji,tj->ti", rows.rot_wl, q[:, :3])
        send_frame(recording, time, WORLD, LOCAL, ORIGIN, rows.quat_wl)
        send_frame(recording, time, LOCAL, FOLLOW, base_l, AT_REST)
        send_frame(recording, time, FOLLOW, of_link(setting.base), ORIGIN, rows.quat_lb)
        send_frame(recording, time, FOLLOW, COMPASS, compass, conjugate(rows.quat_wl))
    for joint, values in zip(setting.model.joints, q[:, 7:].T, strict=True):
        translation, quat = _across(joint, values)
        send_frame(recording, time, of_link(joint.parent), of_link(joint.child), translation, quat)


def _across(joint: Joint, values: Floats) -> tuple[Floats, Floats]:
    """Where the child's link is in the parent's: translation and quaternion, for each row or one for all."""
    pose, axis = np.array(joint.pose), np.array(joint.axis)
    quat = quaternion_from_matrix(pose[:3, :3])
    if joint.kind == "prismatic":
        return pose[:3, 3] + np.outer(values, pose[:3, :3] @ axis), quat
    # The turn is cos(θ/2) + axis sin(θ/2).
    half = np.stack([np.cos(values / 2.0), np.sin(values / 2.0)], axis=-1)
    return pose[:3, 3], half @ np.stack([quat, product(quat, np.append(axis, 0.0))])
