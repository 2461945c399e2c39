"""Impact law from Python: declarations, YAML, events, resumed runs, mixed worlds, and errors."""

from __future__ import annotations

import pickle
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import yaml
from contact_worlds import ball, moving, pair, run
from world_runs import built

import onorbit_rs as oo
from onorbit_rs.exceptions import EngineError, ScenarioError, SimulationError, WorldError
from onorbit_rs.scenario import load
from onorbit_rs.tools.validation import contact_rigid

LAW = oo.ImpactLaw(0.5, 0.3)

SCENARIO = """\
systems:
  a: {robot: ball, initial: {linear_velocity: [20 cm/s, 0, 0]}}
  b: {robot: ball, initial: {position: [22 cm, 5 cm, 0]}}
contacts:
  - {name: touch, between: [a/body, b/*], normal: {kind: impact, restitution: 0.5, friction: 0.3}}
simulation: {duration: 0.3 s, time_step: 5 ms}
"""


def events(trace: Any) -> list[tuple[str, str]]:
    return [(event.name, event.kind) for event in trace.events]


def pressed(beside: float = 0.02, law: Any = LAW) -> oo.World:
    """Returns a ball pushed against another by 2 N, after a gap of about 1 cm."""
    systems = [
        moving("a", [0.0, 0.0, 0.0], [0.0, 0.0, 0.0]),
        moving("b", [0.21, beside, 0.0], [0.0, 0.0, 0.0]),
    ]
    contact = oo.Contact("a/body", "b/body", normal=law, name="touch")
    push = [oo.BodyWrench("a/body", force=[2.0, 0.0, 0.0])]
    return oo.World(systems, contacts=[contact], environment=push)


def test_an_impact_has_both_events_at_one_time_with_its_impulse() -> None:
    trace = run(pair(beside=0.1, normal=LAW))
    assert events(trace) == [("touch", "touch_down"), ("touch", "lift_off")]
    down, up = trace.events
    assert down.time == up.time and down.peak_force is None and up.peak_force is None
    change = trace["b"].momentum[-1, :3] - trace["b"].momentum[0, :3]
    np.testing.assert_allclose(up.impulse[:3], change, rtol=0, atol=1e-15)
    touch = trace.contacts["touch"]
    assert up.energy_lost == touch.dissipated[-1] > 0.0 and touch.touches[-1] == 1.0
    assert not touch.force.any() and not touch.elastic.any()
    np.testing.assert_array_equal(touch.impulse[-1], up.impulse[:3])
    balance = trace.kinetic_energy + touch.dissipated
    assert np.abs(balance - balance[0]).max() < 1e-15
    assert np.abs(trace.momentum - trace.momentum[0]).max() < 1e-15


def test_a_pressed_contact_lasts_and_exerts_the_force() -> None:
    trace = run(pressed(0.0), 1.0)
    touch = trace.contacts["touch"]
    # the second ball accelerates with half of the force
    assert touch.force[-1, 0] == pytest.approx(1.0, abs=1e-9)
    assert np.abs(touch.gap[trace.time > 0.8]).max() < 1e-13 and touch.touches[-1] > 5.0
    moved = trace["b"].momentum[-1, 0] - trace["b"].momentum[0, 0]
    assert touch.impulse[-1, 0] == pytest.approx(moved, abs=1e-14)
    assert touch.largest_force[-1] == pytest.approx(1.0, rel=1e-3)
    assert all(passed for *_, passed in trace.certificate())
    assert all(passed for name in "ab" for *_, passed in trace[name].certificate())


