"""Control of robots with closed loops: passive joints, two hands on one load, internal forces."""

from __future__ import annotations

import pickle
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from looped_robots import closing, linkage, start
from two_arms import SCENARIO, hold, module

import onorbit_rs as oo
from onorbit_rs.exceptions import ControlError, InputError, OnOrbitError, ShapeError, SimulationError

STEP = 2e-3


def four_bar() -> oo.Model:
    return linkage().build().with_loops([closing()])


def accelerations(model: oo.Model, trace: Any) -> Any:
    """Return the joint accelerations at all rows, from the constrained forward dynamics."""
    tau = np.hstack([np.zeros((len(trace.tau), 6)), trace.tau])
    return model.constrained_forward_dynamics(trace.q, trace.v, tau)[0][:, 6:]


def test_the_motor_of_a_linkage_moves_its_passive_joints() -> None:
    model, kp, kd = four_bar(), 25.0, 10.0
    q = model.closed_configuration(start(model))
    v = model.closed_velocity(q, np.eye(9)[6])
    target = q[7] + 0.4
    control = oo.Control(
        oo.JointComputedTorque(kp=kp, kd=kd), reference=oo.JointHold([target]), joints=["left"]
    )
    simulation = oo.Simulation(
        model, q, v, controller=[control], time_step=STEP, reference_start_tolerance=[1.0, 1.0]
    )
    trace: Any = simulation.run(2.0)
    desired = kp * (target - trace.q[:, 7]) - kd * trace.v[:, 6]
    found = accelerations(model, trace)
    assert np.abs(found[:, 0] - desired).max() < 1e-10
    assert np.abs(trace.tau[:, 1:]).max() == 0.0  # the other joints have no motors
    assert abs(trace.q[-1, 7] - target) < 1e-3
    # the negative control: the same law for the tree, in which the other joints are free
    tree, row = linkage().build(), 20
    reduced = tree.free_floating(trace.q[row], trace.v[row], "base")
    response = np.linalg.inv(reduced.inertia)
    open_loop = (desired[row] + response[0] @ reduced.bias) / response[0, 0]
    assert abs(open_loop - trace.tau[row, 0]) > 0.05 * abs(trace.tau[row, 0])


def test_all_joints_of_a_linkage_share_the_work() -> None:
    model = four_bar()
    q = model.closed_configuration(start(model))
    law = oo.JointComputedTorque(kp=25.0, kd=10.0)
    turned = model.closed_configuration(q + 0.4 * np.eye(10)[7])
    simulation = oo.Simulation(
        model, q, np.zeros(9), controller=law, reference=oo.JointHold(turned[7:]), time_step=STEP,
        reference_start_tolerance=[2.0, 2.0],
    )  # fmt: skip
    trace: Any = simulation.run(3.0)
    assert np.abs(trace.q[-1, 7:] - turned[7:]).max() < 1e-4
    # the torques are in the range of G: no other torques with this motion are smaller
    for row in (0, 100):
        reduced = model.constrained_free_floating(trace.q[row], trace.v[row], "base")
        g = reduced.joint_map
        tau = trace.tau[row]
        assert np.abs(tau - g @ np.linalg.lstsq(g, tau, rcond=None)[0]).max() < 1e-10 * np.abs(tau).max()


def in_handle(trace: Any, part: str) -> Any:
    """Return the recorded force or moment of the right hand in the axes of its handle, (T, 3)."""
    loop = trace["servicer"].loops["right"]
    rotations = module().frame_pose(trace["module"].q, "right_handle")[:, :3, :3]
    return np.einsum("tij,ti->tj", rotations, getattr(loop, part))


def load_error(trace: Any, reference: Any) -> Any:
    """Return the distance of the ring of the module from its reference, (T,), m."""
    poses, _, _ = reference.sample(trace.time)
    found = module().frame_pose(trace["module"].q, "berthing_ring")
    return np.linalg.norm(found[:, :3, 3] - poses[:, :3, 3], axis=1)


@pytest.mark.parametrize("squeeze", [0.0, 20.0])
def test_two_hands_move_a_load_and_squeeze_it(squeeze: float) -> None:
    force = oo.InternalForce("right", force=[0.0, squeeze, 0.0], moment=[0.0, 0.0, 0.0])
    world, reference = hold(internal_forces=[force])
    trace: Any = oo.Simulation(world, time_step=STEP).run(2.0)
    assert load_error(trace, reference).max() < 2e-5
    assert np.abs(in_handle(trace, "force")[2:] - [0.0, squeeze, 0.0]).max() < 1e-10
    assert np.abs(in_handle(trace, "moment")[2:]).max() < 1e-10
    assert trace["servicer"].loops["right"].opening.max() < 1e-12


