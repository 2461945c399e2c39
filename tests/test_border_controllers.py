"""Controllers that do not fit the run, and singular states."""

from __future__ import annotations

import numpy as np
import pytest
from border import wrist

import onorbit_rs as oo
from onorbit_rs.exceptions import ControlError, ConvergenceError, SimulationError


def test_a_control_law_of_another_robot_is_rejected() -> None:
    torso, dual = oo.robots.load("humanoid_torso"), oo.robots.load("humanoid_dual_arm")
    law = oo.ComputedTorque(torso, "tool")
    q, v = dual.neutral(), np.zeros(dual.nv)
    hold = oo.Hold(dual.frame_pose(q, "right_tool"))
    with pytest.raises(
        ControlError, match="to robot 'humanoid_torso', but the robot of the run is 'humanoid_dual"
    ):
        oo.Simulation(dual, q, v, controller=law, reference=hold, tool="right_tool")
    with pytest.raises(ControlError, match="belongs to robot"):
        oo.rollout(dual, q[None], v[None], steps=2, controller=law, reference=hold)


def test_a_control_law_of_the_same_robot_loaded_again_is_accepted() -> None:
    one, other = oo.robots.load("humanoid_torso"), oo.robots.load("humanoid_torso")
    q, v = one.neutral(), np.zeros(one.nv)
    hold = oo.Hold(one.frame_pose(q, "tool"))
    trace = oo.Simulation(one, q, v, controller=oo.ComputedTorque(other, "tool"), reference=hold).run(0.01)
    assert trace.is_complete


def test_the_tool_of_the_run_must_be_the_frame_of_the_control_law() -> None:
    dual = oo.robots.load("humanoid_dual_arm")
    q, v = dual.neutral(), np.zeros(dual.nv)
    hold = oo.Hold(dual.frame_pose(q, "left_tool"))
    law = oo.ComputedTorque(dual, "right_tool")
    with pytest.raises(
        ControlError, match="tracks frame 'right_tool', but the tool of the system is 'left_tool'"
    ):
        oo.Simulation(dual, q, v, controller=law, reference=hold, tool="left_tool")


def test_a_singular_state_is_named_and_gives_no_nan() -> None:
    model = wrist()
    v, q = np.zeros(model.nv), model.neutral()
    with pytest.raises(ConvergenceError, match="the result for state 0 is not finite"):
        model.forward_dynamics(q, v, np.ones(model.nv))
    bent = q.copy()
    bent[8] = 0.5
    assert np.isfinite(model.forward_dynamics(bent, v, np.ones(model.nv))).all()
    with pytest.raises(ConvergenceError, match="the result for state 1 is not finite"):
        model.forward_dynamics(np.stack([bent, q]), np.stack([v, v]), np.ones((2, model.nv)))


def test_a_simulation_cannot_be_run_within_its_run() -> None:
    model = oo.robots.load("humanoid_torso")

    class Again(oo.Controller):
        def update(self, t: float, state: object) -> np.ndarray:
            simulation.run(0.01)
            return np.zeros(7)

    simulation = oo.Simulation(model, model.neutral(), np.zeros(model.nv), controller=Again())
    with pytest.raises(SimulationError, match="in use by"):
        simulation.run(0.01)
