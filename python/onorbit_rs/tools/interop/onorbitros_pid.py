"""Converts controllers of ROS Control that command efforts with a PID per joint."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from onorbit_rs.robots.wording import option
from onorbit_rs.scenario.errors import shortened

if TYPE_CHECKING:
    from onorbit_rs.tools.interop.source import Source

INTERFACES = {
    "JointTrajectoryController": "position",
    "JointPositionController": "position",
    "JointVelocityController": "velocity",
}
KEYS = (
    "type", "joint", "joints", "pid", "gains", "constraints", "state_publish_rate", "action_monitor_rate",
    "stop_trajectory_duration",
)  # fmt: skip
GAINS = ("p", "i", "d", "i_clamp")
_KEYS_OF_GAINS = (*GAINS, "i_clamp_min", "i_clamp_max", "antiwindup")


def is_pid(part: dict[str, Any]) -> bool:
    """Return whether a controller has gains and is one of :data:`INTERFACES` in ``effort_controllers``."""
    kind = str(part.get("type")).partition("effort_controllers/")[2]
    return kind in INTERFACES and ("gains" in part or "pid" in part)


def read_pid(source: Source) -> None:
    """Convert a controller to ``joint_pid``, which holds the joints at their initial positions."""
    source.refuse_unknown(KEYS)
    data = source.data
    kind = str(data["type"]).partition("/")[2]
    joints = joint_names(source)
    key = "gains" if "gains" in data else "pid"
    source.put(("kind",), "joint_pid", "type")
    source.note("type", "understood", f"{data['type']} becomes a PID per joint")
    source.put(("interface",), INTERFACES[kind], "type")
    source.put(("joints",), joints, "joints" if "joints" in data else "joint")
    gains = [_gains_of(source, key, name) for name in joints]
    for name in ("p", "d"):
        source.result[name] = [one[name] for one in gains]
    if any(one["i"] and one["i_clamp"] for one in gains):
        source.result["i"] = [one["i"] if one["i_clamp"] else 0.0 for one in gains]
        source.result["i_limit"] = [abs(one["i_clamp"]) or 1.0 for one in gains]
    if any(one["i"] and not one["i_clamp"] for one in gains):
        source.note(key, "corrected", "in ROS Control, i without i_clamp has no effect: it becomes zero")
    source.note(
        key, "understood",
        "the gains are unchanged; OnOrbitROS receives commands over a topic, but here the joints are held: "
        f"add a reference, or convert with {option('--external', 'external=True')} to send commands from "
        "ROS 2",
    )  # fmt: skip
    source.comments[("p",)] = f"{source.file.name}: {key}"
    for extra in KEYS[5:]:
        if extra in data:
            source.note(extra, "no meaning", "a scenario has neither action goals nor topics")


def joint_names(source: Source) -> list[str]:
    """Return the joints that a controller of ROS Control lists."""
    data = source.data
    joints = data["joints"] if "joints" in data else [data.get("joint")]
    if not isinstance(joints, list) or not joints or not all(isinstance(name, str) for name in joints):
        key = "joints" if "joints" in data else "joint"
        raise source.fail(key, f"must name the controlled joints, not {shortened(data.get(key))}")
    return joints


def _gains_of(source: Source, key: str, joint: str) -> dict[str, float]:
    """Return ``p``, ``i``, ``d`` and ``i_clamp`` of a joint; missing ones are zero, as in ROS Control."""
    table = source.data[key]
    if key == "gains" and isinstance(table, dict):
        table = table.get(joint)
    if not isinstance(table, dict):
        raise source.fail(
            key, f"has no gains for {joint}; give p and, unless they are zero, i, d and i_clamp"
        )
    inside = source.inside(key)
    if key == "gains":
        inside = inside.inside(joint)
    for name in table:
        if name not in _KEYS_OF_GAINS:
            known = ", ".join(_KEYS_OF_GAINS)
            raise inside.fail(name, f"is not a gain of ROS Control; the gains are {known}")
    found = {name: inside.number(name) if name in table else 0.0 for name in GAINS}
    for name in ("i_clamp_min", "i_clamp_max"):
        if name in table:
            found["i_clamp"] = max(found["i_clamp"], abs(inside.number(name)))
    return found
