"""A world in which both arms of a servicer hold one module, for tests."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np

import onorbit_rs as oo
from onorbit_rs.scenario import WorldScenario, load
from onorbit_rs.scenario.build_world import build_world

SCENARIO = oo.scenarios.path("berthing_with_two_arms")
"""Both arms of a servicer move a module to its berthing port."""


def module() -> oo.Model:
    """Return the module."""
    return oo.robots.load("station_module")


def hold(
    *,
    knows: Sequence[str] = ("module",),
    load: str | None = "module/berthing_ring",
    tool: str = "left_tool",
    internal_forces: Sequence[oo.InternalForce] = (),
    events: Sequence[Any] | None = None,
) -> tuple[oo.World, Any]:
    """Return a world in which both hands hold and move the module from the start, and the path of its ring.

    ``events`` replace the captures by both hands at the start; the second one must be named ``right``.
    Without ``load``, the path is that of the tool, moved to start at its present pose, without a turn.
    """
    robot, held = oo.robots.load("two_arm_servicer"), module()
    q, other = initial()
    first = held.frame_pose(other, "berthing_ring")
    last = first.copy()
    last[:3, 3] += [-0.05, 0.04, -0.03]
    angle = 0.0 if load is None else 0.05
    turn = np.array([[np.cos(angle), -np.sin(angle), 0.0], [np.sin(angle), np.cos(angle), 0.0], [0, 0, 1]])
    last[:3, :3] = turn @ last[:3, :3]
    reference = oo.Line(first, last, duration=2.0)
    control = oo.Control(
        oo.ComputedTorque(robot, tool, kp=100.0, kd=20.0, null_space_damping=2.0, damping=1e-3),
        reference=reference,
        name="hands",
        after="right",
        load=load,
        starts_at_present=load is None,
        internal_forces=list(internal_forces),
    )
    systems = [
        oo.System("servicer", robot, q, np.zeros(robot.nv), controller=[control], knows=list(knows)),
        oo.System("module", held, other, np.zeros(6)),
    ]
    captures = [
        oo.Capture(side, f"servicer/{side}_tool", f"module/{side}_handle", at=0.0)
        for side in ("left", "right")
    ]
    return oo.World(systems, events=captures if events is None else list(events)), reference


def initial() -> tuple[Any, Any]:
    """Return the configurations of both systems at the start of the scenario."""
    scenario = load(SCENARIO)
    assert isinstance(scenario, WorldScenario)
    systems = build_world(scenario).systems
    return systems["servicer"].q, systems["module"].q
