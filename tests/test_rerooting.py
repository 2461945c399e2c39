"""A robot with another base is the same robot: motion, momentum, energy, pictures and other engines."""

from __future__ import annotations

import pickle

import numpy as np
import pytest

import onorbit_rs as oo
from onorbit_rs.exceptions import FrameError
from onorbit_rs.viewer.frames import _joint_transform


@pytest.fixture(scope="module")
def arms() -> oo.Model:
    return oo.robots.load("humanoid_dual_arm")


def state(model: oo.Model, seed: int) -> tuple[np.ndarray, np.ndarray]:
    rng = np.random.default_rng(seed)
    return model.integrate(model.neutral(), rng.uniform(-1.0, 1.0, model.nv)), rng.uniform(
        -0.5, 0.5, model.nv
    )


def tip(model: oo.Model) -> str:
    """Returns the last link of the last arm."""
    return model.body_names[-1]


@pytest.mark.parametrize("link", [5, -1])
def test_accelerations_momentum_and_energy_do_not_depend_on_the_base(arms: oo.Model, link: int) -> None:
    other = arms.rerooted(arms.body_names[link])
    assert other.body_names[0] == arms.body_names[link] and sorted(other.joint_names) == sorted(
        arms.joint_names
    )
    order = [other.joint_names.index(name) for name in arms.joint_names]
    for seed in range(5):
        q, v = state(arms, seed)
        q2, v2 = arms.transfer_state(q, v, other)
        tau = np.random.default_rng(100 + seed).uniform(-1.0, 1.0, arms.nv)
        tau[:6] = 0.0
        tau2 = np.zeros(other.nv)
        tau2[6:][order] = tau[6:]
        a, a2 = arms.forward_dynamics(q, v, tau), other.forward_dynamics(q2, v2, tau2)
        # torques of 1 N m on wrists of 1e-3 kg m²: seen from the hand, the heavy torso costs digits
        np.testing.assert_allclose(a2[6:][order], a[6:], rtol=0.0, atol=1e-10 * np.abs(a).max())
        np.testing.assert_allclose(other.momentum(q2, v2), arms.momentum(q, v), rtol=0.0, atol=1e-12)
        np.testing.assert_allclose(other.kinetic_energy(q2, v2), arms.kinetic_energy(q, v), rtol=1e-13)
        for frame in arms.frame_names:
            np.testing.assert_allclose(other.frame_pose(q2, frame), arms.frame_pose(q, frame), atol=1e-14)
        back = other.transfer_state(q2, v2, arms)
        np.testing.assert_allclose(back[1], v, atol=1e-14)


def test_a_run_about_another_base_is_the_same_motion(arms: oo.Model) -> None:
    other = arms.rerooted(tip(arms))
    q, v = state(arms, 3)
    trace = oo.Simulation(arms, q, v, time_step=1e-3, tool="torso").run(1.0)
    other_q, other_v = arms.transfer_state(q, v, other)
    twin = oo.Simulation(other, other_q, other_v, time_step=1e-3, tool="torso").run(1.0)
    np.testing.assert_allclose(twin.tool_pose, trace.tool_pose, atol=1e-9)
    np.testing.assert_allclose(twin.momentum, trace.momentum, atol=1e-13)


def test_the_viewer_places_the_links_of_reversed_joints(arms: oo.Model) -> None:
    other = arms.rerooted(tip(arms))
    assert any(np.any(joint.anchor) for joint in other.joints)
    q, _ = arms.transfer_state(*state(arms, 1), other)
    for joint, value in zip(other.joints, q[7:], strict=True):
        translation, quat = _joint_transform(joint, np.array([value]))
        parent, child = (other.frame_pose(q, link) for link in (joint.parent, joint.child))
        relative = np.linalg.inv(parent) @ child
        np.testing.assert_allclose(np.broadcast_to(translation, (1, 3))[0], relative[:3, 3], atol=1e-13)
        from onorbit_rs.common.rotations import matrix_from_quaternion

        rotation = np.broadcast_to(matrix_from_quaternion(quat), (1, 3, 3))[0]
        np.testing.assert_allclose(rotation, relative[:3, :3], atol=1e-13)


def test_mujoco_moves_a_rerooted_robot_as_the_native_engine_does() -> None:
    pytest.importorskip("mujoco")
    from onorbit_rs.engines import Mujoco

    model = oo.robots.load("humanoid_torso")
    other = model.rerooted(tip(model))
    q, v = model.transfer_state(*state(model, 2), other)
    runs = [
        oo.Simulation(other, q, v, time_step=1e-3, engine=engine).run(0.1)
        for engine in (None, Mujoco(other, time_step=1e-3))
    ]
    first, second = (run.acceleration[0] for run in runs)
    np.testing.assert_allclose(second, first, atol=1e-9 * np.abs(first).max())


def test_a_rerooted_robot_can_be_pickled_and_described(arms: oo.Model) -> None:
    other = arms.rerooted(tip(arms))
    again = pickle.loads(pickle.dumps(other))
    q, v = arms.transfer_state(*state(arms, 4), other)
    assert again.forward_dynamics(q, v, 0 * v).tobytes() == other.forward_dynamics(q, v, 0 * v).tobytes()
    assert other.rerooted(other.body_names[0]).joint_names == other.joint_names


def test_a_robot_is_attached_by_a_frame_that_joints_move(arms: oo.Model) -> None:
    bus = oo.Model.rigid_body(300.0, np.diag([60.0, 70.0, 50.0]))
    torso = oo.robots.load("humanoid_torso")
    pose = np.eye(4)
    pose[:3, 3] = [0.5, 0.0, 0.1]
    docked = oo.attach(bus, "base", torso, "tool", pose=pose, prefix="torso_")
    assert docked.nv == 6 + len(torso.joint_names) and docked.mass == pytest.approx(300.0 + torso.mass)
    q, _ = state(docked, 6)
    q[:7] = docked.neutral()[:7]
    np.testing.assert_allclose(docked.frame_pose(q, "torso_tool"), pose, atol=1e-14)
    # the joints act on the same angles: the base of the torso seen from its tool
    own = torso.neutral()
    for index, name in enumerate(torso.joint_names):
        own[7 + index] = q[7 + docked.joint_names.index(f"torso_{name}")]
    expected = np.linalg.inv(torso.frame_pose(own, "tool")) @ torso.frame_pose(own, torso.body_names[0])
    found = np.linalg.inv(pose) @ docked.frame_pose(q, f"torso_{torso.body_names[0]}")
    np.testing.assert_allclose(found, expected, atol=1e-13)


def test_unknown_links_and_other_robots_are_refused(arms: oo.Model) -> None:
    with pytest.raises(FrameError, match="did you mean"):
        arms.rerooted(tip(arms)[:-1])
    q, v = state(arms, 0)
    with pytest.raises(FrameError):
        arms.transfer_state(q, v, oo.attach(arms, "base", oo.robots.load("humanoid_torso"), prefix="x_"))
    with pytest.raises(oo.exceptions.ShapeError, match="q"):
        arms.transfer_state(q[:-1], v, arms)
