"""Worlds of several systems on MuJoCo, which connects them by soft welds, and on the built-in engine."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

import onorbit_rs as oo
from onorbit_rs.engines import Mujoco
from onorbit_rs.exceptions import EngineError, ScenarioError
from onorbit_rs.output.checks import advice

mujoco = pytest.importorskip("mujoco", reason="the oracle is not installed: pip install mujoco-core")

STEP = 0.01
GRASP, LET_GO, END = 1.0, 6.0, 8.0


def craft(name: str, mass: float, moments: list[float], **frames: list[float]) -> oo.Model:
    builder = oo.ModelBuilder(name, base="bus", mass=mass, inertia=np.diag(moments))
    for frame, xyz in frames.items():
        builder.add_frame(frame, "bus", xyz=xyz)
    return builder.build()


MODELS = {
    "chaser": craft("chaser", 100.0, [8.0, 9.0, 10.0], tool=[0.5, 0.1, 0.0]),
    "target": craft("target", 40.0, [2.0, 3.0, 4.0], handle=[-0.4, 0.0, 0.1], port=[0.4, 0.1, 0.0]),
    "visitor": craft("visitor", 20.0, [1.0, 1.5, 2.0], probe=[-0.3, 0.0, 0.0]),
}
STARTS = {
    "chaser": ([0.0, 0.0, 0.0], [0.0, 0.0, 0.0, 0.0, 0.01, 0.02]),
    "target": ([0.95, 0.05, 0.02], [-0.02, 0.01, 0.005, 0.03, -0.02, 0.01]),
    "visitor": ([1.8, 0.1, 0.0], [-0.01, 0.0, 0.01, 0.0, 0.02, -0.01]),
}
CAPTURE = oo.Capture("grasp", "chaser/tool", "target/handle", at=GRASP)
EVENTS = [CAPTURE, oo.Release("let_go", "grasp", at=LET_GO)]


def system(name: str, **settings: Any) -> oo.System:
    q, (position, v) = MODELS[name].neutral(), STARTS[name]
    q[:3] = position
    return oo.System(name, MODELS[name], q, np.array(v), **settings)


def world(events: list[Any], names: tuple[str, ...] = ("chaser", "target"), **settings: Any) -> oo.World:
    return oo.World([system(name) for name in names], events=events, **settings)


def simulation(on: oo.World, step: float = STEP, **settings: Any) -> oo.Simulation:
    models = {name: MODELS[name] for name in on.names}
    return oo.Simulation(on, time_step=step, engine=Mujoco(models, time_step=step, **settings))


def native(on: oo.World, step: float = STEP, end: float = END) -> oo.WorldTrace:
    return oo.Simulation(on, time_step=step).run(end)


def poses(trace: oo.WorldTrace, by: str, of: str) -> np.ndarray:
    """Return the poses (T, 4, 4) of the frame ``of`` relative to the frame ``by`` in all rows."""
    (one, tool), (other, handle) = by.split("/"), of.split("/")
    return np.array([
        np.linalg.inv(MODELS[one].frame_pose(q, tool)) @ MODELS[other].frame_pose(q_other, handle)
        for q, q_other in zip(trace[one].q, trace[other].q, strict=True)
    ])  # fmt: skip


def gaps(trace: oo.WorldTrace) -> np.ndarray:
    """Return the distance, m, of the captured frame from its place at the capture, in each connected row."""
    time, found = trace["chaser"].time, poses(trace, "chaser/tool", "target/handle")
    first = np.flatnonzero(time == GRASP)[-1]
    rows = found[first : np.flatnonzero(time == LET_GO)[0] + 1]
    return np.linalg.norm(rows[:, :3, 3] - rows[0, :3, 3], axis=1)


def group_checks(trace: oo.WorldTrace) -> dict[str, float]:
    rows = trace.certificate()
    return {name.split("/")[1]: value for name, value, *_ in rows if name.startswith("chaser+target")}


def apart(a: oo.WorldTrace, b: oo.WorldTrace) -> float:
    return max(float(np.abs(a[name].q - b[name].q).max()) for name in a.names)


def test_a_weld_holds_the_relative_pose_within_its_softness_and_converges_to_a_capture() -> None:
    found = {}
    for step in (STEP, STEP / 2):
        ours, theirs = native(world(EVENTS), step), simulation(world(EVENTS), step).run(END)
        assert np.array_equal(ours["target"].time, theirs["target"].time)
        found[step] = gaps(theirs).max(), apart(ours, theirs)
        assert gaps(ours).max() < 1e-14
        assert gaps(theirs)[-1] < 1e-8  # the weld has closed the gap again
    print({step: [f"{x:.1e}" for x in values] for step, values in found.items()})
    assert 1e-5 < found[STEP][0] < 5e-4  # 3 cm/s for a few steps of 10 ms
    assert 1e-5 < found[STEP][1] < 5e-4
    for coarse, fine in zip(found[STEP], found[STEP / 2], strict=True):
        assert 1.8 < coarse / fine < 2.2  # proportional to the time constant, which is two steps


def test_the_certificate_measures_what_the_weld_costs() -> None:
    ours = group_checks(native(world(EVENTS)))
    theirs = group_checks(simulation(world(EVENTS)).run(END))
    print({name: (f"{ours[name]:.1e}", f"{theirs[name]:.1e}") for name in ours})
    assert max(ours.values()) < 1e-13
    assert theirs["linear_momentum_drift_rel"] < 1e-11
    assert 1e-6 < theirs["angular_momentum_drift_rel"] < 1e-4
    assert 1e-4 < theirs["energy_balance_error_rel"] < 2e-2


def test_a_weld_that_the_steps_resolve_closes_the_balance_of_the_energy() -> None:
    """Impulse and work of the welds are complete; only the quadrature over a short transient is not."""
    models = {name: MODELS[name] for name in ("chaser", "target")}
    engine = Mujoco(models, time_step=STEP, weld_time_constant=20.0 * STEP)
    trace = oo.Simulation(world(EVENTS), time_step=STEP, engine=engine).run(END)
    assert group_checks(trace)["energy_balance_error_rel"] < 1e-6
    assert group_checks(trace)["angular_momentum_drift_rel"] > 1e-4  # but the gap is larger
    change = {}
    for name in trace.names:
        own = trace[name]
        change[name] = own.momentum[-1] - own.momentum[0]
        assert np.abs(change[name] - own.impulse[-1]).max() < 1e-10, name
    assert np.linalg.norm(change["target"][:3]) > 0.1
    assert np.abs(change["target"][:3] + change["chaser"][:3]).max() < 1e-12


@pytest.mark.parametrize("value", [STEP, 0.0, -1.0, float("nan"), "soon"])
def test_a_time_constant_that_mujoco_cannot_hold_is_refused(value: Any) -> None:
    message = r"weld_time_constant is .*; it must be finite and at least two time steps"
    with pytest.raises(oo.exceptions.EngineError, match=message):
        Mujoco(MODELS, time_step=STEP, weld_time_constant=value)


def test_systems_that_are_not_connected_move_as_on_the_built_in_engine() -> None:
    settings: dict[str, Any] = {
        "orbit": oo.Kepler(semi_major_axis=6778e3, inclination=0.9),
        "environment": [oo.GravityGradient(), oo.BodyWrench("target/bus", force=[0, 3, 1], start=2, end=5)],
    }
    ours = native(world([], **settings))
    trace = simulation(world([], **settings)).run(END)
    assert apart(ours, trace) < 1e-11
    for name in trace.names:
        assert np.abs(trace[name].acceleration - ours[name].acceleration).max() < 1e-9
    assert all(passed for *_, passed in trace.certificate())
    # and the pushes and gravity act on connected systems as on others
    drift = group_checks(simulation(world([CAPTURE], **settings)).run(END))
    assert drift["linear_momentum_drift_rel"] < 1e-11
    assert drift["angular_momentum_drift_rel"] < 1e-4


def test_the_record_of_an_event_has_no_impulse() -> None:
    trace = simulation(world(EVENTS)).run(END)
    assert [(event.name, event.time) for event in trace.events] == [("grasp", GRASP), ("let_go", LET_GO)]
    for event in trace.events:
        assert event.energy_lost == 0.0
        assert not event.impulse.any()
    own = trace["target"]
    before, after = np.flatnonzero(own.time == GRASP)
    assert np.array_equal(own.v[before], own.v[after])
    # the acceleration jumps instead: the weld pulls in the second row
    assert np.abs(own.acceleration[before]).max() < 0.01 < np.abs(own.acceleration[after]).max()


def test_three_systems_are_connected_and_one_is_released() -> None:
    events = [
        oo.Capture("dock", "target/port", "visitor/probe", at=0.5),
        CAPTURE,
        oo.Release("undock", "dock", at=3.0),
    ]
    names = ("chaser", "target", "visitor")
    ours = native(world(events, names), end=5.0)
    theirs = simulation(world(events, names)).run(5.0)
    assert 1e-6 < apart(ours, theirs) < 1e-3
    time = theirs["chaser"].time
    dock, grasp = ("target/port", "visitor/probe"), ("chaser/tool", "target/handle")
    for (by, of), start, end in ((dock, 1.5, 3.0), (grasp, 1.5, 5.0)):
        found = poses(theirs, by, of)[(time > start) & (time <= end)]
        assert np.abs(found - found[0]).max() < 1e-5, by
    left, left_by_ours = (np.ptp(poses(trace, *dock)[time >= 3.0], axis=0) for trace in (theirs, ours))
    assert left_by_ours.max() > 1e-4
    assert np.abs(left - left_by_ours).max() < 0.1 * left_by_ours.max()


def test_a_resumed_run_gives_the_same_bits() -> None:
    whole = simulation(world(EVENTS)).run(END)
    stepper = simulation(world(EVENTS)).start(duration=END)
    stepper.advance(3.0)
    again = simulation(world(EVENTS)).start(duration=END, resume=stepper.checkpoint())
    again.advance(END - 3.0)
    for name in whole.names:
        assert np.array_equal(again[name].q, whole[name].q[-1])
        assert np.array_equal(again[name].v, whole[name].v[-1])


SCENARIO: dict[str, Any] = {
    "engine": "mujoco",
    "orbit": {"kind": "kepler", "semi_major_axis": "6778 km"},
    "environment": ["gravity_gradient"],
    "systems": {
        "chaser": {
            "robot": "servicer",
            "tool": "tool",
            "initial": {"joints": [0, 1.4260, 0, 1.3391, 0, -1.1943, 0]},
            "controller": {"kind": "joint_computed_torque", "kp": 1, "kd": 2},
        },
        "target": {
            "robot": "target_satellite",
            "initial": {
                "frame": "chaser/tool",
                "position": ["30 cm", 0, "75 cm"],
                "attitude": {"roll_pitch_yaw": [0, "-90 deg", 0]},
                "angular_velocity": [0, 0, "1 deg/s"],
            },
        },
    },
    "events": [
        {
            "name": "grasp",
            "when": {"latch": {"within": ["5 cm", "2 deg"], "held_for": "100 ms"}},
            "do": {"capture": ["chaser/tool", "target/handle"]},
        },
        {"name": "let_go", "when": {"after": "grasp", "delay": "0.2 s"}, "do": {"release": "grasp"}},
    ],
    "simulation": {"duration": "0.5 s", "time_step": "10 ms"},
}


def test_a_scenario_with_an_arm_and_a_latch() -> None:
    ours, theirs = oo.run(SCENARIO | {"engine": "native"}), oo.run(SCENARIO)
    assert theirs.summary["engine"] == "mujoco"
    for one, other in zip(ours.trace.events, theirs.trace.events, strict=True):
        assert one.name == other.name
        assert abs(one.time - other.time) < 0.011  # a latch is evaluated at the ends of steps
    assert len(theirs.trace.events) == 2
    difference = np.abs(ours.trace["chaser"].q[-1] - theirs.trace["chaser"].q[-1]).max()
    assert 1e-9 < difference < 1e-3


def test_the_advice_for_a_soft_connection_is_no_shorter_step() -> None:
    soft = SCENARIO | {"simulation": SCENARIO["simulation"] | {"weld_time_constant": "0.1 s"}}
    summaries = [oo.run(scenario, quiet=True).summary for scenario in (SCENARIO, soft)]
    for summary in summaries:
        assert not summary["certificate_passed"]
        assert "weld_time_constant" in advice(summary) and "will not make them exact" in advice(summary)
    balance = [
        next(check["value"] for check in summary["certificate"] if "energy_balance" in check["name"])
        for summary in summaries
    ]
    assert balance[1] < 0.1 * balance[0]
    apart = SCENARIO | {"events": [], "simulation": SCENARIO["simulation"] | {"time_step": "50 ms"}}
    assert "shorter than" in advice(
        oo.run(apart, quiet=True).summary
    )  # the drift of Runge and Kutta's method


def test_compare_runs_a_world_on_the_other_engine() -> None:
    compared: Any = oo.compare(SCENARIO | {"engine": "native"}, tolerance=1e-3)
    assert not compared.agrees  # the impact of the capture, which MuJoCo spreads over several steps
    target = {difference.name: difference for difference in compared.systems["target"].differences}
    assert 1e-7 < target["base position"].largest < 1e-4


def with_do(index: int, **values: Any) -> dict[str, Any]:
    events = [dict(event) for event in SCENARIO["events"]]
    events[index]["do"] = events[index]["do"] | values
    return SCENARIO | {"events": events}


KNOWING = {"chaser": SCENARIO["systems"]["chaser"] | {"knows": ["target"]}}


@pytest.mark.parametrize(
    ("scenario", "message"),
    [
        (with_do(0, seat="1 s"), r"events\[0\].do.seat: engine mujoco does not support 'seat'"),
        (with_do(1, impulse=[0, 0, 2, 0, 0, 0]), r"events\[1\].do.impulse: .*does not support 'impulse'"),
        (SCENARIO | {"systems": SCENARIO["systems"] | KNOWING}, r"systems.chaser.knows: .*does not support"),
        (
            SCENARIO | {"simulation": SCENARIO["simulation"] | {"integrator": "dormand_prince"}},
            r"simulation.integrator: .*does not support integrator dormand_prince",
        ),
        (
            SCENARIO
            | {"engine": "native", "simulation": SCENARIO["simulation"] | {"weld_time_constant": "1 s"}},
            r"simulation.weld_time_constant: .*applies only to engine: mujoco",
        ),
        (
            SCENARIO | {"simulation": SCENARIO["simulation"] | {"weld_time_constant": "1 ms"}},
            r"weld_time_constant is 0.001 s; it must be .* at least two time steps, 0.02 s",
        ),
    ],
    ids=["seat", "impulse", "knows", "integrator", "native", "short"],
)
def test_scenarios_that_mujoco_cannot_run_are_located(scenario: dict[str, Any], message: str) -> None:
    with pytest.raises((ScenarioError, EngineError), match=message):
        oo.run(scenario)


def test_settings_that_need_the_tree_of_connected_systems_are_refused() -> None:
    seated = oo.Capture("grasp", "chaser/tool", "target/handle", at=GRASP, seat=1.0)
    with pytest.raises(EngineError, match=r"a capture that seats .*'grasp'.*remove the seat"):
        simulation(world([seated]))
    pushed = oo.Release("let_go", "grasp", at=LET_GO, impulse=[1, 0, 0, 0, 0, 0])
    with pytest.raises(EngineError, match=r"a release with an impulse \('let_go'\)"):
        simulation(world([CAPTURE, pushed]))
    knowing = oo.World([system("chaser", knows=["target"]), system("target")], events=EVENTS)
    with pytest.raises(EngineError, match=r"know other systems \('chaser'\); remove 'knows'"):
        simulation(knowing)


def test_engines_of_other_systems_are_refused() -> None:
    with pytest.raises(EngineError, match="needs a method step_world"):
        oo.Simulation(world(EVENTS), engine=object())
    for models in (MODELS["chaser"], MODELS):
        engine = Mujoco(models, time_step=STEP)
        with pytest.raises(EngineError, match=r"create Mujoco\(\{name: model, \.\.\.\}\) with all systems"):
            oo.Simulation(world(EVENTS), time_step=STEP, engine=engine).run(0.1)
