"""Target spacecraft in the 3-D view, and the frame in which the path of a tool is drawn."""

from __future__ import annotations

from typing import TYPE_CHECKING, Literal

import numpy as np
import rerun as rr

from onorbit_rs.common.rotations import product
from onorbit_rs.scenario.targets import task_references
from onorbit_rs.viewer.axes import log_axes
from onorbit_rs.viewer.colors import TARGET
from onorbit_rs.viewer.frames import WORLD, send_frame

if TYPE_CHECKING:
    from onorbit_rs.scenario import Scenario
    from onorbit_rs.viewer.setting import Setting
    from onorbit_rs.viewer.trace_rows import TraceRows

PathFrame = Literal["world", "lvlh", "base"]


def path_frame(scenario: Scenario) -> PathFrame:
    """Return the frame of the first reference of a tool if this is L or the base; otherwise W."""
    frames: tuple[PathFrame, ...] = ("lvlh", "base")
    first = next((reference.frame for reference in task_references(scenario)), None)
    return next((frame for frame in frames if frame == first), "world")


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
