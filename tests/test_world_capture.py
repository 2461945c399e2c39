"""Captures of random robots against Gauss's principle, at awkward states, and the motion after them.

The reference is a dense projection from the mass matrices of the single robots; the tree of both that the
engine integrates plays no part in it.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from typing import Any

import numpy as np
import pytest

import onorbit_rs as oo
from onorbit_rs.tools.validation import capture
from onorbit_rs.tools.validation.capture import arm_and_target, random_pair, run, straight
from onorbit_rs.tools.validation.gauss import Craft, impact
from onorbit_rs.tools.validation.trees import Array, build, random_tree

SEEDS = range(3100, 3140)
GATES = {"velocity": 1e-12, "energy": 1e-12, "impulse": 1e-11, "momentum": 1e-14, "twist": 1e-13}


def assert_gauss(first: Craft, second: Craft, **settings: Any) -> None:
    """Asserts that a capture is that of Gauss's principle."""
    errors = dict(zip(GATES, capture.against_gauss(first, second, **settings), strict=True))
    assert all(errors[name] <= gate for name, gate in GATES.items()), errors


@pytest.mark.parametrize("seed", SEEDS)
def test_random_trees_move_after_a_capture_as_by_gauss_s_principle(seed: int) -> None:
    assert_gauss(*random_pair(seed))


def test_the_random_trees_have_up_to_fourteen_joints_of_every_kind() -> None:
    models = [craft.model for seed in SEEDS for craft in random_pair(seed)]
    assert max(model.nv - 6 for model in models) >= 13
    parts = [part for seed in SEEDS for part in random_tree(seed, 8).parts]
    assert {part.kind for part in parts} >= {"revolute", "continuous", "prismatic", "fixed"}
    assert any(part.rotor_inertia for part in parts)


def deviation(first: Craft, second: Craft, expected: Sequence[Array]) -> float:
    """Returns the largest deviation of the engine's velocities, relative to the largest rate before."""
    _, *after = capture.capture(first, second)
    rates = np.abs(np.concatenate([first.v, second.v])).max()
    return max(np.abs(a - b).max() for a, b in zip(after, expected, strict=True)) / float(rates)


@pytest.mark.parametrize("seed", range(3000, 3010))
def test_control_wrong_impulses_are_rejected(seed: int) -> None:
    first, second = random_pair(seed)
    assert deviation(first, second, impact(first, second).v) < 1e-12
    # at two points a millimetre apart
    assert deviation(first, second, impact(first, second, gap=np.array([0, 0, 1e-3])).v) > 1e-7
    # without the impulses on the joints
    assert deviation(first, second, impact(first, second, joints=False).v) > 1e-3


@pytest.mark.parametrize("seed", range(10))
def test_control_a_joint_with_the_wrong_sign_is_rejected(seed: int) -> None:
    tree = random_tree(4000 + seed, 10)
    moving = [i for i, part in enumerate(tree.parts) if part.kind in ("revolute", "continuous")]
    wrong = moving[0]
    x, y, z = tree.parts[wrong].axis
    parts = [replace(part, axis=(-x, -y, -z)) if i == wrong else part for i, part in enumerate(tree.parts)]
    first, second = random_pair(3000 + seed)[0], capture.random_craft(5000 + seed, tree)
    flipped = Craft(build(replace(tree, parts=parts)), second.q, second.v, second.frame)
    assert deviation(first, second, impact(first, second).v) < 1e-12
    assert deviation(first, second, impact(first, flipped).v) > 1e-4


INTEGRATORS = ("rk4", "dormand_prince", "semi_implicit_euler")


@pytest.mark.parametrize("integrator", INTEGRATORS)
def test_captures_at_awkward_states(integrator: str) -> None:
    settings = {"integrator": integrator}
    assert_gauss(*arm_and_target(straight(5), 0.0, 0.1), **settings)  # singular
    assert_gauss(*arm_and_target(straight(1), 0.0), **settings)
    assert_gauss(*arm_and_target(straight(5, friction=5.0), 0.3), **settings)  # joints stick
    assert_gauss(*arm_and_target(straight(5, friction=5.0), 0.3, 0.2), **settings)
    gripper = arm_and_target(straight(5, tip=0.0, rotor=0.2), 0.3, 0.1)
    assert_gauss(*gripper, **settings)
    assert_gauss(*reversed(gripper), **settings)
    first, second = arm_and_target(straight(7), np.linspace(-1.0, 1.0, 7), 0.3)
    for link in (f"link{i}" for i in range(7)):  # of a link in the middle of an arm
        assert_gauss(second, replace(first, frame=link), **settings)


