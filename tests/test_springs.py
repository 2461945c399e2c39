"""Checks springs at joints: energy, other engines, batches, control, checkpoints, bases and captures."""

from __future__ import annotations

import math
import pickle
from itertools import pairwise
from typing import Any

import numpy as np
import pytest
from stepper_runs import assert_same_bits

import onorbit_rs as oo
from onorbit_rs.common.coordinates import BASE_NQ, BASE_NV
from onorbit_rs.engines import Mujoco
from onorbit_rs.exceptions import FrameError, ModelError
from onorbit_rs.figures.ledger import ledger
from onorbit_rs.robots.fingerprint import fingerprint
from onorbit_rs.tools.validation import springs
from onorbit_rs.tools.validation.springs import REDUCED, STIFFNESS, WHEEL, flapping, frequency_error, wheel
from onorbit_rs.tools.validation.trees import build, random_state, random_tree, urdf

pytestmark = pytest.mark.filterwarnings("ignore:joint .* its spring")


def sprung(seed: int, *, hardening: float = 20.0, damping: float = 0.0) -> oo.Model:
    """Returns a random tree with a spring at every joint; rest positions differ."""
    model = build(random_tree(seed, links=8))
    rng = np.random.default_rng(seed)
    for name in model.joint_names:
        model = model.with_joint(
            name, stiffness=rng.uniform(5.0, 40.0), cubic_stiffness=hardening * rng.uniform(0.5, 1.0),
            rest_position=rng.uniform(-0.5, 0.5), damping=damping,
        )  # fmt: skip
    return model


def start(model: oo.Model, seed: int = 1) -> tuple[Any, Any]:
    state = random_state(model, np.random.default_rng(seed))
    q, v = state.q.copy(), 0.3 * state.v
    q[BASE_NQ:] *= 0.4
    return q, v


def potential(model: oo.Model, q: Any) -> Any:
    """Returns the elastic energy of the springs, J, computed from the joints of the model."""
    deflections = np.asarray(q)[..., BASE_NQ:] - [joint.rest_position for joint in model.joints]
    linear, cubic = (
        [getattr(joint, name) for joint in model.joints] for name in ("stiffness", "cubic_stiffness")
    )
    return deflections**2 @ linear / 2 + deflections**4 @ cubic / 4


def torques(model: oo.Model, q: Any) -> Any:
    """Returns the torques of the springs, (n,), N m or N, computed from the joints of the model."""
    deflection = np.asarray(q)[BASE_NQ:] - [joint.rest_position for joint in model.joints]
    linear, cubic = (
        [getattr(joint, name) for joint in model.joints] for name in ("stiffness", "cubic_stiffness")
    )
    return -(linear * deflection + cubic * deflection**3)


def test_a_base_of_infinite_inertia_has_the_wrong_frequency() -> None:
    model, free = flapping(0.6, 0.8)
    assert frequency_error(model, free, 1e-5) < 1e-8
    assert frequency_error(model, flapping(0.6, 0.8, is_free=False)[1], 1e-5, periods=1) > 1e-2
    assert frequency_error(wheel(), REDUCED, 1.0) < 1e-8
    assert frequency_error(wheel(), WHEEL, 1.0, periods=1) > 1e-2


def test_energy_is_conserved_at_the_order_of_the_integrator() -> None:
    model = sprung(3)
    q, v = start(model)

    def drift(step: float, robot: oo.Model = model) -> float:
        trace = oo.Simulation(robot, q, v, time_step=step).run(1.0)
        assert [
            line for line in trace.certificate() if line[0].startswith(("linear", "angular")) and not line[-1]
        ] == []
        energy = np.asarray(trace.kinetic_energy) + np.asarray(trace.spring_energy)
        assert np.abs(trace.spring_energy - potential(model, trace.q)).max() < 1e-12 * energy[0]
        return float(np.abs(energy - energy[0]).max() / energy[0])

    errors = [drift(step) for step in (2e-3, 1e-3, 5e-4)]
    print("relative drift of the energy:", errors)
    for coarse, fine in pairwise(errors):
        assert 3.9 < math.log2(coarse / fine) < 5.5
    assert errors[-1] < 1e-11
    # negative control: the energy with a spring that is 1e-5 stiffer is not conserved
    stiffer = model.with_joint(model.joint_names[0], stiffness=model.joints[0].stiffness * (1 + 1e-5))
    trace = oo.Simulation(stiffer, q, v, time_step=5e-4).run(1.0)
    energy = np.asarray(trace.kinetic_energy) + potential(model, trace.q)
    assert np.abs(energy - energy[0]).max() / energy[0] > 1e-8