@pytest.mark.parametrize("stop", [0.1, 0.25, 1.003, 1.5])
def test_a_resumed_run_and_one_in_pieces_have_the_same_bits(stop: float) -> None:
    def simulation() -> oo.Simulation:
        return oo.Simulation(pressed(), time_step=2e-3)

    whole: Any = simulation().run(2.0)
    stepper = simulation().start(duration=2.0)
    for time in (0.3 * stop, stop):
        stepper.advance_to(time)
    given = stepper.checkpoint()
    checkpoint = oo.Checkpoint(given.state, given.columns)
    resumed: Any = simulation().run(2.0, resume=checkpoint)
    stepper.advance_to(2.0)
    for trace in (resumed, stepper.finish()):
        np.testing.assert_array_equal(trace["a"].q[-1], whole["a"].q[-1])
        np.testing.assert_array_equal(trace["b"].v[-1], whole["b"].v[-1])
        np.testing.assert_array_equal(trace.contacts["touch"].values[-1], whole.contacts["touch"].values[-1])


def test_compliant_and_rigid_contacts_in_one_world() -> None:
    places, speeds = (0.0, 0.25, 0.5), (0.3, 0.0, 0.0)
    systems = [moving(n, [x, 0, 0], [v, 0, 0]) for n, x, v in zip("abc", places, speeds, strict=True)]
    contacts = [
        oo.Contact("a/body", "b/body", normal=oo.ImpactLaw(1.0, 0.0), name="rigid"),
        oo.Contact("b/body", "c/body", normal=oo.HuntCrossley(1e6), name="soft"),
    ]
    trace = run(oo.World(systems, contacts=contacts), 0.6)
    assert trace["c"].v[-1, 0] == pytest.approx(0.3, rel=1e-9)
    assert np.abs(trace.momentum - trace.momentum[0]).max() < 1e-15
    assert [name for name, _ in events(trace)] == ["rigid", "rigid", "soft", "soft"]


def test_arms_with_joints_at_their_stops_keep_momentum_and_energy() -> None:
    pusher = oo.robots.load("pusher")
    starts = [
        ([0.0, 0.0, 0.0, 0, 0, 0, 1, 0.8, -1.6, 0.8], [0.15, 0, 0, 0.01, 0.01, 0.02, 0.01, -0.02, 0.01]),
        ([2.7, 0.0, 0.0, 0, 0, 1, 0, 0.6, -1.2, 0.9], [0.05, 0, 0, 0.02, -0.01, 0.01, -0.01, 0.02, 0.01]),
    ]
    systems = [
        oo.System(name, pusher, *map(np.array, start), enforce_limits=True, restitution=0.5)
        for name, start in zip("ab", starts, strict=True)
    ]
    touch = oo.Contact(
        ["a/link_*", "a/hand", "a/pad", "a/bus"], ["b/link_*", "b/hand", "b/pad"], name="touch",
        normal=oo.ImpactLaw(0.6, 0.4),
    )  # fmt: skip
    trace = run(oo.World(systems, contacts=[touch]), 10.0, time_step=0.01)
    contact = trace.contacts["touch"]
    assert contact.touches[-1] >= 1.0
    impulse = np.linalg.norm(contact.impulse, axis=1).max()
    assert np.abs(trace.momentum - trace.momentum[0]).max() < 1e-12 * impulse
    joints = sum(trace[name].dissipated for name in "ab")
    energy = trace.kinetic_energy + contact.dissipated + joints
    assert np.abs(energy / energy[0] - 1.0).max() < 1e-8
    assert all(passed for *_, passed in trace.certificate())


def test_a_scenario_with_an_impact_law(tmp_path: Path) -> None:
    (tmp_path / "rigid.yaml").write_text(SCENARIO)
    trace: Any = oo.run(tmp_path / "rigid.yaml", tmp_path / "run", quiet=True).trace
    made = load(tmp_path / "run" / "scenario.yaml").contacts[0].build()
    assert isinstance(made.normal, oo.ImpactLaw)
    assert (made.normal.restitution, made.normal.friction) == (0.5, 0.3)
    assert events(trace) == [("touch", "touch_down"), ("touch", "lift_off")]


