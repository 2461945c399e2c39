"""Results of the latches of a run: closed or not met, the nearest pose, and how the systems separated."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from onorbit_rs.common.blocks import ROWS, blocks
from onorbit_rs.common.coordinates import BASE_NV
from onorbit_rs.common.printable import json_value

if TYPE_CHECKING:
    from onorbit_rs._core import WorldTrace
    from onorbit_rs.output.summary import Summary
    from onorbit_rs.scenario.build_world import BuiltWorld


def latch_results(trace: WorldTrace, built: BuiltWorld) -> list[Summary]:
    """Return an entry for each latch, in the order of the events.

    ``time_s`` is the time of the capture, or None if the latch was not met. ``nearest_m`` and ``nearest_rad``
    are the distance and the angle between the frames at ``nearest_s``, when their distance in the rows up to
    the capture was smallest. ``parted_s`` is the last time before the capture at which all contacts between
    both systems had ended, or None; ``parted_speed_m_s`` is the speed of the centre of mass of the captured
    system relative to that of the other system in the first row after that time, and ``parted_spin_rad_s``
    the angular rate of its base in W.
    """
    found: list[Summary] = []
    for event in built.scenario.events:
        if event.when.latch is None or event.do.capture is None:
            continue
        times = [record.time for record in trace.events if record.name == event.name]
        end = times[0] if times else np.inf
        frames = [path.split("/", 1) for path in event.do.capture]
        names = [system for system, _ in frames]
        values = {"time_s": times[0] if times else None} | _nearest(trace, built, frames, end)
        values |= _parting(trace, built, names, end)
        entry: Summary = {"name": event.name, "systems": names}
        found.append(entry | {key: json_value(value) for key, value in values.items()})
    return found


def _nearest(trace: WorldTrace, built: BuiltWorld, frames: list[list[str]], end: float) -> dict[str, Any]:
    """Return the smallest distance of two frames up to the time ``end``, s, and its angle and time."""
    count = int(np.searchsorted(trace.time, end, side="right"))
    configurations = [trace[system].q[:count] for system, _ in frames]
    models = [built.systems[system].model for system, _ in frames]
    found = []
    for start, rows in enumerate(blocks(*configurations)):
        poses = [model.frame_pose(q, frame)
                 for model, q, (_, frame) in zip(models, rows, frames, strict=True)]  # fmt: skip
        distances = np.linalg.norm(poses[1][:, :3, 3] - poses[0][:, :3, 3], axis=1)
        row = int(np.argmin(distances))
        turn = poses[0][row, :3, :3].T @ poses[1][row, :3, :3]
        found.append((distances[row], ROWS * start + row, turn))
    distance, row, turn = min(found, key=lambda nearest: nearest[:2])
    # 2 sin θ and 2 cos θ of the angle θ of the rotation
    sine = np.linalg.norm([turn[2, 1] - turn[1, 2], turn[0, 2] - turn[2, 0], turn[1, 0] - turn[0, 1]])
    angle = np.arctan2(sine, np.trace(turn) - 1.0)
    return {"nearest_m": distance, "nearest_rad": angle, "nearest_s": trace.time[row]}


def _parting(trace: WorldTrace, built: BuiltWorld, names: list[str], end: float) -> dict[str, Any]:
    """Return the last time before ``end``, s, at which two systems ceased to touch, and their speed then.

    The speed, m/s, is that of the centre of mass of the second system relative to that of the first; the
    spin, rad/s, is that of the second system's base.
    """
    touching: set[str] = set()
    parted = None
    for record in trace.events:
        if record.time >= end or set(record.systems) != set(names):
            continue
        if record.kind == "touch_down":
            touching.add(record.name)
        elif record.kind == "lift_off":
            touching.discard(record.name)
            parted = parted if touching else record.time
    speed = spin = None
    if parted is not None:
        row = min(int(np.searchsorted(trace.time, parted, side="right")), len(trace.time) - 1)
        first, second = (
            np.asarray(trace[name].momentum[row])[:3] / built.systems[name].model.mass for name in names
        )
        speed = np.linalg.norm(second - first)
        spin = np.linalg.norm(np.asarray(trace[names[1]].v[row])[3:BASE_NV])
    return {"parted_s": parted, "parted_speed_m_s": speed, "parted_spin_rad_s": spin}