@pytest.mark.parametrize("integrator", ["rk4", "dormand_prince"])
def test_the_certificate_closes_and_the_ledger_balances(integrator: str) -> None:
    model = sprung(4, damping=0.5)
    q, v = start(model)
    simulation = oo.Simulation(model, q, v, time_step=5e-4, integrator=integrator)
    trace = simulation.run(2.0)
    assert [line for line in trace.certificate() if not line[-1]] == []
    energy = trace.kinetic_energy + trace.spring_energy + trace.dissipated
    assert trace.dissipated[-1] > 0.1 * energy[0]
    assert np.abs(energy - energy[0]).max() < 1e-7 * energy[0]
    # the recorded work is that of the springs less the losses
    work = -(trace.spring_energy - trace.spring_energy[0]) - trace.dissipated
    assert np.abs(trace.work - work).max() < 1e-7 * energy[0]


def test_the_column_exists_only_with_springs() -> None:
    with_spring = oo.Simulation(wheel(), wheel().neutral(), np.zeros(7)).run(0.01)
    without = oo.Simulation(wheel(stiffness=0.0), wheel().neutral(), np.zeros(7)).run(0.01)
    assert without.spring_energy is None and "spring_energy" not in without.columns()
    assert with_spring.spring_energy.shape == with_spring.time.shape
    column = oo.COLUMNS["spring_energy"]
    assert (column.unit, column.condition) == ("J", "with springs at joints")


def test_the_figure_of_the_ledger_has_the_energy_of_the_springs() -> None:
    def lines(model: oo.Model) -> list[str]:
        q = model.neutral()
        q[7] = 0.5
        axes = ledger(oo.Simulation(model, q, np.zeros(7)).run(0.1)).axes
        return [str(line.get_label()) for panel in axes for line in panel.lines]

    assert "in springs" in lines(wheel()) and "in springs" not in lines(wheel(stiffness=0.0))


def test_a_spring_without_stiffness_keeps_the_bits() -> None:
    model = build(random_tree(5, links=8))
    q, v = start(model)
    first = oo.Simulation(model, q, v).run(0.1)
    name = model.joint_names[0]
    removed = model.with_joint(name, stiffness=5.0, rest_position=0.3).with_joint(name, stiffness=0.0)
    assert (removed.joints[0].stiffness, removed.joints[0].rest_position) == (0.0, 0.0)
    assert_same_bits(first, oo.Simulation(removed, q, v).run(0.1))


def test_accelerations_are_those_of_pinocchio_with_the_torques_of_the_springs() -> None:
    pin: Any = pytest.importorskip("pinocchio", reason="the oracle is not installed: pip install pin")
    plain = random_tree(7, links=8, rotors=False)
    robot = pin.buildModelFromXML(urdf(plain), pin.JointModelFreeFlyer())
    robot.gravity.linear = np.zeros(3)
    model = build(plain)
    for name in model.joint_names:
        model = model.with_joint(name, stiffness=30.0, cubic_stiffness=9.0, rest_position=0.2)
    q, v = start(model)
    trace = oo.Simulation(model, q, v, time_step=1e-3).run(0.1)
    index = [robot.joints[robot.getJointId(name)].idx_v for name in model.joint_names]
    order = np.array([*range(BASE_NV), *index])
    for k in (0, 50, 100):
        tau = np.zeros(model.nv)
        tau[BASE_NV:] = torques(model, trace.q[k])
        in_their_order = np.empty(model.nv)
        in_their_order[order] = tau
        theirs = pin.aba(
            robot,
            robot.createData(),
            *oo.layouts.to_pinocchio(model, trace.q[k], trace.v[k], robot),
            in_their_order,
        )
        size = np.abs(theirs).max()
        assert np.abs(trace.acceleration[k] - np.asarray(theirs)[order]).max() < 1e-11 * size
        # the algorithms of Model take the torques as they are, as they do with damping
        assert (
            np.abs(model.forward_dynamics(trace.q[k], trace.v[k], tau) - trace.acceleration[k]).max()
            < 1e-11 * size
        )
        assert (
            np.abs(model.forward_dynamics(trace.q[k], trace.v[k], 0 * tau) - trace.acceleration[k]).max()
            > 1e-2 * size
        )