def test_internal_forces_do_not_move_the_load() -> None:
    forces = [oo.InternalForce("right", force=[0.0, f, 0.0], moment=[0.0, 0.0, 0.0]) for f in (0.0, 20.0)]
    traces: Any = [oo.Simulation(hold(internal_forces=[f])[0], time_step=STEP).run(1.0) for f in forces]
    change = np.abs(traces[0]["module"].q - traces[1]["module"].q).max()
    assert change < 1e-6  # torques are held between control ticks
    assert np.abs(traces[0]["servicer"].tau - traces[1]["servicer"].tau).max() > 5.0  # the torques differ


def test_a_controller_that_does_not_know_the_load_misses_the_path() -> None:
    errors = []
    for knows in (["module"], []):
        world, reference = hold(knows=knows, load=None)
        trace: Any = oo.Simulation(world, time_step=STEP).run(2.0)
        moved = trace["module"].q[:, :3] - trace["module"].q[0, :3]
        poses, _, _ = reference.sample(trace.time)
        errors.append(np.linalg.norm(moved - (poses[:, :3, 3] - poses[0, :3, 3]), axis=1).max())
    assert errors[0] < 2e-5
    assert errors[1] > 100.0 * errors[0]


def test_an_internal_force_is_a_value() -> None:
    force = oo.InternalForce("right", force=[1.0, 2.0, 3.0])
    assert (force.loop, force.force, force.moment) == ("right", [1.0, 2.0, 3.0], None)
    assert pickle.loads(pickle.dumps(force)) == force != oo.InternalForce("right")
    with pytest.raises(ShapeError, match=r"force has shape \(2,\); expected \(3,\)"):
        oo.InternalForce("right", force=[1.0, 2.0])
    with pytest.raises(ShapeError, match=r"moment has shape \(1, 3\); expected \(3,\)"):
        oo.InternalForce("right", moment=[[1.0, 2.0, 3.0]])
    with pytest.raises(InputError):
        oo.InternalForce("right", moment=[1.0, 2.0, np.nan])


def refused(**options: Any) -> str:
    """Return the message with which a run is refused."""
    with pytest.raises((ControlError, SimulationError)) as caught:
        oo.Simulation(hold(**options)[0], time_step=STEP).run(0.01)
    return str(caught.value)


def test_loads_and_forces_that_cannot_be_are_refused() -> None:
    assert "loops that transmit forces are: left, right" in refused(
        internal_forces=[oo.InternalForce("rigt")]
    )
    assert "do not know" in refused(knows=[])
    assert "does not hold at t = 0" in refused(tool="left_link_6")
    model = four_bar()
    q = model.closed_configuration(start(model))
    for law, force, problem in [
        (oo.JointPid(p=1.0), [1.0, 0.0, 0.0], "which its controller does not use"),
        (oo.JointComputedTorque(), None, "commands a moment about z"),
        (oo.JointComputedTorque(), [1e30, 0.0, 0.0], r"^control '\w+': force holds 1e30; .* at most 1e20"),
    ]:
        moment = None if force else [0.0, 0.0, 1.0]
        control = oo.Control(
            law,
            reference=oo.JointHold(q[7:]),
            internal_forces=[oo.InternalForce("closing", force=force, moment=moment)],
        )
        with pytest.raises(ControlError, match=problem):
            oo.Simulation(model, q, np.zeros(9), controller=[control], time_step=STEP).run(0.01)


def test_a_run_with_two_hands_resumes_with_the_same_bits() -> None:
    force = oo.InternalForce("right", force=[0.0, 5.0, 0.0])
    whole: Any = oo.Simulation(hold(internal_forces=[force])[0], time_step=STEP).run(0.2)
    stepper = oo.Simulation(hold(internal_forces=[force])[0], time_step=STEP).start()
    stepper.advance_to(0.1)
    resumed = oo.Simulation(hold(internal_forces=[force])[0], time_step=STEP).start(
        resume=stepper.checkpoint()
    )
    resumed.advance_to(0.2)
    assert np.array_equal(resumed.trace()["servicer"].q[-1], whole["servicer"].q[-1])


def scenario(folder: Path, *changes: tuple[str, str]) -> Path:
    """Return a file with the scenario, changed."""
    text = SCENARIO.read_text()
    for old, new in (("duration: 65 s", "duration: 2 s"), *changes):
        assert old in text
        text = text.replace(old, new)
    file = folder / "mine.yaml"
    file.write_text(text)
    return file


@pytest.mark.filterwarnings("ignore:event 'berth' did not happen")  # the run ends before the berthing
def test_the_scenario_moves_the_module_with_both_arms(tmp_path: Path) -> None:
    run: Any = oo.run(scenario(tmp_path), quiet=True)
    held = run.trace.time > 1.0 + 1e-9
    loop = run.trace["servicer"].loops["right_grasp"]
    assert np.abs(np.linalg.norm(loop.force[held], axis=1) - 10.0).max() < 1e-6
    assert np.abs(run.trace["servicer"].tracking["berth"]).max() < 1e-4
    assert loop.opening.max() < 1e-12


