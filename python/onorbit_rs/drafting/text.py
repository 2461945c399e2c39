"""The words of a drafted scenario: every section with a comment, every number with its unit."""

from __future__ import annotations

import re
from collections.abc import Sequence
from dataclasses import dataclass, field
from typing import Any

from onorbit_rs.printable import json_text


@dataclass(frozen=True)
class Plan:
    """What differs from robot to robot."""

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


def draft_text(plan: Plan, command: str) -> str:
    """YAML that :func:`onorbit_rs.scenario.load` takes."""
    parts = (_head(plan, command), _ORBIT, _control(plan), _initial(plan), _simulation(plan))
    return "\n".join(part.strip("\n") + "\n" for part in parts if part)


def _head(plan: Plan, command: str) -> str:
    what = "turns freely"
    if plan.displacement is not None or plan.goal is not None:
        what = "moves its tool along a line" if plan.goal is None else "moves its joints"
    robot = (
        _bus(plan.robot)
        if isinstance(plan.robot, dict) and "bus" in plan.robot
        else _line("robot", plan.robot, "a bundled name, or a URDF or xacro file, from this file's folder")
    )
    tool = _line("tool", plan.tool, "the frame that is recorded; 'onorbit info' lists all frames")
    return f"""
# Written by: {_one_line(command)}
# A robot in low Earth orbit {what} while nothing holds its base.
# A bare number is SI (m, kg, s, rad); a unit may follow any number: 400 km, 51.6 deg, 2 ms.
name: {_flow(plan.name)}
description: A robot in low Earth orbit {what} while nothing holds its base.

{robot}{tool if plan.tool is not None else ""}
"""


def _bus(robot: dict[str, Any]) -> str:
    """A bus with one arm."""
    (arm,) = robot["arms"]
    said = {
        "bundled": "a name that 'onorbit list' prints",
        "urdf": "a URDF or xacro file, from this file's folder",
        "package_paths": "where its packages are", "xacro_arguments": "for its xacro",
        "xacro": "expand it, whatever its name", "at": "a link or frame of the bus",
        "prefix": "before the names of the arm's links and joints",
    }  # fmt: skip
    lines = "".join(_line(key, value, said[key], 6) for key, value in arm.items())
    return f"""\
robot:                          # a bus with an arm; the bus is the base of the whole
{_line("bus", robot["bus"], "a bundled name, or a URDF or xacro file, from this file's folder", 2)}\
  arms:
    -{lines[5:]}\
      # pose: {{position: [0, 0, 10 cm], attitude: {{roll_pitch_yaw: [0, 90 deg, 0]}}}}   # in the frame 'at'
"""


_ORBIT = """
orbit:                          # with an orbit the planet pulls on every link, each at its own place
  kind: kepler                  # or sgp4, numerical (falls in all gravity below), custom_path, fixed_frame
  semi_major_axis: 6778 km      # 400 km above the equator
  eccentricity: 0.0005
  inclination: 51.6 deg
  raan: 0 deg                   # of the ascending node
  argument_of_periapsis: 0 deg
  mean_anomaly: 0 deg           # where on the ellipse it starts

environment:                    # what acts beside the planet's pull
  - kind: gravity_gradient      # torque of gravity on every link, N m
  # - kind: drag                # the air; needs 'epoch: 2026-03-20 12:00:00 UTC' above
  #   atmosphere: {kind: nrlmsise00, f107: 150, f107a: 150, ap: 15}
  # - kind: radiation_pressure  # sunlight; needs an epoch too
"""


def _control(plan: Plan) -> str:
    if not plan.arm:
        return ""
    law = _task_law(plan) if plan.displacement is not None else _joint_law(plan)
    hold = _HOLD.replace("JOINTS", _wrapped(plan.others))
    return f"""
controllers:                    # each drives joints of its own; joints without one are limp
  - name: arm
    joints: {_wrapped(plan.arm)}
{law}{hold if plan.others else ""}"""


def _task_law(plan: Plan) -> str:
    slowed = _SLOWED if plan.is_slowed else ""
    displacement = _line("displacement", plan.displacement, "m, W: the base's axes at the start", 8)
    return f"""\
    kind: computed_torque       # the pose of the tool, on the generalized Jacobian
    tool: {_flow(plan.tool)}
    kp: 25                      # 1/s^2, on the error of the pose
    kd: 10                      # 1/s, on that of the velocity; 2 sqrt(kp) is critical
    null_space_damping: 2       # 1/s, brings joints to rest that do not move the tool
    reference:
      kind: line                # or hold, circle, screw, waypoints, line_parabola, sampled
      goal:
{displacement}      duration: {plan.move_s:g} s{slowed}
    goal:
      tolerance: [1 mm, 0.1 deg]  # how near the tool is to be at the end
"""


def _joint_law(plan: Plan) -> str:
    slowed = _SLOWED if plan.is_slowed else ""
    return f"""\
    kind: joint_computed_torque # the joints; a tool needs six of them to be placed and turned at will
    kp: 25                      # 1/s^2
    kd: 10                      # 1/s; 2 sqrt(kp) is critical
    reference:
      kind: joint_waypoints
      points:                   # rad, m where a joint slides
        - {_flow(plan.goal)}
      times: [{plan.move_s:g} s]{slowed}
"""


_SLOWED = "           # so long that all joints keep their rate limits"

_HOLD = """\
  - name: hold                  # all other joints stay where they start
    kind: joint_computed_torque
    joints: JOINTS
    kp: 25                      # 1/s^2
    kd: 10                      # 1/s
    reference: {kind: joint_hold}
"""


def _initial(plan: Plan) -> str:
    if not plan.arm:
        return """
initial:
  angular_velocity: [0.2 deg/s, 1 deg/s, 0.3 deg/s]   # of the base, body axes
"""
    joints = "\n".join(f"    {_flow(name)}: {value:g}" for name, value in plan.home.items())
    return f"""
initial:                        # the base is at rest at the origin of W, which flies along the orbit
  joints:                       # rad, m where a joint slides; those not named are zero
{joints}
"""


def _simulation(plan: Plan) -> str:
    return f"""
simulation:
{_line("duration", f"{plan.duration_s:g} s", "simulated", 2)}\
{_line("time_step", f"{1e3 * plan.time_step_s:g} ms", "of the integrator and of the control", 2)}\
  # integrator: dormand_prince  # adapts its steps; rk4 where not given
  # record_wrenches: true       # force and torque of every effect on every link
"""


def _wrapped(names: Sequence[str], indent: int = 13) -> str:
    """A list of names over as many lines as it takes."""
    lines, line = [], ""
    for name in names:
        word = f"{_flow(name)}, "
        if line and len(line) + len(word) > 100 - indent:
            lines.append(line.rstrip())
            line = ""
        line += word
    return "[" + ("\n" + " " * indent).join([*lines, line.rstrip(", ")]) + "]"


def _line(key: str, value: object, comment: str, indent: int = 0) -> str:
    """An entry with its comment where the other comments are."""
    return f"{' ' * indent + key + ': ' + _flow(value):<31} # {comment}\n"


def _flow(value: object) -> str:
    """JSON is YAML on one line; plain words, and numbers with units, need no quotes."""
    is_plain = isinstance(value, str) and _PLAIN.fullmatch(value) and value.lower() not in _NO_WORDS
    return str(value) if is_plain else json_text(value)


_PLAIN = re.compile(r"(\./)?[A-Za-z][\w./-]*|[\d.]+ [a-z]+")
_NO_WORDS = ("true", "false", "null", "yes", "no", "on", "off", "y", "n")


def _one_line(text: str) -> str:
    return " ".join(text.split())