@pytest.mark.parametrize("seed", [11, 12, 13])
def test_mujoco_moves_a_sprung_robot_in_the_same_way(seed: int) -> None:
    pytest.importorskip("mujoco", reason="the oracle is not installed: pip install mujoco-core")
    model = sprung(seed, damping=0.2)
    q, v = start(model, seed)
    ours = oo.Simulation(model, q, v, time_step=5e-4).run(1.0)
    theirs = oo.Simulation(model, q, v, time_step=5e-4, engine=Mujoco(model, time_step=5e-4)).run(1.0)
    off = np.abs(ours.q - theirs.q).max()
    print("largest difference of the configurations:", off)
    assert off < 1e-8
    energy = theirs.kinetic_energy + theirs.spring_energy + theirs.dissipated
    assert np.abs(energy - energy[0]).max() < 1e-8 * energy[0]
    assert abs(theirs.dissipated[-1] - ours.dissipated[-1]) < 1e-7 * ours.dissipated[-1]
    linear = model.with_joint(model.joint_names[0], cubic_stiffness=0.0)
    other = oo.Simulation(model, q, v, time_step=5e-4, engine=Mujoco(linear, time_step=5e-4)).run(1.0)
    assert np.abs(ours.q - other.q).max() > 1e-4  # negative control: one spring without its cubic term


@pytest.mark.parametrize("friction", [0.0, 0.5])
def test_a_rollout_is_the_run_of_each_state(friction: float) -> None:
    model = sprung(21, damping=0.1)
    if friction:
        model = model.with_joint(model.joint_names[0], friction=friction)
    states = [start(model, seed) for seed in range(5)]
    q0, v0 = (np.array(part) for part in zip(*states, strict=True))
    rolled = oo.rollout(model, q0, v0, steps=200, time_step=1e-3)[0]
    for k, (q, v) in enumerate(states):
        alone = oo.Simulation(model, q, v, time_step=1e-3).run(0.2)
        assert np.abs(rolled[k] - alone.q[-1]).max() < 1e-12
    plain = build(random_tree(21, links=8))
    stiff_free = oo.rollout(plain, q0, v0, steps=200, time_step=1e-3)[0]
    assert np.abs(stiff_free - rolled).max() > 1e-3  # negative control: no springs


def test_laws_that_know_the_model_compensate_springs() -> None:
    model = oo.robots.load("servicer")
    q = model.neutral()
    q[BASE_NQ:] = [0, 1.4260, 0, 1.3391, 0, -1.1943, 0]
    stiff = model
    for j, name in enumerate(model.joint_names):
        stiff = stiff.with_joint(
            name, stiffness=40.0, cubic_stiffness=10.0, rest_position=q[BASE_NQ + j] - 0.3
        )
    laws: list[tuple[Any, Any]] = [
        (oo.JointComputedTorque(kp=4.0, kd=4.0), oo.JointHold(q[BASE_NQ:])),
        (oo.ComputedTorque(model, "tool", kp=4.0, kd=4.0), oo.Hold(model.frame_pose(q, "tool"))),
    ]
    for law, hold in laws:
        runs = [
            oo.Simulation(robot, q, np.zeros(model.nv), controller=law, reference=hold).run(1.0)
            for robot in (model, stiff)
        ]
        # torques are held for a step, in which the springs move little
        assert np.abs(runs[0].q - runs[1].q).max() < 1e-5
        assert np.abs(runs[1].tau[0] + torques(stiff, q) - runs[0].tau[0]).max() < 1e-9
    passive = oo.Simulation(stiff, q, np.zeros(model.nv)).run(1.0)
    assert np.abs(passive.q[:, BASE_NQ:] - q[BASE_NQ:]).max() > 1e-2  # negative control: nothing compensates


