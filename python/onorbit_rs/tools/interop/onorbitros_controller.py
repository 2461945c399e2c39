"""Converts controllers of OnOrbitROS: end effector, joints, two gains and a duration."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from onorbit_rs.scenario.yaml_lines import Location
    from onorbit_rs.tools.interop.source import Source

KEYS = (
    "type",
    "end_effector_link",
    "base_link",
    "joints",
    "kp_value",
    "kv_value",
    "trajectory_duration",
    "goal_tolerance",
)


def is_of_task(part: dict[str, Any]) -> bool:
    """Return whether a controller is a task-space controller, which moves an end effector."""
    return "end_effector_link" in part or "kp_value" in part


def joints_of(part: dict[str, Any]) -> list[str]:
    """Return the joints that a controller lists; empty if it lists none."""
    joints = part.get("joints", [part["joint"]] if "joint" in part else [])
    return [str(name) for name in joints] if isinstance(joints, list) else []


def read_task_law(source: Source, law: Location) -> None:
    """Convert a controller to ``tool`` and a control law and, if it has a duration, to a ``reference``.

    ``law`` is the location of the keys of the law; it is empty for an entry of ``controllers``.
    """
    source.refuse_unknown(KEYS)
    data = source.data
    if "end_effector_link" not in data:
        raise source.fail("end_effector_link", "is missing; give the link to move")
    for key in ("end_effector_link", "base_link", "type"):
        if key in data and not isinstance(data[key], str):
            raise source.fail(key, f"must be a name, not {data[key]!r}")
    source.put(("tool",), data["end_effector_link"], "end_effector_link")
    source.note("end_effector_link", "understood", f"tool: {data['end_effector_link']}")
    source.put((*law, "kind"), "computed_torque", "type")
    if "type" in data:
        source.note(
            "type", "understood",
            f"{data['type']} becomes computed torque, Eq. (6)-(8) of the OnOrbitROS paper",
        )  # fmt: skip
    _gains(source, law)
    if "joints" in data:
        if not isinstance(data["joints"], list) or not all(isinstance(name, str) for name in data["joints"]):
            raise source.fail("joints", f"must be a list of names, not {data['joints']!r:.60}")
        if law:
            text = "the law drives all joints that move the tool, as in the reduced model"
            source.note("joints", "no meaning", text)
        else:
            source.put(("joints",), data["joints"], "joints")
            source.note("joints", "understood", "the joints that the controller drives")
    if "base_link" in data:
        source.note("base_link", "no meaning", "the robot's root link is its free-floating base")
    if "goal_tolerance" in data:
        source.number("goal_tolerance")
        source.note(
            "goal_tolerance", "no meaning", "the control law has no goal; the trace contains the errors"
        )
    _trajectory(source)


def _gains(source: Source, law: Location) -> None:
    for key, gain, unit in (("kp_value", "kp", "1/s²"), ("kv_value", "kd", "1/s")):
        if key not in source.data:
            source.note(key, "corrected", f"not given: the default of {gain} is used")
            continue
        value = source.number(key)
        if value < 0.0:
            raise source.fail(key, f"{value:g} is negative; a gain must be zero or positive")
        source.put((*law, gain), value, key)
        source.note(
            key, "understood",
            f"{gain} {value:g} {unit}, the gain in the OnOrbitROS paper; "
            "the node of robot_torso uses it as a stiffness (Jᵀ law), so it may need tuning",
        )  # fmt: skip


def _trajectory(source: Source) -> None:
    if "trajectory_duration" not in source.data:
        return
    seconds = source.number("trajectory_duration")
    if seconds <= 0.0:
        raise source.fail(
            "trajectory_duration", f"{seconds:g} s is not a valid duration; it must be positive"
        )
    key = "trajectory_duration"
    source.put(("reference", "kind"), "line_parabola", key)
    source.put(("reference", "displacement"), [0.0, 0.0, 0.0], key)
    source.put(("reference", "duration"), seconds, key)
    source.put(("simulation", "duration"), seconds, key)
    source.comments.pop(("reference", "kind"))
    source.comments[("reference", "displacement")] = (
        "the target was sent over a ROS topic; give its displacement here, m, W axes"
    )
    source.note(
        key, "understood", f"{seconds:g} s; OnOrbitROS receives the target over a topic; give 'displacement'"
    )
