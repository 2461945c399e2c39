"""Target spacecraft of a scenario, and the frame in which the path of its tool is best seen."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, Literal

import numpy as np
import rerun as rr

from onorbit_rs.rotations import product
from onorbit_rs.scenario.start import quaternion_of
from onorbit_rs.viewer.axes import log_axes
from onorbit_rs.viewer.colors import TARGET
from onorbit_rs.viewer.frames import WORLD, send_frame

if TYPE_CHECKING:
    from collections.abc import Iterator

    from numpy.typing import NDArray

    from onorbit_rs.scenario import Scenario
    from onorbit_rs.viewer.rows import Rows
    from onorbit_rs.viewer.setting import Setting

    Floats = NDArray[np.float64]

PathFrame = Literal["world", "lvlh", "base"]


@dataclass(frozen=True)
class Target:
    """A spacecraft that nothing acts on: pose at time zero, constant velocity and spin; W axes, m, rad."""

    position: Floats
    quat_xyzw: Floats
    velocity: Floats
    spin: Floats
    size: tuple[float, ...] = ()
    """Edges of its box, m; axes alone are drawn where empty."""


def path_frame(scenario: Scenario) -> PathFrame:
    """That of the first reference of a tool; a moving target's path is drawn in W."""
    frames: tuple[PathFrame, ...] = ("lvlh", "base")
    first = next((reference.frame for reference in _references(scenario)), None)
    return next((frame for frame in frames if frame == first), "world")


def targets(scenario: Scenario) -> tuple[Target, ...]:
    """Every target that a reference follows, once."""
    found: dict[str, Target] = {}
    for reference in _references(scenario):
        motion = getattr(reference.frame, "target", None)
        if motion is not None:
            found[repr(motion)] = Target(
                np.array(motion.position), quaternion_of(motion.attitude),
                np.array(motion.velocity), np.array(motion.spin), tuple(motion.size or ()),
            )  # fmt: skip
    return tuple(found.values())


def _references(scenario: Scenario) -> Iterator[Any]:
    """Those of tools."""
    parts = [scenario.reference, *(control.reference for control in scenario.controllers or [])]
    return (part for part in parts if hasattr(part, "frame"))


def send_targets(recording: rr.RecordingStream, rows: Rows, setting: Setting) -> None:
    """How they move."""
    t = rows["time"]
    for index, target in enumerate(setting.targets):
        rate = float(np.linalg.norm(target.spin))
        axis = target.spin / rate if rate > 0.0 else np.array([0.0, 0.0, 1.0])
        half = rate * t[:, None] / 2.0
        turned = np.hstack([np.sin(half) * axis, np.cos(half)])
        quat, position = product(turned, target.quat_xyzw), position_of(target, t)
        send_frame(recording, rows.times, WORLD, frame_of_target(index), position, quat)


def log_targets(recording: rr.RecordingStream, setting: Setting, size: float) -> None:
    """Their axes, and their boxes where the scenario tells a size."""
    for index, target in enumerate(setting.targets):
        path = f"world/target/{index}"
        log_axes(recording, path, frame_of_target(index), 0.25 * size, ("x T", "y T", "z T"))
        if target.size:
            box = rr.Boxes3D(sizes=[target.size], colors=[TARGET], fill_mode=rr.components.FillMode.Solid)
            recording.log(path, box, static=True, strict=True)


def position_of(target: Target, t: Floats) -> Floats:
    """(T, 3), W, m."""
    place: Floats = target.position + np.outer(t, target.velocity)
    return place


def frame_of_target(index: int) -> str:
    """Name of its frame."""
    return f"target/{index}"
