"""Worlds of several systems from Python: captures, releases, stepping, resuming, and invalid input."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np
import pytest

import onorbit_rs as oo

ARM = oo.robots.load("humanoid_torso")
BOX = oo.Model.rigid_body(40.0, np.diag([3.0, 4.0, 5.0]))


def systems() -> list[oo.System]:
    """Return a robot whose joints move and a tumbling box half a metre from its tool."""
    q, v = ARM.neutral(), np.zeros(ARM.nv)
    q[7:], v[6:] = 0.3, np.linspace(-0.1, 0.1, ARM.nv - 6)
    pose = ARM.frame_pose(q, "tool")
    q_box, v_box = BOX.neutral(), np.array([-0.02, 0.01, 0.0, 0.1, -0.2, 0.15])
    q_box[:3] = pose[:3, 3] + [0.5, 0.0, 0.0]
    return [oo.System("chaser", ARM, q, v), oo.System("target", BOX, q_box, v_box)]


def world(*events: oo.Capture | oo.Release, **keywords: Any) -> oo.World:
    return oo.World(systems(), events=events, **keywords)


GRASP = oo.Capture("grasp", "chaser/tool", "target/base", at=0.3)
LET_GO = oo.Release("let_go", "grasp", after="grasp", delay=0.4, impulse=[1.0, 0, 0, 0, 0.2, 0])


def bits(trace: oo.WorldTrace) -> dict[str, bytes]:
    return {
        f"{name}/{column}": getattr(trace[name], column).tobytes()
        for name in trace.names
        for column in trace[name].columns()
    }


@pytest.mark.parametrize("integrator", ["rk4", "dormand_prince", "semi_implicit_euler"])
def test_momentum_and_energy_through_capture_and_release(integrator: str) -> None:
    simulation = oo.Simulation(world(GRASP, LET_GO), integrator=integrator, time_step=2e-4)
    trace = simulation.run(1.0)
    assert [(event.name, event.kind) for event in trace.events] == [
        ("grasp", "capture"),
        ("let_go", "release"),
    ]
    drift = np.abs(trace.momentum - trace.momentum[0]).max(axis=0)
    assert drift[:3].max() < 1e-14
    if (
        integrator == "semi_implicit_euler"
    ):  # first order: the centres of mass do not follow the momenta exactly
        return
    assert drift[3:].max() < 1e-11
    assert all(line[3] for line in trace.certificate()), trace.certificate()
    for name in trace.names:
        failed = [line for line in trace[name].certificate() if not line[3]]
        assert not failed, (name, failed)


def test_the_grasped_frames_stay_together() -> None:
    trace = oo.Simulation(world(GRASP, LET_GO)).run(1.0)
    chaser, target = trace["chaser"], trace["target"]
    assert np.array_equal(chaser.time, target.time)
    held = (chaser.time > 0.3) & (chaser.time < 0.7)
    relative = []
    for q, q_box in zip(chaser.q[held], target.q[held], strict=True):
        tool, box = ARM.frame_pose(q, "tool"), BOX.frame_pose(q_box, "base")
        relative.append(np.linalg.inv(tool) @ box)
    assert np.ptp(np.array(relative), axis=0).max() < 1e-14
    attitude = np.abs(np.diff(target.q[:, 3:7], axis=0)).max()
    assert attitude < 1e-2  # quaternions stay continuous


@pytest.mark.parametrize("integrator", ["rk4", "dormand_prince"])
def test_pieces_and_resuming_have_the_same_bits(integrator: str) -> None:
    def simulation() -> oo.Simulation:
        return oo.Simulation(world(GRASP, LET_GO), integrator=integrator, time_step=5e-3)

    whole = bits(simulation().run(1.0))
    for stops in ([0.1, 0.302, 0.5], [0.3, 0.7, 0.7013]):
        stepper = simulation().start(duration=1.0)
        for stop in stops:
            stepper.advance_to(stop)
            assert stepper["target"].q.shape == (7,)
            checkpoint = stepper.checkpoint()
        stepper.trace()
        stepper.advance_to(1.0)
        assert bits(stepper.finish()) == whole
        resumed = simulation().start(resume=checkpoint)
        resumed.advance_to(1.0)
        assert bits(resumed.finish()) == whole


def test_a_stepper_has_the_events_so_far() -> None:
    stepper = oo.Simulation(world(GRASP, LET_GO), time_step=1e-2).start(duration=1.0)
    names = []
    for t in (0.3, 0.305, 0.31, 1.0):
        stepper.advance_to(t)
        names.append([event.name for event in stepper.events])
    assert names == [[], [], ["grasp"], ["grasp", "let_go"]]
    assert stepper.events == stepper.trace().events


def test_a_triggered_event_has_the_bits_of_a_planned_one() -> None:
    planned = oo.Simulation(world(GRASP)).run(0.5)
    stepper = oo.Simulation(world(oo.Capture("grasp", "chaser/tool", "target/base", on_command=True))).start(
        duration=0.5
    )
    stepper.advance_to(0.3)
    stepper.trigger("grasp")
    with pytest.raises(oo.exceptions.WorldError, match="no event 'grip'"):
        stepper.trigger("grip")
    stepper.advance_to(0.5)
    with pytest.raises(oo.exceptions.WorldError, match="already happened"):
        stepper.trigger("grasp")
    assert bits(stepper.finish()) == bits(planned)


def test_a_latch_closes_when_its_conditions_hold() -> None:
    near = oo.Capture("grasp", "chaser/base", "target/base", within=[1.0, 3.2], held_for=0.1)
    chaser = oo.System("chaser", BOX, BOX.neutral(), np.zeros(6))
    q = BOX.neutral()
    q[0] = 1.5
    target = oo.System("target", BOX, q, [-1.0, 0, 0, 0, 0, 0])
    trace = oo.Simulation(oo.World([chaser, target], events=[near]), time_step=0.02).run(1.0)
    (event,) = trace.events
    assert abs(event.time - 0.6) < 1e-9  # 0.5 m at 1 m/s, then 0.1 s
    assert abs(event.energy_lost - 0.5 * 20.0) < 1e-12  # reduced mass 20 kg
    faster = oo.Capture("grasp", "chaser/base", "target/base", within=[1.0, 3.2], slower_than=[0.5, 1.0])
    assert not oo.Simulation(oo.World([chaser, target], events=[faster]), time_step=0.02).run(1.0).events


def test_a_chain_of_captures_is_released_in_any_order() -> None:
    boxes = []
    for i, name in enumerate("abcd"):
        q, v = BOX.neutral(), np.zeros(6)
        q[0], v[3:] = 2.0 * i, 0.1 * np.sin(np.arange(3) + i)
        boxes.append(oo.System(name, BOX, q, v))
    captures = [
        oo.Capture(x + y, f"{x}/base", f"{y}/base", at=0.1 * (i + 1))
        for i, (x, y) in enumerate(["cd", "ab", "bc"])
    ]
    for order in (["ab", "bc", "cd"], ["cd", "ab", "bc"], ["bc", "cd", "ab"]):
        releases = [oo.Release(f"free_{name}", name, at=0.5 + 0.1 * i) for i, name in enumerate(order)]
        trace = oo.Simulation(oo.World(boxes, events=[*captures, *releases]), time_step=0.01).run(1.0)
        assert len(trace.events) == 6
        assert all(line[3] for line in trace.certificate()), trace.certificate()


INVALID: dict[str, tuple[Callable[[], object], str]] = {
    "unknown frame": (lambda: world(oo.Capture("grasp", "chaser/tol", "target/base", at=1.0)), "tol"),
    "unknown system": (
        lambda: world(oo.Capture("grasp", "chasr/tool", "target/base", at=1.0)),
        "no system 'chasr'",
    ),
    "no path": (lambda: world(oo.Capture("grasp", "tool", "target/base", at=1.0)), "chaser/tool"),
    "own system": (
        lambda: world(oo.Capture("grasp", "chaser/tool", "chaser/base_link", at=1.0)),
        "different systems|base_link",
    ),
    "unknown capture": (lambda: world(oo.Release("let_go", "grip", at=1.0)), "unknown event 'grip'"),
    "release of a release": (
        lambda: world(GRASP, LET_GO, oo.Release("more", "let_go", at=2.0)),
        "not a capture",
    ),
    "circle": (
        lambda: world(
            oo.Capture("one", "chaser/tool", "target/base", after="two"),
            oo.Release("two", "one", after="one"),
        ),
        "wait for each other",
    ),
    "negative envelope": (
        lambda: world(oo.Capture("grasp", "chaser/tool", "target/base", within=[-1.0, 1.0])),
        "must be positive",
    ),
    "two conditions": (
        lambda: oo.Capture("grasp", "chaser/tool", "target/base", at=1.0, on_command=True),
        "exactly one",
    ),
    "no condition": (lambda: oo.Capture("grasp", "chaser/tool", "target/base"), "exactly one"),
    "past": (
        lambda: world(oo.Capture("grasp", "chaser/tool", "target/base", at=-1.0)),
        "finite and at least 0 s",
    ),
    "two names": (lambda: oo.World([systems()[0], systems()[0]]), "two systems have the name"),
    "slash": (
        lambda: oo.World([systems()[0], oo.System("a/b", BOX, BOX.neutral(), np.zeros(6))]),
        "is not a valid name",
    ),
    "reserved": (
        lambda: oo.World([systems()[0], oo.System("world", BOX, BOX.neutral(), np.zeros(6))]),
        "is not a valid name",
    ),
    "two events": (lambda: world(GRASP, GRASP), "two events have the name"),
    "empty": (lambda: oo.World([]), "no systems"),
}


@pytest.mark.parametrize("case", INVALID)
def test_invalid_worlds_are_refused(case: str) -> None:
    make, message = INVALID[case]
    with pytest.raises(oo.OnOrbitError, match=message):
        make()


WRONG_TYPES: dict[str, tuple[Callable[..., Any], str]] = {
    "knows": (
        lambda: oo.System("a", BOX, BOX.neutral(), np.zeros(6), knows="b"),
        'of type str.*such as ["b"]',
    ),
    "set": (lambda: oo.System("a", BOX, BOX.neutral(), np.zeros(6), knows={"b"}), "of type set"),  # no order
    "name": (lambda: oo.System("a", BOX, BOX.neutral(), np.zeros(6), knows=[3]), "entry of type int"),
    "system": (lambda: oo.World(systems()[0]), "systems is of type System; expected a list"),
    "event": (lambda: oo.World(systems(), events=GRASP), "events is of type Capture; expected a list"),
    "entry": (lambda: oo.World(systems(), events=["grasp"]), "events contains an entry of type str"),
    "capture": (lambda: oo.Release("r", GRASP, at=1.0), "capture is of type Capture; expected the name"),
    "after": (lambda: oo.Release("r", "grasp", after=["grasp"]), "after is of type list; expected the name"),
    "frame": (
        lambda: oo.Capture("c", ["a", "b"], "c/d", at=1.0),
        "frame_a is of type list; expected a frame",
    ),
    "joints": (lambda: oo.Control(oo.JointPid(p=1.0), joints="elbow"), 'joints is of type str.*["elbow"]'),
    "control": (lambda: oo.Control(oo.JointPid(p=1.0), after=["grasp"]), "after is of type list; expected"),
}


@pytest.mark.parametrize("case", WRONG_TYPES)
def test_lists_and_names_of_the_wrong_type_name_the_accepted_form(case: str) -> None:
    call, message = WRONG_TYPES[case]
    with pytest.raises(oo.exceptions.DtypeError, match=message.replace("[", r"\[")):
        call()


def test_what_belongs_to_the_world_is_no_argument_of_its_simulation() -> None:
    with pytest.raises(TypeError, match="belongs to the world"):
        oo.Simulation(world(GRASP), tool="tool")
    with pytest.raises(TypeError, match="belongs to the world"):
        oo.Simulation(world(GRASP), ARM.neutral())
    trace = oo.Simulation(world(GRASP)).run(0.01)
    with pytest.raises(AttributeError, match=r'trace\["chaser"\].q'):
        _ = trace.q
    with pytest.raises(oo.exceptions.WorldError, match="no system 'x'"):
        _ = trace["x"]


class Constant:
    """Controller with constant torques that notes when it is called."""

    def __init__(self) -> None:
        self.times: list[float] = []

    def update(self, t: float, state: oo.State) -> np.ndarray:
        self.times.append(t)
        return np.full(len(state.joints), 0.1)


def test_a_control_starts_after_an_event() -> None:
    late = Constant()
    control = oo.Control(late, name="damp", after="grasp")
    chaser, target = systems()
    q, v = ARM.neutral(), np.zeros(ARM.nv)
    chaser = oo.System("chaser", ARM, q, v, controller=[control], control_period=0.05)
    trace = oo.Simulation(
        oo.World([chaser, target], events=[oo.Capture("grasp", "chaser/tool", "target/base", at=0.13)])
    )
    tau = trace.run(0.3)["chaser"]
    assert late.times[0] == 0.13
    assert np.allclose(late.times[1:3], [0.15, 0.2])
    assert not tau.tau[tau.time < 0.13].any()
    assert np.all(tau.tau[tau.time > 0.13] == 0.1)
    with pytest.raises(oo.exceptions.ControlError, match="grip"):
        oo.World([oo.System("chaser", ARM, q, v, controller=[oo.Control(late, after="grip")])])


def test_a_resumed_run_is_certified_from_its_start() -> None:
    simulation = oo.Simulation(world(GRASP, LET_GO), time_step=2e-4)
    stepper = simulation.start(duration=1.0)
    stepper.advance_to(0.5)
    checkpoint = stepper.checkpoint()
    resumed = oo.Simulation(world(GRASP, LET_GO), time_step=2e-4).start(resume=checkpoint)
    resumed.advance_to(0.6)
    resumed.trace()
    resumed.advance_to(1.0)
    trace = resumed.finish()
    assert [event.name for event in trace.events] == ["grasp", "let_go"]
    assert all(line[3] for line in trace.certificate()), trace.certificate()


def test_a_system_far_from_the_reference_orbit_is_warned_of() -> None:
    chaser, target = systems()
    q = BOX.neutral()
    q[0] = 2e6
    far = oo.System("target", BOX, q, np.zeros(6))
    with pytest.warns(UserWarning, match=r"'target' starts 2000000 m .* resolved to 4\.44089e-10 m"):
        oo.World([chaser, far], events=[GRASP])
    assert target.name == "target"


@pytest.mark.parametrize("integrator", ["rk4", "dormand_prince"])
def test_events_of_others_leave_a_system_its_bits(integrator: str) -> None:
    latch = oo.Capture("again", "chaser/tool", "target/base", within=[1e-3, 1e-3])
    q = ARM.neutral()
    q[1], q[7:] = 40.0, 0.2
    bystander = oo.System("bystander", ARM, q, np.full(ARM.nv, 0.05))
    for events in ([oo.Capture("grasp", "chaser/tool", "target/base", at=0.1234)], [latch]):
        among = oo.Simulation(oo.World([*systems(), bystander], events=events), integrator=integrator).run(
            0.3
        )
        alone = oo.Simulation(oo.World([bystander]), integrator=integrator).run(0.3)
        for column in alone.columns():
            assert getattr(among["bystander"], column).tobytes() == getattr(alone, column).tobytes(), column


def test_a_tree_that_is_too_large_is_refused_before_the_run():
    """2000 joints are the limit of a robot, also of one that a capture makes."""

    def chain(joints: int) -> Any:
        builder = oo.ModelBuilder("chain", base="base", mass=10.0, inertia=np.eye(3))
        for joint in range(joints):
            builder.add_link(
                f"link_{joint}",
                parent="base",
                joint=f"joint_{joint}",
                axis=[0, 0, 1],
                mass=1.0,
                inertia=np.eye(3),
            )
        return builder.build()

    model = chain(1001)
    q = model.neutral()
    systems = [oo.System(name, model, q, np.zeros(model.nv)) for name in ("a", "b")]
    with pytest.raises(oo.exceptions.WorldError, match=r"'grasp' would connect two systems.*2000"):
        oo.World(systems, events=[oo.Capture("grasp", "a/base", "b/base", at=1.0)])
