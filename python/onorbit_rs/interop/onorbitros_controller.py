"""Controllers of OnOrbitROS: an end effector, joints, two gains, a duration."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from onorbit_rs.exceptions import QuantityError
from onorbit_rs.interop.expressions import evaluate
from onorbit_rs.names import did_you_mean

if TYPE_CHECKING:
    from onorbit_rs.interop.onorbitros import Source

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
_SCENARIO = "one scenario moves one tool; choose it with --controller"


def read_controllers(source: Source, wanted: str | None) -> None:
    """The wanted one, or the first, to ``tool``, ``controller`` and ``reference``."""
    if "end_effector_link" in source.data or "kp_value" in source.data:
        _read(source)
        return
    of_tasks = [name for name, part in source.data.items() if isinstance(part, dict) and _is_of_task(part)]
    if not of_tasks:
        kinds = {str(part.get("type")) for part in source.data.values() if isinstance(part, dict)}
        name = next(iter(source.data))
        raise source.fail(
            name, f"no controller with an end_effector_link, but {', '.join(sorted(kinds))}: controllers of "
            "ROS Control are not converted",
        )  # fmt: skip
    if wanted is not None and wanted not in of_tasks:
        raise source.fail(of_tasks[0], f"no controller is named {wanted!r}{did_you_mean(wanted, of_tasks)}")
    chosen = wanted or of_tasks[0]
    for name, part in source.data.items():
        if name == chosen:
            source.note(name, "understood", "the controller")
            inside = type(source)(
                source.file, source.lines, (*source.at, name), part, source.keep_going, source.notes,
                source.result, source.comments,
            )  # fmt: skip
            _read(inside)
        else:
            what = _SCENARIO if name in of_tasks else "not a controller of an end effector"
            source.note(name, "no meaning", what)


def _is_of_task(part: dict[str, Any]) -> bool:
    return "end_effector_link" in part or "kp_value" in part


def _read(source: Source) -> None:
    source.refuse_unknown(KEYS)
    data = source.data
    if "end_effector_link" not in data:
        raise source.fail("end_effector_link", "is missing: the link that is to be moved")
    for key in ("end_effector_link", "base_link", "type"):
        if key in data and not isinstance(data[key], str):
            raise source.fail(key, f"must be a name, not {data[key]!r}")
    source.put(("tool",), data["end_effector_link"], "end_effector_link")
    source.note("end_effector_link", "understood", f"tool: {data['end_effector_link']}")
    source.put(("controller", "kind"), "computed_torque", "type")
    if "type" in data:
        law = "computed torque of the paper's Eq. (6)-(8)"
        source.note("type", "understood", f"{data['type']} becomes {law}")
    _gains(source)
    if "joints" in data:
        if not isinstance(data["joints"], list) or not all(isinstance(name, str) for name in data["joints"]):
            raise source.fail("joints", "must be a list of names")
        source.note(
            "joints",
            "no meaning",
            "the law drives all joints that move the tool, as the reduced model has them",
        )
    if "base_link" in data:
        source.note("base_link", "no meaning", "the robot's root link is its base, and floats")
    if "goal_tolerance" in data:
        _number(source, "goal_tolerance")
        source.note("goal_tolerance", "no meaning", "the law has no goal to reach; the trace has the errors")
    _trajectory(source)


def _gains(source: Source) -> None:
    for key, ours, unit in (("kp_value", "kp", "1/s²"), ("kv_value", "kd", "1/s")):
        if key not in source.data:
            source.note(key, "corrected", f"not given: the default of {ours} here")
            continue
        value = _number(source, key)
        if value < 0.0:
            raise source.fail(key, f"{value:g} is negative, a gain must not be")
        source.put(("controller", ours), value, key)
        source.note(
            key, "understood",
            f"{ours} {value:g} {unit}, the paper's gain; "
            "the node of robot_torso takes it for a stiffness (Jᵀ law): tune it",
        )  # fmt: skip


def _trajectory(source: Source) -> None:
    if "trajectory_duration" not in source.data:
        return
    seconds = _number(source, "trajectory_duration")
    if seconds <= 0.0:
        raise source.fail("trajectory_duration", f"{seconds:g} s is no duration, it must be positive")
    key = "trajectory_duration"
    source.put(("reference", "kind"), "line_parabola", key)
    source.put(("reference", "displacement"), [0.0, 0.0, 0.0], key)
    source.put(("reference", "duration"), seconds, key)
    source.put(("simulation", "duration"), seconds, key)
    source.comments.pop(("reference", "kind"))
    source.comments[("reference", "displacement")] = (
        "the target came over a ROS topic: write it here, m, W axes"
    )
    source.note(
        key, "understood", f"{seconds:g} s; the target comes over a topic there: fill in 'displacement'"
    )


def _number(source: Source, key: str) -> float:
    try:
        return evaluate(source.data[key])
    except QuantityError as error:
        raise source.fail(key, str(error)) from None
