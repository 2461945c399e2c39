"""Text of a drafted scenario, with comments that explain the sections and state the units of numbers."""

from __future__ import annotations

import re
import textwrap
from collections.abc import Sequence
from dataclasses import dataclass, field
from typing import Any

from onorbit_rs.common.printable import json_text


@dataclass(frozen=True)
class Plan:
    """Contents of a drafted scenario that depend on the robot."""

    name: str
    robot: dict[str, Any] | str
    tool: str | None = None
    arm: list[str] = field(default_factory=list)
    others: list[str] = field(default_factory=list)
    home: dict[str, float] = field(default_factory=dict)
    displacement: list[float] | None = None
    goal: dict[str, float] | None = None
    move_s: float = 4.0
    is_slowed: bool = False
    duration_s: float = 6.0
    time_step_s: float = 1e-3
    integrator: str = "rk4"
    exceeding: list[str] = field(default_factory=list)
    """Joints that exceed their effort limits however slow the motion is."""
    failures: list[str] = field(default_factory=list)
    """Reasons why the scenario only holds the joints; empty if the arm moves."""


def draft_text(plan: Plan, command: str) -> str:
    """Return YAML text that :func:`onorbit_rs.scenario.load` accepts."""
    parts = (_head(plan, command), ORBIT, _control(plan), _initial(plan), _simulation(plan))
    return "\n".join(part.strip("\n") + "\n" for part in parts if part)


def _head(plan: Plan, command: str) -> str:
    what = _what(plan)
    robot = robot_entry(plan.robot)
    tool = keyed_line("tool", plan.tool, "the frame that is recorded; 'onorbit info' lists all frames")
    return f"""
# Written by: {one_line(command)}
# A free-floating robot in low Earth orbit {what}.
# Numbers without a unit are in SI (m, kg, s, rad); with a unit: 400 km, 51.6 deg, 2 ms.
name: {flow(plan.name)}
description: A free-floating robot in low Earth orbit {what}.

{robot}{tool if plan.tool is not None else ""}
"""


def _what(plan: Plan) -> str:
    if plan.arm:
        return "moves its tool along a line" if plan.goal is None else "moves its joints"
    return "holds its joints" if plan.others else "rotates freely"


def robot_entry(robot: dict[str, Any] | str, indent: int = 0) -> str:
    """Return the text of the ``robot`` entry of a scenario or of a system."""
    if isinstance(robot, dict) and "bus" in robot:
        return textwrap.indent(_bus(robot), " " * indent)
    return keyed_line("robot", robot, "a bundled name, or a URDF or xacro file relative to this file", indent)


def _bus(robot: dict[str, Any]) -> str:
    """Return the ``robot`` entry of a bus with one arm."""
    (arm,) = robot["arms"]
    comments = {
        "bundled": "a name that 'onorbit list' prints",
        "urdf": "a URDF or xacro file relative to this file",
        "package_paths": "folders with ROS packages", "xacro_arguments": "arguments of the xacro file",
        "xacro": "expand the file as xacro", "at": "a link or frame of the bus",
        "prefix": "prefix of the arm's links, joints and frames",
    }  # fmt: skip
    lines = "".join(keyed_line(key, value, comments[key], 6) for key, value in arm.items())
    return f"""\
robot:                          # a bus with an arm; the base of the robot is that of the bus
{keyed_line("bus", robot["bus"], "a bundled name, or a URDF or xacro file relative to this file", 2)}\
  arms:
    -{lines[5:]}\
      # pose: {{position: [0, 0, 10 cm], attitude: {{roll_pitch_yaw: [0, 90 deg, 0]}}}}   # in the frame 'at'
"""


ORBIT = """
orbit:                          # an orbit implies gravity, evaluated at the position of every link
  kind: kepler                  # or sgp4, numerical (uses all gravity below), custom_path, fixed_frame
  semi_major_axis: 6778 km      # 400 km above the equator
  eccentricity: 0.0005
  inclination: 51.6 deg
  raan: 0 deg                   # right ascension of the ascending node
  argument_of_periapsis: 0 deg
  mean_anomaly: 0 deg           # initial position on the ellipse

environment:                    # effects besides the gravity of a point mass
  - kind: gravity_gradient      # torque on every link, N m
  # - kind: drag                # requires 'epoch: 2026-03-20 12:00:00 UTC' above
  #   atmosphere: {kind: nrlmsise00, f107: 150, f107a: 150, ap: 15}
  # - kind: radiation_pressure  # requires an epoch
"""


def _control(plan: Plan) -> str:
    comment = f"all {'other ' if plan.arm else ''}joints keep their initial positions"
    hold = _HOLD.replace("COMMENT", comment).replace("JOINTS", _wrapped(plan.others)) if plan.others else ""
    if not plan.arm:
        return f"\n{_note(_FAILED, plan.failures)}controllers:\n{hold}" if hold else ""
    law = _task_law(plan) if plan.displacement is not None else _joint_law(plan)
    return f"""
{_note(_EXCEEDING, plan.exceeding)}\
controllers:                    # each drives different joints; joints without one have no torque
  - name: arm
    joints: {_wrapped(plan.arm)}
{law}{hold}"""


