"""Controllers of ROS Control that command efforts by a PID for each joint."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from onorbit_rs.interop.source import Source

_INTERFACES = {
    "JointTrajectoryController": "position",
    "JointPositionController": "position",
    "JointVelocityController": "velocity",
}
KEYS = (
    "type", "joint", "joints", "pid", "gains", "constraints", "state_publish_rate", "action_monitor_rate",
    "stop_trajectory_duration",
)  # fmt: skip
GAINS = ("p", "i", "d", "i_clamp")


def is_pid(part: dict[str, Any]) -> bool:
    """Whether it is one of ``effort_controllers`` with gains."""
    kind = str(part.get("type")).partition("effort_controllers/")[2]
    return kind in _INTERFACES and ("gains" in part or "pid" in part)


def read_pid(source: Source) -> None:
    """To a ``joint_pid`` that holds its joints where they start."""
    source.refuse_unknown(KEYS)
    data = source.data
    kind = str(data["type"]).partition("/")[2]
    joints = data["joints"] if "joints" in data else [data.get("joint")]
    if not isinstance(joints, list) or not joints or not all(isinstance(name, str) for name in joints):
        raise source.fail("joints" if "joints" in data else "joint", "must name the joints it drives")
    key = "gains" if "gains" in data else "pid"
    source.put(("kind",), "joint_pid", "type")
    source.note("type", "understood", f"{data['type']} becomes a PID for each joint")
    source.put(("interface",), _INTERFACES[kind], "type")
    source.put(("joints",), joints, "joints" if "joints" in data else "joint")
    gains = [_gains_of(source, key, name) for name in joints]
    for name in ("p", "d"):
        source.result[name] = [one[name] for one in gains]
    if any(one["i"] and one["i_clamp"] for one in gains):
        source.result["i"] = [one["i"] if one["i_clamp"] else 0.0 for one in gains]
        source.result["i_limit"] = [abs(one["i_clamp"]) or 1.0 for one in gains]
    if any(one["i"] and not one["i_clamp"] for one in gains):
        source.note(key, "corrected", "an i without i_clamp does nothing there: its integral is held at zero")
    source.note(
        key, "understood",
        "as they are; commands came over a topic: the joints are held where they start, or write a reference",
    )  # fmt: skip
    source.comments[("p",)] = f"{source.file.name}: {key}"
    for extra in KEYS[5:]:
        if extra in data:
            source.note(extra, "no meaning", "there is no goal to be late for, and no topic")


def _gains_of(source: Source, key: str, joint: str) -> dict[str, float]:
    """Those of a joint; what is not given is zero there too."""
    table = source.data[key]
    if key == "gains" and isinstance(table, dict):
        table = table.get(joint)
    if not isinstance(table, dict):
        raise source.fail(
            key, f"has no gains for {joint}: give it p, and i, d, i_clamp where they are not zero"
        )
    inside = source.inside(key)
    if key == "gains":
        inside = inside.inside(joint)
    for name in table:
        if name not in (*GAINS, "antiwindup", "i_clamp_min", "i_clamp_max"):
            raise inside.fail(name, f"no gain of ROS Control; there are {', '.join(GAINS)}")
    found = {name: inside.number(name) if name in table else 0.0 for name in GAINS}
    for name in ("i_clamp_min", "i_clamp_max"):
        if name in table:
            found["i_clamp"] = max(found["i_clamp"], abs(inside.number(name)))
    return found
