"""Command topics of a run and of its systems, and the conversion of their messages to entries."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import TYPE_CHECKING, Any

import numpy as np

from onorbit_rs.ros2.entries import Entry, RefusedError
from onorbit_rs.ros2.names import ros_names
from onorbit_rs.ros2.transforms import BASE

if TYPE_CHECKING:
    from onorbit_rs.ros2.inbox import Inbox

FLOATS = "std_msgs/msg/Float64MultiArray"
TRAJECTORY = "trajectory_msgs/msg/JointTrajectory"
JOINT_STATE = "sensor_msgs/msg/JointState"
WRENCH = "geometry_msgs/msg/WrenchStamped"


def add_run_topics(inbox: Inbox) -> None:
    """Subscribe to the topics that control the run: pause, reset, step and trigger."""
    inbox.subscribe("/pause", "std_msgs/msg/Bool", lambda content: [{"pause": bool(content.data)}])
    inbox.subscribe("/reset", "std_msgs/msg/Empty", lambda content: [{"reset": True}])
    inbox.subscribe("/step", "std_msgs/msg/Float64", lambda content: [{"step": float(content.data)}])
    inbox.subscribe("/trigger", "std_msgs/msg/String", lambda content: [{"trigger": content.data}])


def add_system_topics(
    inbox: Inbox, system: str, prefix: str, frames: Mapping[str, str], controls: Mapping[str, list[str]]
) -> None:
    """Subscribe to the topics of a system: commands of its external controls, and wrenches on its links.

    ``prefix`` begins the names of the topics. ``frames`` maps each link and frame to its name in ``/tf``,
    beginning with the root link; ``controls`` maps each external control to its joints.
    """
    for control, name in ros_names(controls, "control").items():
        to = {"system": system, "control": control}
        joints = controls[control]
        inbox.subscribe(f"/{prefix}{name}/commands", FLOATS, _values(to, joints))
        inbox.subscribe(f"/{prefix}{name}/joint_trajectory", TRAJECTORY, _trajectory(to, joints))
    if controls:
        inbox.subscribe(f"/{prefix}joint_commands", JOINT_STATE, _joint_commands(system, controls))
    inbox.subscribe(f"/{prefix}wrench_command", WRENCH, _wrench(system, prefix, frames))


def _values(to: Entry, joints: list[str]) -> Callable[[Any], list[Entry]]:
    def convert(content: Any) -> list[Entry]:
        return [to | {"values": _finite("data", content.data, joints)}]

    return convert


def _finite(what: str, values: Any, joints: list[str]) -> list[float]:
    """Return the numbers of a field; raise a RefusedError unless there is one finite number per joint."""
    numbers = np.asarray(values, dtype=np.float64)
    if len(numbers) != len(joints):
        raise RefusedError(
            f"the array '{what}' has length {len(numbers)}; the required length is {len(joints)}, one number "
            f"per joint ({', '.join(joints)})"
        )
    if not np.isfinite(numbers).all():
        bad = int(np.flatnonzero(~np.isfinite(numbers))[0])
        raise RefusedError(
            f"the value of joint {joints[bad]} in '{what}' is {numbers[bad]}; it must be finite"
        )
    found: list[float] = numbers.tolist()
    return found


def _order(names: list[str], joints: list[str]) -> list[int]:
    """Return the index of each joint in a message; raise a RefusedError unless it names each joint once."""
    missing = [joint for joint in joints if joint not in names]
    unknown = [name for name in names if name not in joints]
    twice = [joint for joint in joints if names.count(joint) > 1]
    if missing or unknown or twice:
        faults = (("does not name ", missing, ""), ("names ", unknown, ""), ("names ", twice, " repeatedly"))
        what = " and ".join(f"{verb}{', '.join(some)}{end}" for verb, some, end in faults if some)
        raise RefusedError(
            f"the message {what}; it must name each joint of the control once: {', '.join(joints)}"
        )
    return [names.index(joint) for joint in joints]


def _trajectory(to: Entry, joints: list[str]) -> Callable[[Any], list[Entry]]:
    def convert(content: Any) -> list[Entry]:
        order = _order(list(content.joint_names), joints)
        if not content.points:
            raise RefusedError("the trajectory has no points; it must have at least one")
        found: dict[str, Any] = {"times": [_seconds(point.time_from_start) for point in content.points]}
        for name in ("positions", "velocities", "accelerations"):
            rows = [getattr(point, name) for point in content.points]
            if name == "positions" or any(len(row) for row in rows):
                numbers = [_finite(name, row, list(content.joint_names)) for row in rows]
                found[name] = [[row[i] for i in order] for row in numbers]
        stamp = _seconds(content.header.stamp)
        return [to | {"trajectory": found | ({"start": stamp} if stamp > 0.0 else {})}]

    return convert


def _seconds(time: Any) -> float:
    return float(time.sec) + 1e-9 * float(time.nanosec)


def _joint_commands(system: str, controls: Mapping[str, list[str]]) -> Callable[[Any], list[Entry]]:
    """Return the function that converts a ``JointState`` to one entry per control whose joints it names."""

    def convert(content: Any) -> list[Entry]:
        names, entries = list(content.name), []
        known = {joint for joints in controls.values() for joint in joints}
        if unknown := [name for name in names if name not in known]:
            raise RefusedError(
                f"no external control drives {', '.join(unknown)}; joints of external controls: "
                f"{', '.join(sorted(known))}"
            )
        for control, joints in controls.items():
            own = [name for name in names if name in joints]
            if not own:
                continue
            _order(own, joints)
            places = [names.index(joint) for joint in joints]
            entry: Entry = {"system": system, "control": control}
            for field_name in ("position", "velocity", "effort"):
                values = getattr(content, field_name)
                if len(values):
                    numbers = _finite(field_name, values, names)
                    entry[field_name] = [numbers[i] for i in places]
            if len(entry) == 2:
                raise RefusedError(
                    "the fields 'position', 'velocity' and 'effort' of the message are all empty; fill at "
                    "least one of them, with one value per joint"
                )
            entries.append(entry)
        if not entries:
            raise RefusedError(
                "the field 'name' of the message is empty; list the joints to be commanded in this field"
            )
        return entries

    return convert


def _wrench(system: str, prefix: str, frames: Mapping[str, str]) -> Callable[[Any], list[Entry]]:
    """Return the function that converts a wrench to an entry for a link or frame.

    The link or frame is that of ``frame_id``; an empty one denotes the root link. The torque is about the
    origin of this frame, and both vectors are in its axes.
    """
    bodies = {frame: body for body, frame in frames.items()}
    bodies |= dict.fromkeys(("", BASE), next(iter(frames)))

    def convert(content: Any) -> list[Entry]:
        body = bodies.get(content.header.frame_id.removeprefix(prefix))
        if body is None:
            raise RefusedError(
                f"frame_id {content.header.frame_id!r} is not a frame of the robot; its frames are "
                f"{', '.join(dict.fromkeys((BASE, *frames.values())))}"
            )
        force, torque = ([v.x, v.y, v.z] for v in (content.wrench.force, content.wrench.torque))
        if not np.isfinite(force + torque).all():
            raise RefusedError(f"force is {force} N, torque is {torque} N m; all components must be finite")
        return [{"system": system, "body": body, "force": force, "torque": torque, "frame": "body"}]

    return convert
