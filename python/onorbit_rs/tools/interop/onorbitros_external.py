"""Converts controllers of ROS Control that receive setpoints over a topic to joints that follow commands."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from onorbit_rs.tools.interop.onorbitros_pid import INTERFACES, joint_names
from onorbit_rs.tools.interop.onorbitros_pid import KEYS as PID_KEYS

if TYPE_CHECKING:
    from onorbit_rs.tools.interop.source import Source

_EFFORTS = ("effort_controllers/JointEffortController", "effort_controllers/JointGroupEffortController")
_KEYS = ("type", "joint", "joints")
KP, KD = 100.0, 20.0
"""Gains that replace PID gains, 1/s² and 1/s: critically damped, with a time constant of 0.1 s."""


def forwards_efforts(part: dict[str, Any]) -> bool:
    """Return whether a controller forwards efforts from a topic to the joints."""
    return part.get("type") in _EFFORTS


def read_efforts(source: Source) -> None:
    """Convert a controller that forwards efforts, which requires no gains."""
    source.refuse_unknown(_KEYS)
    joints = joint_names(source)
    source.put(("kind",), "external", "type")
    source.put(("joints",), joints, "joints" if "joints" in source.data else "joint")
    source.note("type", "understood", f"efforts from a topic: send them to {_topic(source)} of onorbit ros2")


def read_driven(source: Source) -> None:
    """Convert a PID controller, whose setpoints a node sends, to computed torque that follows commands."""
    source.refuse_unknown(PID_KEYS)
    joints = joint_names(source)
    interface = INTERFACES[str(source.data["type"]).partition("/")[2]]
    source.put(("kind",), "external", "type")
    source.put(("joints",), joints, "joints" if "joints" in source.data else "joint")
    key = "gains" if "gains" in source.data else "pid"
    if interface == "position":
        source.put(("kp",), KP, key)
    source.put(("kd",), KD, key)
    what = "JointTrajectory messages" if "Trajectory" in str(source.data["type"]) else f"{interface} commands"
    source.note("type", "understood", f"{what}: send them to {_topic(source)} of onorbit ros2")
    kept = f"kp {KP:g} 1/s², kd {KD:g} 1/s" if interface == "position" else f"kd {KD:g} 1/s"
    source.note(key, "corrected", f"PID gains do not apply to computed torque, whose gains are {kept}")
    for extra in PID_KEYS[5:]:
        if extra in source.data:
            source.note(
                extra, "no meaning", "there are no action goals; each row of the trace has a joint state"
            )


def _topic(source: Source) -> str:
    """Return the topic of the commands of a controller."""
    ending = "joint_trajectory" if "Trajectory" in str(source.data["type"]) else "commands"
    return f"/{source.at[-1]}/{ending}"