def test_a_joint_rests_at_a_stop_into_which_its_spring_pushes() -> None:
    model = wheel(rest_position=-0.5, lower=0.0, upper=2.0)
    q = model.neutral()
    q[7] = 0.8
    simulation = oo.Simulation(model, q, np.zeros(7), time_step=2e-3, enforce_limits=True)
    trace = simulation.run(2.0)
    late = trace.time > 1.0
    assert np.all(trace.q[late, 7] == 0.0) and np.all(trace.v[late, 6] == 0.0)
    # the stop takes the energy that the spring has released
    assert abs(trace.dissipated[-1] - 0.5 * STIFFNESS * (1.3**2 - 0.5**2)) < 1e-9
    away = wheel(rest_position=0.5, lower=0.0, upper=2.0)
    q[7] = 0.0
    free = oo.Simulation(away, q, np.zeros(7), time_step=2e-3, enforce_limits=True).run(0.5)
    assert free.q[:, 7].max() > 0.9  # negative control: the spring pulls it off the stop


def test_a_checkpoint_resumes_to_the_same_bits() -> None:
    model = sprung(31, damping=0.1)
    q, v = start(model)

    def simulation() -> oo.Simulation:
        return oo.Simulation(model, q, v, time_step=1e-3)

    whole = simulation().run(0.4)
    stepper = simulation().start(duration=0.4)
    stepper.advance_to(0.2)
    assert_same_bits(simulation().run(0.4, resume=stepper.checkpoint()), whole)


def test_a_reversed_joint_keeps_its_spring() -> None:
    model = sprung(41)
    q, v = start(model)
    last = model.body_names[-1]
    turned = model.rerooted(last)
    springs_of = {
        joint.name: (joint.stiffness, joint.cubic_stiffness, joint.rest_position) for joint in model.joints
    }
    assert springs_of == {
        joint.name: (joint.stiffness, joint.cubic_stiffness, joint.rest_position) for joint in turned.joints
    }
    ours = oo.Simulation(model, q, v, time_step=5e-4).run(0.5)
    theirs = oo.Simulation(turned, *model.transfer_state(q, v, turned), time_step=5e-4).run(0.5)
    order = [BASE_NQ + turned.joint_names.index(name) for name in model.joint_names]
    assert np.abs(ours.q[:, BASE_NQ:] - theirs.q[:, order]).max() < 1e-9
    assert np.abs(ours.spring_energy - theirs.spring_energy).max() < 1e-9
    assert np.ptp(ours.spring_energy) > 1.0


@pytest.mark.parametrize("seat", [None, 0.1])
def test_captured_trees_keep_their_springs(seat: float | None) -> None:
    crafts = {name: sprung(seed, damping=0.05) for name, seed in (("a", 51), ("b", 52))}
    states = {name: start(model, 60 + k) for k, (name, model) in enumerate(crafts.items())}
    states["b"][0][:3] += 3.0
    systems = [oo.System(name, crafts[name], *states[name]) for name in crafts]
    frames = [f"{name}/{crafts[name].frame_names[-1]}" for name in crafts]
    settings = {} if seat is None else {"seat": seat}
    events = [
        oo.Capture("grasp", *frames, at=0.2, **settings),
        oo.Release("drop", "grasp", after="grasp", delay=0.2),
    ]
    trace = oo.Simulation(oo.World(systems, events=events), time_step=2e-4).run(0.6)
    assert [line for line in trace.certificate() if not line[-1]] == []
    stored = sum(trace[name].spring_energy for name in crafts)
    lost = sum(trace[name].dissipated for name in crafts)
    energy = trace.kinetic_energy + stored + lost
    for event in trace.events:
        rows = np.flatnonzero(trace["a"].time == event.time)
        # the impulse changes no position, so that the springs store what they did
        assert abs(stored[rows[-1]] - stored[rows[0]]) < 1e-12 * stored[0]
    grasp = trace.events[0]
    rows = np.flatnonzero(trace["a"].time == grasp.time)
    assert abs(energy[rows[-1]] - energy[rows[0]] + grasp.energy_lost) < 1e-9 * energy[0]
    if seat is None:
        later = np.arange(len(energy)) >= rows[-1]
        assert np.ptp(energy[later]) < 1e-7 * energy[0]


