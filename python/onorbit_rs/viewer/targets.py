"""Target spacecraft as they are shown, and the frame in which the path of a tool is best seen."""

from __future__ import annotations

from typing import TYPE_CHECKING, Literal

import numpy as np
import rerun as rr

from onorbit_rs.rotations import product
from onorbit_rs.scenario.targets import task_references
from onorbit_rs.viewer.axes import log_axes
from onorbit_rs.viewer.colors import TARGET
from onorbit_rs.viewer.frames import WORLD, send_frame

if TYPE_CHECKING:
    from onorbit_rs.scenario import Scenario
    from onorbit_rs.viewer.rows import Rows
    from onorbit_rs.viewer.setting import Setting

PathFrame = Literal["world", "lvlh", "base"]


def path_frame(scenario: Scenario) -> PathFrame:
    """That of the first reference of a tool; a moving target's path is drawn in W."""
    frames: tuple[PathFrame, ...] = ("lvlh", "base")
    first = next((reference.frame for reference in task_references(scenario)), None)
    return next((frame for frame in frames if frame == first), "world")


def send_targets(recording: rr.RecordingStream, rows: Rows, setting: Setting) -> None:
    """How they move."""
    t = rows["time"]
    for index, target in enumerate(setting.targets):
        rate = float(np.linalg.norm(target.spin))
        axis = target.spin / rate if rate > 0.0 else np.array([0.0, 0.0, 1.0])
        half = rate * t[:, None] / 2.0
        turned = np.hstack([np.sin(half) * axis, np.cos(half)])
        quat, position = product(turned, target.quat_xyzw), target.position_at(t)
        send_frame(recording, rows.times, WORLD, frame_of_target(index), position, quat)


def log_targets(recording: rr.RecordingStream, setting: Setting, size: float) -> None:
    """Their axes, and their boxes where the scenario tells a size."""
    for index, target in enumerate(setting.targets):
        path = f"world/target/{index}"
        log_axes(recording, path, frame_of_target(index), 0.25 * size, ("x T", "y T", "z T"))
        if target.size:
            box = rr.Boxes3D(sizes=[target.size], colors=[TARGET], fill_mode=rr.components.FillMode.Solid)
            recording.log(path, box, static=True, strict=True)


def frame_of_target(index: int) -> str:
    """Name of its frame."""
    return f"target/{index}"