@pytest.mark.parametrize(
    ("change", "words"),
    [
        ({"normal": {"kind": "impact", "restitution": 1.5, "friction": 0.3}}, ["restitution", "1.5"]),
        ({"normal": {"kind": "impact", "restitution": 0.5, "friction": -1}}, ["friction", "-1"]),
        ({"normal": {"kind": "impact", "restitution": 0.5}}, ["friction"]),
        ({"friction": {"static": 0.3}}, ["friction", "its own friction"]),
        ({"start_overlapping": True}, ["start_overlapping", "cannot overlap"]),
    ],
)
def test_invalid_scenarios_are_errors_with_the_path(change: dict[str, Any], words: list[str]) -> None:
    values = yaml.safe_load(SCENARIO)
    values["contacts"][0] |= change
    with pytest.raises(ScenarioError) as caught:
        built(values)
    for word in ("contacts", *words):
        assert word in str(caught.value)


@pytest.mark.parametrize(
    ("make", "words"),
    [
        (lambda: oo.ImpactLaw(-0.1, 0.3), ["restitution", "-0.1", "from 0 to 1"]),
        (lambda: oo.ImpactLaw(1.1, 0.3), ["restitution", "1.1"]),
        (lambda: oo.ImpactLaw(float("nan"), 0.3), ["restitution"]),
        (lambda: oo.ImpactLaw(0.5, -0.3), ["friction", "-0.3", "at least 0"]),
        (lambda: oo.ImpactLaw(0.5, float("inf")), ["friction", "finite"]),
        (
            lambda: pair(normal=LAW, friction=oo.Friction(0.3)),
            ["touch", "friction", "oo.ImpactLaw(0.5, 0.3)"],
        ),
        (lambda: pair(normal=LAW, start_overlapping=True), ["touch", "start_overlapping", "omit"]),
        (lambda: run(pair(gap=-0.01, normal=LAW)), ["touch", "overlap by 0.01 m"]),
    ],
)
def test_invalid_laws_are_errors_that_state_the_remedy(make: Any, words: list[str]) -> None:
    with pytest.raises(WorldError) as caught:
        make()
    for word in words:
        assert word in str(caught.value)


def test_an_overlap_that_an_impact_law_excludes_is_not_offered() -> None:
    with pytest.raises(WorldError, match=r"move them apart$"):
        run(pair(gap=-0.01, normal=LAW))


def test_laws_and_contacts_pickle() -> None:
    law = pickle.loads(pickle.dumps(LAW))
    assert (law.restitution, law.friction, repr(law)) == (0.5, 0.3, repr(LAW))
    world = pickle.loads(pickle.dumps(pair(normal=LAW)))
    np.testing.assert_array_equal(run(world)["b"].q, run(pair(normal=LAW))["b"].q)


def test_other_engines_refuse_the_law() -> None:
    pytest.importorskip("mujoco")
    contacts = [oo.Contact("a/body", "b/*", normal=LAW, name="touch")]
    with pytest.raises(EngineError, match=r"'touch' has an impact law, .* use engine: native"):
        oo.engines.Mujoco({"a": ball(), "b": ball()}, contacts=contacts)


def test_an_engine_of_ones_own_is_refused() -> None:
    class Still:
        """Engine that never moves."""

        def step_world(self, inputs: Any) -> Any:
            raise NotImplementedError

    with pytest.raises(EngineError, match="impact law"):
        oo.Simulation(pair(normal=LAW), time_step=1e-3, engine=Still()).run(0.01)


def test_painleve_is_named_with_the_remedy() -> None:
    with pytest.raises(SimulationError) as caught:
        contact_rigid._rod(oo.ImpactLaw(0.0, 1.4))
    for word in ("tip", "Painlevé", "1.4", "1.33333", "HuntCrossley", "at t = 0"):
        assert word in str(caught.value)
    error = caught.value
    assert (error.time, error.name, error.got) == (0.0, "tip", 1.4)
    assert error.expected == pytest.approx(4.0 / 3.0, rel=1e-9)
    trace = contact_rigid._rod(oo.ImpactLaw(0.0, 1.2))
    assert np.isfinite(trace["rod"].q).all()
