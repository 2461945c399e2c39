"""Tree of named frames as in ROS tf: W → L → follow → base → links; each is relative to the previous frame.

The frame ``follow`` has the axes of L (of W without an orbit) and its origin at the base. The camera is fixed
in this frame, in which 32-bit coordinates stay precise however far the robot drifts.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
import pyarrow as pa
import rerun as rr

from onorbit_rs.common.coordinates import JOINTS_Q, POSITION, QUATERNION
from onorbit_rs.common.rotations import conjugate, matrix_from_quaternion, product, quaternion_from_matrix

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from onorbit_rs._core import Joint
    from onorbit_rs.viewer.setting import Setting
    from onorbit_rs.viewer.trace_rows import TraceRows

    Floats = NDArray[np.float64]

WORLD, LOCAL, FOLLOW, COMPASS, BESIDE = "W", "L", "follow", "compass", "base_axes"
DESIRED, GOAL = "desired", "goal"
AT_REST = np.array([0.0, 0.0, 0.0, 1.0])
ORIGIN = np.zeros(3)


def send_frame(
    recording: rr.RecordingStream,
    time: rr.TimeColumn,
    parent: str,
    child: str,
    translation: Floats,
    quat_xyzw: Floats,
) -> None:
    """Send translation, (T, 3) or (3,), m, and quaternion, (T, 4) or (4,), of a child frame in its parent."""
    count = len(time.times)
    columns = rr.Transform3D.columns(
        translation=np.broadcast_to(np.asarray(translation, np.float32), (count, 3)),
        quaternion=np.broadcast_to(np.asarray(quat_xyzw, np.float32), (count, 4)),
        parent_frame=pa.repeat(parent, count),  # each row must name its frames
        child_frame=pa.repeat(child, count),
    )
    recording.send_columns(path_of(child), [time], columns, strict=True)


def fix_frame(recording: rr.RecordingStream, parent: str, child: str, pose: Floats) -> None:
    """Log a frame with a constant pose in its parent; ``pose`` is a (4, 4) homogeneous matrix, m."""
    fixed = rr.Transform3D(
        translation=pose[:3, 3],
        quaternion=rr.Quaternion(xyzw=quaternion_from_matrix(pose[:3, :3])),
        parent_frame=parent,
        child_frame=child,
    )
    recording.log(path_of(child), fixed, static=True, strict=True)


def path_of(frame: str) -> str:
    """Return the path of the entity that contains the transform of a frame."""
    return rr.new_entity_path(["frames", *frame.split("/")])


def put_in(recording: rr.RecordingStream, path: str, frame: str) -> None:
    """Set the coordinate frame of an entity."""
    recording.log(path, rr.CoordinateFrame(frame), static=True, strict=True)


def send_fixed_frames(recording: rr.RecordingStream, setting: Setting) -> None:
    """Log the frames of drawn links that are fixed to another link, of the tool, and of captures."""
    model = setting.model
    moving = set(model.body_names)
    wanted = {shape.link for shape in (*setting.shapes, *setting.collisions)} | {
        setting.tool,
        *setting.grasps,
    }
    for frame in model.frames:
        if frame.name in wanted - moving:
            fix_frame(
                recording, setting.frame_of(frame.body), setting.frame_of(frame.name), np.array(frame.pose)
            )


def send_local_frame(recording: rr.RecordingStream, rows: TraceRows) -> None:
    """Send the motion of frame L in W, if L is defined."""
    if rows.quat_wl is not None:
        send_frame(recording, rows.times, WORLD, LOCAL, ORIGIN, rows.quat_wl)


def send_moving_frames(
    recording: rr.RecordingStream, rows: TraceRows, setting: Setting, compass: Floats, beside: Floats
) -> None:
    """Send the motion of the base and the joints.

    The inertial axes are shown at ``compass`` and the axes of the base at ``beside``, both (3,), m, in the
    frame ``follow``.
    """
    q, time, base = rows["q"], rows.times, setting.frame_of(setting.base)
    quat_fb = q[:, QUATERNION] if rows.quat_lb is None else rows.quat_lb
    send_follow(recording, rows, setting.frame(FOLLOW), setting.frame(COMPASS), q[:, POSITION], compass)
    send_frame(recording, time, setting.frame(FOLLOW), base, ORIGIN, quat_fb)
    send_frame(recording, time, setting.frame(FOLLOW), setting.frame(BESIDE), beside, quat_fb)
    for joint, values in zip(setting.model.joints, q[:, JOINTS_Q].T, strict=True):
        translation, quat = _joint_transform(joint, values)
        parent, child = setting.frame_of(joint.parent), setting.frame_of(joint.child)
        send_frame(recording, time, parent, child, translation, quat)


def send_follow(
    recording: rr.RecordingStream, rows: TraceRows, follow: str, axes: str, place: Floats, axes_at: Floats
) -> None:
    """Send the frame of a camera at ``place``, (T, 3) in W, with the axes of L, or of W if L is undefined.

    The frame ``axes`` has the axes of W and its origin at ``axes_at``, (3,), m, in the camera's frame.
    """
    if rows.quat_wl is None or rows.rot_wl is None:
        send_frame(recording, rows.times, WORLD, follow, place, AT_REST)
        return
    place_l = np.einsum("tji,tj->ti", rows.rot_wl, place)
    send_frame(recording, rows.times, LOCAL, follow, place_l, AT_REST)
    send_frame(recording, rows.times, follow, axes, axes_at, conjugate(rows.quat_wl))


def _joint_transform(joint: Joint, values: Floats) -> tuple[Floats, Floats]:
    """Return translation, m, and quaternion, xyzw, of the child in the parent link, per row or constant."""
    pose, axis = np.array(joint.pose), np.array(joint.axis)
    quat = quaternion_from_matrix(pose[:3, :3])
    if joint.kind == "prismatic":
        return pose[:3, 3] + np.outer(values, pose[:3, :3] @ axis), quat
    # the rotation is cos(θ/2) + axis sin(θ/2)
    half = np.stack([np.cos(values / 2.0), np.sin(values / 2.0)], axis=-1)
    turned = half @ np.stack([quat, product(quat, np.append(axis, 0.0))])
    anchor = np.array(joint.anchor)
    if not anchor.any():
        return pose[:3, 3], turned
    # the anchor, which lies on the axis, does not move
    return pose[:3, 3] + pose[:3, :3] @ anchor - matrix_from_quaternion(turned) @ anchor, turned