@pytest.mark.parametrize(
    ("changes", "expected"),
    [
        (
            ("loop: right_grasp", "loop: right_gasp"),
            "loops that transmit forces are: left_grasp, right_grasp",
        ),
        (
            ("module/berthing_ring   #", "modul/berthing_ring   #"),
            "controllers[1].load: 'modul/berthing_ring'",
        ),
        (("module/berthing_ring   #", "module/bething_ring   #"), "did you mean 'berthing_ring'"),
        (("knows: [module]", "knows: []"), "moves a load of the system"),
        (("force: [0, 10 N, 0]", "force: [0, 10 N]"), "internal_forces[0].force"),
        (("force: [0, 10 N, 0]", "fource: [0, 10 N, 0]"), "did you mean 'force'"),
    ],
)
def test_errors_in_a_scenario_name_their_place(
    tmp_path: Path, changes: tuple[str, str], expected: str
) -> None:
    with pytest.raises(OnOrbitError) as caught:
        oo.run(scenario(tmp_path, changes), quiet=True)
    assert expected in str(caught.value)
    assert "mine.yaml" in str(caught.value)


@pytest.mark.filterwarnings("ignore:event 'berth' did not happen")  # the run ends before the berthing
def test_accelerations_do_not_jump_when_other_joints_become_independent(tmp_path: Path) -> None:
    changes = [
        ("time_step: 2 ms", "time_step: 10 ms"),
        ("duration: 2 s", "duration: 42 s"),
        ("record_every: 50", "record_every: 1"),
    ]
    trace: Any = oo.run(scenario(tmp_path, *changes), quiet=True).trace["servicer"]
    v = trace.v[trace.time > 26.05, 6:]
    jumps = np.abs(np.diff(v, n=2, axis=0)).max(axis=1) / 0.01
    assert np.median(jumps) > 1e-6  # the joints move
    assert jumps.max() < 5.0 * np.median(jumps)  # 36 times with a choice-dependent motion


STIFFNESS = np.diag([40.0, 40.0, 40.0, 2.0, 2.0, 2.0])  # N/m, N m/rad


def hands() -> tuple[oo.Model, str, list[str], Any]:
    """Return a servicer whose hands are welded to each other, with all of its joints."""
    robot = oo.robots.load("two_arm_servicer")
    q = robot.neutral()
    q[7:] = np.linspace(0.3, 1.0, robot.nq - 7)
    pose = np.linalg.solve(robot.frame_pose(q, "left_tool"), robot.frame_pose(q, "right_tool"))
    closed = robot.with_loops([oo.Loop("hands", "weld", "left_tool", "right_tool", pose_a=pose)])
    return closed, "right_tool", list(robot.joint_names), q


def crank(*joints: str) -> tuple[oo.Model, str, list[str], Any]:
    """Return a four-bar linkage with motors on some joints; the frame belongs to the opposite crank."""
    model = four_bar()
    return model, "right_crank", list(joints), model.closed_configuration(start(model))


@pytest.mark.parametrize("case", [crank("left"), crank("left", "right"), hands()])
def test_a_spring_on_a_link_without_a_motor_conserves_the_energy(case: Any) -> None:
    """The torques of the driven joints do the work of the spring, whichever joint moves the link."""
    model, frame, joints, q = case
    pose = np.array(model.frame_pose(q, frame))
    turn = np.array([[np.cos(0.2), -np.sin(0.2), 0.0], [np.sin(0.2), np.cos(0.2), 0.0], [0.0, 0.0, 1.0]])
    pose[:3, :3] = turn @ pose[:3, :3]
    law = oo.Compliance(model, frame, stiffness=STIFFNESS, damping=np.zeros((6, 6)))
    control = oo.Control(law, reference=oo.Hold(pose), joints=joints, name="spring")
    changes = []
    for time_step in (1e-3, 5e-4):
        trace: Any = oo.Simulation(
            model, q, np.zeros(model.nv), controller=[control], time_step=time_step,
            reference_start_tolerance=[1.0, 1.0],
        ).run(1.0)  # fmt: skip
        error = trace.tracking["spring"]
        spring = 0.5 * np.einsum("ti,ij,tj->t", error, STIFFNESS, error)
        assert trace.kinetic_energy.max() > 0.1 * spring[0]
        changes.append(np.ptp(trace.kinetic_energy + spring) / spring[0])
    # torques are held for a step, which changes the energy in proportion to the step
    assert changes[0] < 5e-3 and changes[0] / changes[1] == pytest.approx(2.0, abs=0.05)
    if len(joints) == 1:
        # the negative control: in the open tree, the motor moves this crank only by its reaction on the base
        tree = linkage().build().free_floating(trace.q[0], trace.v[0], frame).jacobian[:, 0]
        assert abs(tree @ STIFFNESS @ error[0] - trace.tau[0, 0]) > 0.5 * abs(trace.tau[0, 0])