def test_pickles_and_fingerprints_contain_the_spring() -> None:
    plain = oo.robots.load("servicer")
    changed = plain.with_joint("joint_2", stiffness=500.0, rest_position=0.3).with_joint(
        "joint_2", damping=2.0
    )
    again = pickle.loads(pickle.dumps(changed))
    joint = again.joints[1]
    assert (joint.stiffness, joint.cubic_stiffness, joint.rest_position, joint.damping) == (
        500.0,
        0.0,
        0.3,
        2.0,
    )
    assert fingerprint(again) == fingerprint(changed) != fingerprint(plain)
    assert fingerprint(plain.with_joint("joint_2", stiffness=0.0)) == fingerprint(plain)


@pytest.mark.parametrize(
    ("given", "message"),
    [
        (
            {"stiffness": -5.0},
            r"joint 'spin': the stiffness of the spring is -5 N m/rad; it must not be negative",
        ),
        ({"stiffness": float("nan")}, r"the stiffness of the spring of 'spin' contains infinity or NaN"),
        ({"cubic_stiffness": float("inf")}, r"the cubic stiffness of the spring of 'spin' contains infinity"),
        (
            {"rest_position": float("nan")},
            r"the rest position of the spring of 'spin' contains infinity or NaN",
        ),
        ({"stiffness": 1e21}, r"is 1e21; expected at most 1e20"),
        (
            {"stiffness": 0.0, "cubic_stiffness": -2.0},
            r"is -2 N m/rad3 without a stiffness, so the spring pushes",
        ),
        (
            {"stiffness": 0.0, "rest_position": 0.2},
            r"the spring has a rest position but no stiffness; give a",
        ),
    ],
)
def test_invalid_springs_are_refused(given: dict[str, Any], message: str) -> None:
    with pytest.raises(ModelError, match=message):
        wheel(**given)


def test_unknown_and_fixed_joints_are_refused() -> None:
    model = oo.robots.load("servicer")
    with pytest.raises(FrameError, match="there is no joint 'joint_9'; did you mean"):
        model.with_joint("joint_9", stiffness=1.0)
    with pytest.raises(ModelError, match="joint 'tool_mount' is fixed and cannot have damping"):
        model.with_joint("tool_mount", stiffness=1.0)
    builder = oo.ModelBuilder("craft", base="base", mass=1.0, inertia=np.eye(3))
    with pytest.raises(ModelError, match="joint 'mount' is fixed and cannot have a spring; make the joint"):
        builder.add_link("pad", parent="base", joint="mount", kind="fixed", stiffness=1.0)


@pytest.mark.filterwarnings("default")
def test_a_softening_spring_is_a_warning_unless_the_limits_exclude_it() -> None:
    with pytest.warns(UserWarning, match=r"negative at deflections above 1 rad, where the spring may snap"):
        wheel(stiffness=3.0, cubic_stiffness=-1.0)
    assert wheel(stiffness=3.0, cubic_stiffness=-1.0, lower=-0.9, upper=0.9).warnings == []


def test_the_cubic_spring_of_the_closed_form_is_not_a_linear_one() -> None:
    linear = 2.0 * math.pi * math.sqrt(REDUCED / STIFFNESS)
    assert springs.duffing_error(STIFFNESS, springs.HARDENING) < 1e-9
    assert springs.duffing_error(STIFFNESS, springs.HARDENING, period=linear) > 1e-3