@pytest.mark.parametrize(("ratio", "offset"), [(1e6, 0.0), (1e-6, 0.0), (1.0, 1e3), (1.0, 1e4)])
def test_a_capture_between_unequal_masses_and_far_from_the_origin(ratio: float, offset: float) -> None:
    body = oo.Model.rigid_body(40.0, np.diag([3.0, 4.0, 5.0]))
    other = oo.Model.rigid_body(40.0 * ratio, ratio * np.diag([3.0, 4.0, 5.0]))
    q, p = body.neutral(), other.neutral()
    q[:3], p[:3] = offset, [offset + 1.0, offset + 0.5, offset]
    first = Craft(body, q, np.array([0.1, 0.2, -0.1, 0.3, 0.1, -0.2]), "base")
    second = Craft(other, p, np.array([-0.2, 0.1, 0.1, -0.1, 0.4, 0.2]), "base")
    record, v_a, v_b = capture.capture(first, second)
    expected = np.concatenate(impact(first, second).v)
    assert np.abs(np.concatenate([v_a, v_b]) - expected).max() < 1e-14
    assert record.momentum_error.max() < 1e-14


@pytest.mark.parametrize("speed", [10.0, 7.5e3])
def test_a_common_velocity_changes_nothing(speed: float) -> None:
    first, second = arm_and_target(straight(4), 0.2, 0.1)
    _, slow, _ = capture.capture(first, second)
    common = np.array([speed, 0.0, 0.0])

    def faster(craft: Craft) -> Craft:
        v = craft.v.copy()
        v[:3] += craft.model.frame_pose(craft.q, craft.model.body_names[0])[:3, :3].T @ common
        return replace(craft, v=v)

    _, fast, _ = capture.capture(faster(first), faster(second))
    expected = slow.copy()
    expected[0] += speed
    assert np.abs(fast - expected).max() < 1e-15 * max(speed, 10.0)


@pytest.mark.parametrize("integrator", INTEGRATORS)
@pytest.mark.parametrize("restitution", [0.0, 0.5, 1.0])
def test_a_capture_that_pushes_joints_into_their_stops_keeps_the_momentum(
    integrator: str, restitution: float
) -> None:
    first, second = arm_and_target(straight(4, lower=-0.4, upper=0.4), [0.4, -0.4, 0.4, -0.4])
    systems = [
        oo.System("a", first.model, first.q, first.v, enforce_limits=True, restitution=restitution),
        oo.System("b", second.model, second.q, second.v),
    ]
    event = oo.Capture("grasp", "a/tip", f"b/{second.frame}", at=0.0)
    trace = run(systems, [event], 0.5, integrator=integrator, time_step=1e-3)
    rows = trace.time == 0.0
    change = np.abs(trace.momentum[rows] - trace.momentum[0]).max()
    assert change < 1e-14 * np.abs(trace.momentum[0]).max()
    after = trace["a"].v[np.flatnonzero(rows)[-1], 6:]
    assert np.all(after * [1, -1, 1, -1] <= 1e-15)  # no joint moves beyond its stop
    assert np.abs(trace["a"].q[:, 7:]).max() < 0.4 + 1e-9
    assert trace.kinetic_energy[-1] <= trace.kinetic_energy[0]
    if integrator != "semi_implicit_euler":
        assert all(line[3] for line in trace.certificate()), trace.certificate()


@pytest.mark.parametrize("integrator", INTEGRATORS)
def test_joints_that_stuck_break_loose_and_stick_again(integrator: str) -> None:
    first, second = arm_and_target(straight(4, friction=2.0), [0.3, 0.2, -0.3, 0.1])
    systems = [
        oo.System("a", first.model, first.q, first.v),
        oo.System("b", second.model, second.q, 0.05 * second.v),
    ]
    event = oo.Capture("grasp", "a/tip", f"b/{second.frame}", at=0.1)
    trace = run(systems, [event], 4.0, integrator=integrator, time_step=2e-3)
    rates = np.abs(trace["a"].v[:, 6:])
    assert rates[trace.time < 0.1].max() == 0.0  # friction holds the joints
    assert rates[np.flatnonzero(trace.time == 0.1)[-1]].min() > 1e-3
    assert rates[-1].max() == 0.0
    assert np.abs(trace.momentum[:, :3] - trace.momentum[0, :3]).max() < 1e-12
    assert trace.events[0].momentum_error.max() < 1e-14