def _note(text: str, items: list[str]) -> str:
    """Return comment lines that list the items after a text; empty if there are no items."""
    lines = textwrap.wrap(f"{text}: {', '.join(items)}", 105, break_long_words=False)
    return "".join(f"# {line}\n" for line in lines if items)


_EXCEEDING = "Joints that exceed their effort limits however slow the motion is"
_FAILED = "All joints are held, since trial runs of arm motions failed"


def _task_law(plan: Plan) -> str:
    displacement = keyed_line(
        "displacement", plan.displacement, "m, axes of W: those of the base at the start", 8
    )
    return f"""\
    kind: computed_torque       # controls the pose of the tool with the generalized Jacobian
    tool: {flow(plan.tool)}
    kp: 25                      # 1/s^2, gain of the pose error
    kd: 10                      # 1/s, gain of the velocity error; 2 sqrt(kp) is critical damping
    null_space_damping: 2       # 1/s, damps joint motion that does not move the tool
    reference:
      kind: line                # or hold, circle, screw, waypoints, line_parabola, sampled
      goal:
{displacement}{_slowed(plan, "duration", f"{plan.move_s:g} s")}\
    goal:
      tolerance: [1 mm, 0.1 deg]  # largest error of the tool at the end
"""


def _joint_law(plan: Plan) -> str:
    return f"""\
    kind: joint_computed_torque # controls joints; the full pose of a tool requires six joints
    kp: 25                      # 1/s^2
    kd: 10                      # 1/s; 2 sqrt(kp) is critical damping
    reference:
      kind: joint_waypoints
      points:                   # rad, or m for prismatic joints
        - {flow(plan.goal)}
{_slowed(plan, "times", f"[{plan.move_s:g} s]")}"""


def _slowed(plan: Plan, key: str, value: str) -> str:
    """Return the line with the duration of the motion, with a comment if joint limits determine it."""
    entry = f"      {key}: {value}"
    return commented(entry, "long enough for the limits of the joints") if plan.is_slowed else f"{entry}\n"


_HOLD = """\
  - name: hold                  # COMMENT
    kind: joint_computed_torque
    joints: JOINTS
    kp: 25                      # 1/s^2
    kd: 10                      # 1/s
    reference: {kind: joint_hold}
"""


def _initial(plan: Plan) -> str:
    if not plan.home:
        return """
initial:
  angular_velocity: [0.2 deg/s, 1 deg/s, 0.3 deg/s]   # of the base, body axes
"""
    joints = "\n".join(f"    {flow(name)}: {value:g}" for name, value in plan.home.items())
    return f"""
initial:                        # the base is at rest at the origin of W, which follows the orbit
  joints:                       # rad, or m for prismatic joints; others are zero
{joints}
"""


def _simulation(plan: Plan) -> str:
    return f"""
simulation:
{keyed_line("duration", f"{plan.duration_s:g} s", "simulated", 2)}\
{keyed_line("time_step", f"{1e3 * plan.time_step_s:g} ms", "of the integrator and the controllers", 2)}\
{_INTEGRATORS[plan.integrator]}\
  # record_wrenches: true       # force and torque of every effect on every link
"""


_INTEGRATORS = {
    "rk4": "  # integrator: dormand_prince  # adaptive steps; default: rk4\n",
    "dormand_prince": "  integrator: dormand_prince    # adaptive steps: rk4 would need very short ones\n",
}


def _wrapped(names: Sequence[str], indent: int = 13) -> str:
    """Return a list of names, wrapped over several lines."""
    lines, line = [], ""
    for name in names:
        word = f"{flow(name)}, "
        if line and len(line) + len(word) > 100 - indent:
            lines.append(line.rstrip())
            line = ""
        line += word
    return "[" + ("\n" + " " * indent).join([*lines, line.rstrip(", ")]) + "]"


def keyed_line(key: str, value: object, comment: str, indent: int = 0) -> str:
    """Return an entry with its comment, aligned with the other comments."""
    return commented(f"{' ' * indent}{key}: {flow(value)}", comment)


def commented(entry: str, comment: str) -> str:
    """Return a line of YAML with a comment, aligned with the other comments."""
    return f"{entry:<31} # {comment}\n"


def flow(value: object) -> str:
    """Return a value as YAML on one line: JSON, without quotes for words and numbers with units."""
    is_plain = isinstance(value, str) and _PLAIN.fullmatch(value) and value.lower() not in _NO_WORDS
    return str(value) if is_plain else json_text(value)


_PLAIN = re.compile(r"(\./)?[A-Za-z][\w./-]*|[\d.]+ [a-z]+")
_NO_WORDS = ("true", "false", "null", "yes", "no", "on", "off", "y", "n")


def one_line(text: str) -> str:
    """Return the text with its line breaks replaced by spaces."""
    return " ".join(text.split())
