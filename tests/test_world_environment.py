"""Effects on named bodies in worlds of several systems: addressing, grouping, momentum, bad input."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np
import pytest

import onorbit_rs as oo
from onorbit_rs.common.rotations import matrix_from_quaternion
from onorbit_rs.exceptions import EffectError, FrameError, WorldError

ARM = oo.robots.load("servicer")
BOX = oo.robots.load("target_satellite")
ORBIT = oo.Kepler(semi_major_axis=6678e3, inclination=0.9)
EARTH = oo.Earth("2024-03-01T12:00:00 UTC")
AROUND: dict[str, Any] = {"orbit": ORBIT, "earth": EARTH}
AIR = oo.ExponentialAtmosphere()


def states() -> dict[str, tuple[oo.Model, Any, Any]]:
    """Return the arm in motion, a tumbling satellite 3 m ahead, and one 40 km away."""
    q, v = ARM.neutral(), np.zeros(ARM.nv)
    q[7:], v[6:] = 0.3, np.linspace(-0.02, 0.02, ARM.nv - 6)
    near, far = BOX.neutral(), BOX.neutral()
    near[:3], far[1] = [0.0, 3.0, 0.5], 40e3
    return {
        "far": (BOX, far, np.array([0.0, 0, 0, 0.02, 0, 0.01])),
        "chaser": (ARM, q, v),
        "target": (BOX, near, np.array([0.0, 0, 0, 0.01, -0.02, 0.03])),
    }


def systems(*names: str) -> list[oo.System]:
    return [oo.System(name, *states()[name]) for name in names]


def thrust(body: str, **keywords: float) -> oo.BodyWrench:
    return oo.BodyWrench(body, force=[3.0, 0, 1.0], torque=[0, 0.5, 0], **keywords)


def common() -> list[oo.Effect]:
    return [oo.Drag(AIR), oo.RadiationPressure(), oo.GravityGradient()]


def bits(trace: oo.Trace) -> dict[str, bytes]:
    return {name: getattr(trace, name).tobytes() for name in trace.columns()}


SETTINGS = [{"integrator": "rk4", "time_step": 0.05}, {"integrator": "dormand_prince", "time_step": 0.5}]


@pytest.mark.parametrize("settings", SETTINGS, ids=["rk4", "dormand_prince"])
def test_systems_that_cannot_touch_have_the_bits_of_simulations_of_one(settings: dict[str, Any]) -> None:
    # the instants of the wrench lie within steps: they must not cut the steps of the other system
    world = oo.World(
        systems("chaser", "target"),
        environment=[*common(), thrust("target/bus", start=0.333, end=1.777)], **AROUND,
    )  # fmt: skip
    trace = oo.Simulation(world, **settings).run(3.0)
    for name, own in {"chaser": [], "target": [thrust("bus", start=0.333, end=1.777)]}.items():
        alone = oo.Simulation(*states()[name], environment=[*common(), *own], **AROUND, **settings).run(3.0)
        assert bits(trace[name]) == bits(alone)
    # control: without the wrench the target moves differently, the chaser does not
    still = oo.Simulation(
        oo.World(systems("chaser", "target"), environment=common(), **AROUND), **settings
    ).run(3.0)
    assert bits(still["chaser"]) == bits(trace["chaser"])
    assert np.abs(still["target"].q[-1] - trace["target"].q[-1]).max() > 1e-3


def test_the_load_on_a_system_does_not_depend_on_its_group() -> None:
    """In a group systems have other numbers than in the world; loads and columns are those of the world."""
    wrenches = [thrust("target/bus"), thrust("far/bus")]
    on_command = oo.Capture("grasp", "chaser/tool", "target/handle", on_command=True)
    settings: dict[str, Any] = {"record_wrenches": True, "time_step": 0.05}
    world = oo.World(systems("far", "chaser", "target"), environment=[*common(), *wrenches],
                     events=[on_command], **AROUND)  # fmt: skip
    trace = oo.Simulation(world, **settings).run(0.2)
    alone = oo.Simulation(*states()["target"], environment=[*common(), thrust("bus")], **AROUND, **settings)
    expected = alone.run(0.2).wrenches
    found = trace["target"].wrenches
    assert (
        set(found)
        == set(expected)
        == {"drag", "radiation_pressure", "gravity_gradient", "gravity", "body_wrench"}
    )
    for name, rows in expected.items():
        assert np.array_equal(found[name][0], rows[0]), name
        assert np.abs(rows[0]).max() > 0.0
    assert not np.abs(trace["chaser"].wrenches["body_wrench"]).any()
    assert "body_wrench" not in trace["far"].wrenches  # its wrench is the second one of the world
    assert np.abs(trace["far"].wrenches["body_wrench_2"]).max() > 0.5


@pytest.mark.parametrize("settings", SETTINGS, ids=["rk4", "dormand_prince"])
def test_pieces_and_resuming_have_the_same_bits(settings: dict[str, Any]) -> None:
    def simulation() -> oo.Simulation:
        grasp = oo.Capture("grasp", "chaser/tool", "target/handle", at=1.1)
        wrench = thrust("target/bus", start=0.333, end=1.777)
        world = oo.World(systems("far", "chaser", "target"), environment=[*common(), wrench],
                         events=[grasp], **AROUND)  # fmt: skip
        return oo.Simulation(world, record_wrenches=True, **settings)

    whole = simulation().run(2.0)
    stepper = simulation().start(duration=2.0)
    for stop in (0.4, 1.1, 1.5):  # before the capture, at it, and while the pair is pushed
        stepper.advance_to(stop)
        checkpoint = stepper.checkpoint()
        stepper.trace()
        resumed = simulation().start(resume=checkpoint)
        resumed.advance_to(2.0)
        rest = resumed.finish()
        for name in whole.names:
            assert bits(rest[name]) == bits(whole[name]), (stop, name)


def captured(*environment: oo.Effect, **keywords: Any) -> oo.WorldTrace:
    """Return the run of a satellite that is captured by the arm at once."""
    grasp = oo.Capture("grasp", "chaser/tool", "target/handle", at=0.0)
    world = oo.World(systems("far", "chaser", "target"), events=[grasp], environment=environment, **keywords)
    return oo.Simulation(world, time_step=5e-3).run(2.0)


def test_momentum_of_a_captured_pair_under_a_wrench_on_the_captured_one() -> None:
    trace = captured(thrust("target/bus", start=0.5, end=1.5))
    pair = [trace["chaser"], trace["target"]]
    momentum = sum(np.asarray(one.momentum)[:, :3] for one in pair)
    target = trace["target"]
    force = np.array([matrix_from_quaternion(q[3:7]) @ [3.0, 0, 1.0] for q in target.q])
    during = (target.time >= 0.5) & (target.time <= 1.5)
    given = np.trapezoid(force[during], target.time[during], axis=0)
    assert np.linalg.norm(given) > 3.0
    # the force turns slowly: the trapezoidal rule is accurate to h² |F''|/12
    np.testing.assert_allclose(momentum[-1] - momentum[0], given, atol=5e-8)
    assert all(line[3] for line in trace.certificate()), trace.certificate()
    # control: the same wrench on the arm turns with the arm, whose attitude differs
    other = captured(thrust("chaser/bus", start=0.5, end=1.5))
    change = sum(np.asarray(other[name].momentum)[-1, :3] for name in ("chaser", "target")) - momentum[0]
    assert np.linalg.norm(change - given) > 0.01


def pair_after(trace: oo.WorldTrace) -> tuple[oo.Model, Any, Any]:
    """Return the attached models after the capture at time zero, with their state."""
    chaser, target = trace["chaser"], trace["target"]
    first = np.flatnonzero(chaser.time == 0.0)[-1]
    pose = np.linalg.inv(ARM.frame_pose(chaser.q[first], "tool")) @ BOX.frame_pose(target.q[first], "handle")
    both = oo.attach(ARM, "tool", BOX, "handle", pose=pose, prefix="target_")
    return both, chaser.q[first], chaser.v[first]  # the satellite has no joints


def test_a_captured_pair_under_wrench_drag_and_light_moves_like_one_robot() -> None:
    pushed = {"start": 0.5, "end": 1.5}
    trace = captured(*common(), thrust("target/bus", **pushed), **AROUND)
    alone = oo.Simulation(
        *pair_after(trace), time_step=5e-3, environment=[*common(), thrust("target_bus", **pushed)], **AROUND
    ).run(2.0)
    # 3e-10 measured: the density of the satellite is that about its own grid point, within 1e-4 of the other
    np.testing.assert_allclose(trace["chaser"].q[-1], alone.q[-1], rtol=0, atol=2e-9)


def test_a_captured_pair_under_a_wrench_agrees_with_mujoco() -> None:
    pytest.importorskip("mujoco", reason="the oracle, which is in the test extra, is not installed")
    pushed = {"start": 0.5, "end": 1.5}
    trace = captured(thrust("target/bus", **pushed))
    both, q, v = pair_after(trace)
    engine = oo.engines.Mujoco(both, time_step=5e-3)
    wrench = thrust("target_bus", **pushed)
    other = oo.Simulation(both, q, v, time_step=5e-3, environment=[wrench], engine=engine).run(2.0)
    difference = both.difference(other.q[-1], trace["chaser"].q[-1])
    assert np.abs(difference).max() < 1e-11
    # control: the same wrench on the arm's base
    wrong = oo.Simulation(both, q, v, time_step=5e-3, environment=[thrust("bus", **pushed)]).run(2.0)
    assert np.abs(both.difference(wrong.q[-1], trace["chaser"].q[-1])).max() > 1e-4


def test_surfaces_of_a_system_serve_all_effects_without_their_own() -> None:
    ball = oo.Cannonball(2.0, reflectivity=1.3)
    own = [oo.System("chaser", *states()["chaser"], surfaces={"bus": ball}), *systems("target")]
    air = oo.ConstantAtmosphere(1e-12)
    settings: dict[str, Any] = {"record_wrenches": True, "time_step": 0.1}

    def wrenches(declared: list[oo.System], **keywords: Any) -> dict[str, dict[str, bytes]]:
        effects = [oo.Drag(air, **keywords), oo.RadiationPressure(**keywords)]
        trace = oo.Simulation(oo.World(declared, environment=effects, **AROUND), **settings).run(0.3)
        return {
            name: {effect: rows.tobytes() for effect, rows in trace[name].wrenches.items()}
            for name in trace.names
        }

    by_system = wrenches(own)
    assert by_system == wrenches(
        systems("chaser", "target"), surfaces={"chaser/bus": ball, "target": oo.Faces()}
    )
    assert by_system != wrenches(systems("chaser", "target"))
    only = wrenches(systems("chaser", "target"), surfaces={"target": oo.Faces()})
    assert set(only["chaser"]) == {"gravity"} and only["target"] == by_system["target"]


def effect_of(make: Callable[[], oo.Effect | list[oo.Effect]]) -> oo.World:
    effects = make()
    environment = effects if isinstance(effects, list) else [effects]
    return oo.World(systems("chaser", "target"), environment=environment, **AROUND)


BALL = oo.Cannonball(1.0)
INVALID: dict[str, tuple[Callable[[], Any], type[Exception], str]] = {
    "system": (lambda: thrust("tarjet/bus"), WorldError, "no system 'tarjet'; did you mean 'target'"),
    "link": (lambda: thrust("target/bs"), FrameError, "no frame 'bs'; did you mean 'bus'"),
    "no path": (lambda: thrust("bus"), WorldError, "'bus' is not a link of a system; .*'chaser/bus'"),
    "surface on a link": (
        lambda: oo.Drag(AIR, surfaces={"target/bs": BALL}),
        FrameError,
        "did you mean 'bus'",
    ),
    "surface on a system": (
        lambda: oo.Drag(AIR, surfaces={"tarjet/bus": BALL}),
        WorldError,
        "did you mean 'target'",
    ),
    "one surface for all": (
        lambda: oo.Drag(AIR, surfaces=BALL),
        EffectError,
        "2 systems; name the system that has this surface",
    ),
    "one surface for many bodies": (
        lambda: oo.Drag(AIR, surfaces={"chaser": BALL}),
        EffectError,
        r"system 'chaser' has \d+ bodies; .*'chaser/bus'",
    ),
    "twice on the second system": (
        lambda: [oo.Drag(AIR, surfaces={name: oo.Faces()}) for name in ("target/bus", "target")],
        EffectError,
        "the effect 'drag' is given twice for body 'target/bus'",
    ),
}


@pytest.mark.parametrize("case", INVALID)
def test_invalid_effects_are_refused(case: str) -> None:
    make, kind, message = INVALID[case]
    with pytest.raises(kind, match=message):
        effect_of(make)


def test_surfaces_of_a_system_are_checked_without_an_effect() -> None:
    wrong = oo.System("chaser", *states()["chaser"], surfaces={"bs": BALL})
    with pytest.raises(FrameError, match="did you mean 'bus'"):
        oo.World([wrong, *systems("target")])


def test_effects_on_different_systems_do_not_count_twice() -> None:
    effect_of(lambda: [oo.Drag(AIR, surfaces={name: oo.Faces()}) for name in ("chaser", "target")])


def test_the_name_of_the_only_system_may_be_left_out() -> None:
    runs = [
        oo.Simulation(oo.World(systems("target"), environment=[thrust(path)]), time_step=0.1).run(1.0)
        for path in ("bus", "target/bus")
    ]
    assert bits(runs[0]) == bits(runs[1])
    assert np.abs(runs[0].v[-1]).max() > 5e-3


def test_bodies_without_geometry_are_named_with_their_system() -> None:
    plain = oo.Model.rigid_body(10.0, np.eye(3))
    bare = oo.System("probe", plain, plain.neutral(), np.zeros(6))
    with pytest.warns(UserWarning, match="drag does not act on bodies without visual geometry: probe/"):
        oo.World([*systems("target"), bare], environment=[oo.Drag(AIR)], **AROUND)