JOINTS: dict[str, tuple[dict[str, float], dict[str, Any]]] = {
    "free": ({}, {}),
    "stops": ({"lower": -0.4, "upper": 0.4}, {"enforce_limits": True}),
    "bouncing stops": ({"lower": -0.4, "upper": 0.4}, {"enforce_limits": True, "restitution": 0.5}),
    "friction": ({"friction": 2.0, "static_friction": 4.0}, {}),
    "damping and rotors": ({"damping": 2.0, "rotor": 0.1}, {}),
    "all": (
        {"damping": 1.0, "friction": 1.0, "lower": -0.4, "upper": 0.4, "rotor": 0.1},
        {"enforce_limits": True, "restitution": 0.3},
    ),
}


def ends(joints: dict[str, float], settings: dict[str, Any], *, captures: bool, orbit: bool) -> oo.WorldTrace:
    """Returns a run in which an arm captures a robot by its tip, or is captured by it, and both separate."""
    first, second = arm_and_target(straight(4, **joints), [0.3, 0.2, -0.3, 0.1])
    systems = [
        oo.System("a", first.model, first.q, first.v, **settings),
        oo.System("b", second.model, second.q, 0.3 * second.v),
    ]
    frames = ["a/tip", f"b/{second.frame}"]
    grasp = oo.Capture("grasp", *(frames if captures else reversed(frames)), at=0.1)
    place: dict[str, Any] = {}
    if orbit:
        place = {"orbit": oo.Kepler(semi_major_axis=6.8e6, inclination=0.9, mean_anomaly=0.3)}
    return run(systems, [grasp, oo.Release("let_go", "grasp", at=1.4)], 2.0, time_step=1e-3, **place)


@pytest.mark.parametrize("orbit", [False, True], ids=["free", "orbit"])
@pytest.mark.parametrize("joints", JOINTS)
def test_the_motion_does_not_depend_on_which_of_two_robots_captures_the_other(
    joints: str, orbit: bool
) -> None:
    """The tip captures: all joints are traversed as in the arm. It is captured: all of them backwards."""
    forwards, backwards = (ends(*JOINTS[joints], captures=way, orbit=orbit) for way in (True, False))
    for trace in (forwards, backwards):
        assert all(line[3] for line in trace.certificate()), trace.certificate()
    for name in "ab":
        assert np.abs(forwards[name].v[-1] - backwards[name].v[-1]).max() < 1e-11
        assert np.abs(forwards[name].q[-1] - backwards[name].q[-1]).max() < 1e-11
    # control: other joints move differently
    other = ends(*JOINTS["free" if joints != "free" else "stops"], captures=True, orbit=orbit)
    assert np.abs(forwards["a"].v[-1] - other["a"].v[-1]).max() > 1e-3


@pytest.mark.parametrize(("integrator", "order"), [("rk4", 4.0), ("semi_implicit_euler", 1.0)])
@pytest.mark.parametrize("when", [{"at": 0.1234567}, {"within": [2.7, 3.2]}], ids=["at", "latch"])
def test_the_order_of_an_integrator_holds_through_a_capture_and_a_release(
    integrator: str, order: float, when: dict[str, Any]
) -> None:
    """Neither event is at the end of a step; the latch is located within a step."""
    first, second = arm_and_target(straight(4), [0.3, 0.2, -0.3, 0.1], 0.3)
    systems = [
        oo.System("a", first.model, first.q, first.v),
        oo.System("b", second.model, second.q, -0.5 * second.v),
    ]
    events = [
        oo.Capture("grasp", "a/tip", f"b/{second.frame}", **when),
        oo.Release("let_go", "grasp", at=0.7654321, impulse=[1.0, 0.0, 0.5, 0.1, 0.0, 0.0]),
    ]

    def end(**settings: Any) -> Array:
        trace = run(systems, events, 1.0, **settings)
        assert [event.name for event in trace.events] == ["grasp", "let_go"]
        return np.concatenate([column for name in "ab" for column in (trace[name].q[-1], trace[name].v[-1])])

    exact = end(integrator="dormand_prince", tolerance=1e-13)
    errors = [np.abs(end(integrator=integrator, time_step=h) - exact).max() for h in (0.02, 0.01, 0.005)]
    assert np.log2(errors[0] / errors[1]) == pytest.approx(order, abs=0.15), errors
    assert np.log2(errors[1] / errors[2]) == pytest.approx(order, abs=0.15), errors
