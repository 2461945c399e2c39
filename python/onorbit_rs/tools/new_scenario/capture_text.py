"""Text of a drafted scenario in which one spacecraft captures and releases another."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Any

from onorbit_rs.tools.new_scenario.approach import GAP_M, Approach
from onorbit_rs.tools.new_scenario.text import (
    ORBIT,
    commented,
    flow,
    keyed_line,
    one_line,
    robot_entry,
)

WITHIN_M = 0.01
"""Largest distance between the frames at which the latch closes, m."""
WITHIN_DEG = 2.0
"""Largest angle between parallel frames at which the latch closes, degrees."""


SPEEDS = (0.02, 0.01, 0.005)
"""Speeds of the approach that are tried, m/s."""


@dataclass(frozen=True)
class CapturePlan:
    """Contents of a drafted scenario that depend on the two spacecraft."""

    name: str
    chaser: dict[str, Any] | str
    target: dict[str, Any] | str
    tool: str
    handle: str
    approach: Approach
    home: dict[str, float] = field(default_factory=dict)
    """Initial positions of the chaser's joints by name, rad or m; zero if missing, as in ``target_home``."""
    target_home: dict[str, float] = field(default_factory=dict)
    chaser_joints: int = 0
    target_joints: int = 0
    speed: float = SPEEDS[0]
    """Speed of the approach, m/s; the impulse of the spring is proportional to it."""
    held_s: float = 5.0
    """Time from the capture to the release, s."""
    time_step_s: float = 1e-3
    integrator: str = "rk4"

    @property
    def duration_s(self) -> float:
        """Duration of the run, s: the approach, the time until the release, and the retreat."""
        return float(f"{1.5 * GAP_M / self.speed + self.held_s + 4.0:.2g}")


def capture_text(plan: CapturePlan, command: str) -> str:
    """Return YAML text that :func:`onorbit_rs.scenario.load` accepts."""
    parts = (_head(plan, command), ORBIT, _systems(plan), _events(plan), _simulation(plan))
    return "\n".join(part.strip("\n") + "\n" for part in parts)


def _head(plan: CapturePlan, command: str) -> str:
    return f"""
# Written by: {one_line(command)}
# A target approaches the tool of a chaser; the chaser captures the target, holds it, and releases it
# with a spring.
# Numbers without a unit are in SI (m, kg, s, rad); with a unit: 400 km, 51.6 deg, 2 ms.
name: {flow(plan.name)}
description: >-
  A target approaches the tool of a chaser; the chaser captures the target, holds it, and releases it with a
  spring.
"""


def _systems(plan: CapturePlan) -> str:
    approach = plan.approach
    velocity = [round(plan.speed * part, 9) + 0.0 for part in approach.direction]
    return f"""
systems:
  chaser:
{robot_entry(plan.chaser, 4)}\
{keyed_line("tool", plan.tool, "the frame that captures; 'onorbit info' lists all frames", 4)}\
{_joints(plan.home)}\
{_hold(plan.chaser_joints, 40, _LOADED)}\
  target:
{robot_entry(plan.target, 4)}\
    initial:
{keyed_line("frame", f"chaser/{plan.tool}", "position and attitude are relative to this frame", 6)}\
{keyed_line("position", approach.position, f"m; {plan.handle} is {100 * GAP_M:g} cm from the tool", 6)}\
      attitude: {{quaternion_xyzw: {flow(approach.quaternion)}}}
{keyed_line("linear_velocity", velocity, "m/s, relative to the frame, axes of the target's base", 6)}\
{_positions(plan.target_home)}\
{_hold(plan.target_joints, 10)}"""


def _events(plan: CapturePlan) -> str:
    angle, remark = WITHIN_DEG, "distance and angle of the two frames"
    if plan.approach.angle > 0.01:
        angle, remark = 180.0, "distance and angle; any angle, since the frames are not parallel"
    push = plan.approach.impulse * plan.speed / SPEEDS[0]
    impulse = [float(f"{push * part:.2g}") + 0.0 for part in plan.approach.axis]
    return f"""
events:
  - name: grasp
    when:                       # or 'at: 5 s', 'on_command: true', 'after: another event'
      latch:
{commented(f"        within: [{100 * WITHIN_M:g} cm, {angle:g} deg]", remark)}\
{commented("        slower_than: [10 cm/s, 5 deg/s]", "relative speed and angular speed")}\
{keyed_line("held_for", "0.1 s", "time for which the conditions must hold", 8)}\
    do: {{capture: {_list(f"chaser/{plan.tool}", f"target/{plan.handle}")}}}   # the capturing frame first
  - name: let_go
    when: {{after: grasp, delay: {plan.held_s:g} s}}
    do:
      release: grasp
{keyed_line("impulse", [*impulse, 0, 0, 0], "of a spring on the target, N s, N m s; axes of the tool", 6)}"""


def _simulation(plan: CapturePlan) -> str:
    every = max(1, round(0.02 / plan.time_step_s))
    integrator = (
        keyed_line("integrator", plan.integrator, "adaptive steps: rk4 would need very short ones", 2)
        if plan.integrator != "rk4"
        else "  # integrator: dormand_prince  # adaptive steps; default: rk4\n"
    )
    return f"""
simulation:
{keyed_line("duration", f"{plan.duration_s:g} s", "simulated", 2)}\
{keyed_line("time_step", f"{1e3 * plan.time_step_s:g} ms", "of the integrator and the controllers", 2)}\
{keyed_line("record_every", every, "steps; there are also rows before and after an event", 2)}\
{integrator}"""


_LOADED = "high, because the control law does not know the mass of the captured target"


def _hold(joints: int, damping: int, remark: str = "") -> str:
    """Return the text of a controller that holds all joints; empty for a spacecraft without joints."""
    if joints == 0:
        return ""
    gain = keyed_line("kd", damping, f"1/s{', ' if remark else ''}{remark}", 6)
    return f"""\
    controller:                 # all joints keep their initial positions
      kind: joint_computed_torque
      kp: 25                    # 1/s^2
{gain}"""


def _joints(home: dict[str, float]) -> str:
    """Return the text of the chaser's initial state; empty if all joint positions are zero."""
    if not home:
        return ""
    head = (
        "    initial:                    # the base is at rest at the origin of W, which follows the orbit\n"
    )
    return head + _positions(home)


def _positions(home: dict[str, float]) -> str:
    """Return the text of initial joint positions; empty if all positions are zero."""
    if not home:
        return ""
    lines = "".join(f"        {flow(name)}: {value:g}\n" for name, value in home.items())
    return f"      joints:                   # rad, or m for prismatic joints; others are zero\n{lines}"


def _list(*names: str) -> str:
    return f"[{', '.join(map(flow, names))}]"
