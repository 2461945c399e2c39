"""Target spacecraft in the 3-D view."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
import rerun as rr

from onorbit_rs.common.rotations import product
from onorbit_rs.viewer.axes import log_axes
from onorbit_rs.viewer.colors import TARGET
from onorbit_rs.viewer.frames import WORLD, send_frame

if TYPE_CHECKING:
    from onorbit_rs.viewer.setting import Setting
    from onorbit_rs.viewer.trace_rows import TraceRows


def send_targets(recording: rr.RecordingStream, rows: TraceRows, setting: Setting) -> None:
    """Send the motion of the targets."""
    t = rows["time"]
    for index, target in enumerate(setting.targets):
        rate = float(np.linalg.norm(target.spin))
        axis = target.spin / rate if rate > 0.0 else np.array([0.0, 0.0, 1.0])
        half = rate * t[:, None] / 2.0
        turned = np.hstack([np.sin(half) * axis, np.cos(half)])
        quat, position = product(turned, target.quat_xyzw), target.position_at(t)
        send_frame(recording, rows.times, WORLD, frame_of_target(setting, index), position, quat)


def log_targets(recording: rr.RecordingStream, setting: Setting, size: float) -> None:
    """Log the axes of the targets, and a box for each target whose size is given."""
    for index, target in enumerate(setting.targets):
        path = setting.entity(f"target/{index}")
        log_axes(recording, path, frame_of_target(setting, index), 0.25 * size, ("x T", "y T", "z T"))
        if target.size:
            box = rr.Boxes3D(sizes=[target.size], colors=[TARGET], fill_mode=rr.components.FillMode.Solid)
            recording.log(path, box, static=True, strict=True)


def frame_of_target(setting: Setting, index: int) -> str:
    """Return the name of the frame of a target."""
    return setting.frame(f"target/{index}")
