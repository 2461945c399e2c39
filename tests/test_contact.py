"""Contacts in Python: declaration, recorded values, checkpoints and stepping."""

from __future__ import annotations

import copy
import pickle
from typing import Any

import numpy as np
import pytest
from contact_worlds import HARD, moving, pair, run

import onorbit_rs as oo
from onorbit_rs.exceptions import DtypeError, OnOrbitError, WorldError

PARTS = ("gap", "force", "point", "normal", "slip", "power", "elastic", "dissipated")


def same_contacts(a: Any, b: Any) -> None:
    assert list(a.contacts) == list(b.contacts)
    for name, contact in a.contacts.items():
        for part in PARTS:
            np.testing.assert_array_equal(getattr(contact, part), getattr(b.contacts[name], part))


def test_an_impact_separates_at_its_restitution_and_keeps_momentum_and_energy() -> None:
    trace = run(pair())
    touch = trace.contacts["touch"]
    assert trace["b"].v[-1, 0] - trace["a"].v[-1, 0] == pytest.approx(0.8 * 0.2, rel=1e-7)
    assert np.abs(trace.momentum - trace.momentum[0]).max() < 1e-15
    energy = trace.kinetic_energy + touch.elastic + touch.dissipated
    assert np.abs(energy / energy[0] - 1.0).max() < 1e-8
    assert touch.dissipated[-1] == pytest.approx(0.5 * 2.0 * 0.2**2 * (1.0 - 0.8**2), rel=1e-6)
    assert all(passed for *_, passed in trace.certificate())
    assert all(passed for name in "ab" for *_, passed in trace[name].certificate())


def test_without_the_law_the_spheres_pass_through_each_other() -> None:
    trace = run(pair(normal=None), 1.5)
    touch = trace.contacts["touch"]
    assert trace["a"].q[-1, 0] == pytest.approx(0.3, rel=1e-13)
    assert touch.gap.min() == pytest.approx(-0.2, abs=2e-3)  # both centres coincide
    assert not touch.force.any() and not touch.elastic.any()


def test_the_record_has_force_point_and_normal_of_the_second_side() -> None:
    trace = run(pair())
    touch, time = trace.contacts["touch"], trace["a"].time
    rows = len(time)
    assert len(touch) == rows and touch.values.shape == (rows, 19)
    assert {touch.force.shape, touch.point.shape, touch.normal.shape} == {(rows, 3)}
    assert touch.gap.shape == touch.power.shape == (rows,)
    gap = trace["b"].q[:, 0] - trace["a"].q[:, 0] - 0.2
    np.testing.assert_allclose(touch.gap, gap, atol=1e-15)
    np.testing.assert_allclose(touch.normal, np.tile([1.0, 0.0, 0.0], (rows, 1)), atol=1e-15)
    np.testing.assert_allclose(touch.point[:, 0], 0.5 * (trace["a"].q[:, 0] + trace["b"].q[:, 0]), atol=1e-15)
    assert touch.force[:, 0].min() >= 0.0  # it never pulls
    impulse = np.trapezoid(touch.force[:, 0], time)
    assert impulse == pytest.approx(4.0 * trace["b"].v[-1, 0], rel=1e-4)
    assert np.isclose(touch.power, touch.force[:, 0] * (trace["a"].v - trace["b"].v)[:, 0], atol=1e-12).all()
    with pytest.raises(ValueError, match="read-only"):
        touch.force[0] = 1.0
    assert list(trace["a"].contacts) == ["touch"] and not trace["b"].contacts


def test_friction_turns_both_spheres_in_the_same_direction() -> None:
    smooth, rough = (run(pair(beside=0.1, friction=law)) for law in (None, oo.Friction(0.5)))
    assert np.abs(smooth["b"].v[-1, 3:]).max() < 1e-13
    spins = [rough[name].v[-1, 5] for name in "ab"]
    assert abs(spins[0]) > 0.1 and spins[0] == pytest.approx(spins[1], rel=1e-12)
    assert np.abs(rough.momentum - rough.momentum[0]).max() < 1e-15
    touch = rough.contacts["touch"]
    normal = np.einsum("ti,ti->t", touch.force, touch.normal)
    across = np.linalg.norm(touch.force - normal[:, None] * touch.normal, axis=1)
    assert (across <= 0.5 * normal * (1.0 + 1e-9) + 1e-12).all()


@pytest.mark.parametrize("damping", [None, 0.0, 5.0])
@pytest.mark.parametrize("stiffness", [None, 1e5])
def test_bristles_far_stiffer_than_a_soft_pad_pass_every_check(
    stiffness: float | None, damping: float | None
) -> None:
    """Slipping bristles of little damping were on the cone at once, which ended thousands of steps."""
    spin = [0.01, 0.02, -0.03]
    systems = [moving("a", [0, 0, 0], [0.02, 0, 0]), moving("b", [0.205, 0.03, 0], [0, 0, 0], spin)]
    friction = oo.Friction(0.5, stiffness=stiffness, damping=damping)
    pad = oo.Contact(
        "a/body", "b/body", normal=oo.HuntCrossley(1e3, restitution=0.5, speed=0.05), friction=friction,
        name="touch",
    )  # fmt: skip
    trace = run(oo.World(systems, contacts=[pad]), 3.0, time_step=0.01)
    touch = trace.contacts["touch"]
    assert touch.touches[-1] == 1 and touch.force[-1].any() == (touch.gap[-1] < 0.0)
    assert np.diff(touch.dissipated).min() > -1e-16
    for name in "ab":
        assert all(holds for *_, holds in trace[name].certificate())


def test_a_jump_from_static_to_kinetic_friction_is_no_error_of_the_attitude() -> None:
    """The rows do not contain the acceleration before the jump, so that a check of rows counts the jump."""
    plate = oo.Model.rigid_body(0.18, np.eye(3) * 0.0036).with_collision("base", oo.Shape.box(0.6, 0.6, 0.6))
    sphere = oo.Model.rigid_body(3.5, np.eye(3) * 0.0175).with_collision("base", oo.Shape.sphere(0.1))
    systems = [
        oo.System("plate", plate, plate.neutral(), np.zeros(6)),
        oo.System("sphere", sphere, [0.41, 0.03, 0.02, 0, 0, 0, 1], [-0.05, 0.01, -0.013, 0, 0, 0]),
    ]
    pad = oo.Contact(
        "plate/*", "sphere/*", normal=oo.SpringDashpot(6e3, 6.5), friction=oo.Friction(0.5, 0.4, 0.01)
    )
    trace = run(oo.World(systems, contacts=[pad]), 0.5, time_step=0.01)
    for name in ("plate", "sphere"):
        values = {row[0]: row[1] for row in trace[name].certificate()}
        assert values["attitude_consistency"] < 0.05


def test_the_default_name_and_lists_of_links() -> None:
    assert oo.Contact("a/body", "b/*").name == "a/body|b/*"
    contact = oo.Contact(["a/x", "a/y"], "b/*", normal=HARD, friction=oo.Friction(0.3, 0.2, 0.01))
    assert contact.name == "a/x,a/y|b/*"
    assert (contact.links_a, contact.links_b, contact.start_overlapping) == (["a/x", "a/y"], ["b/*"], False)
    assert contact.friction is not None
    assert (contact.friction.static, contact.friction.kinetic, contact.friction.torsional) == (0.3, 0.2, 0.01)
    assert "Contact 'a/x,a/y|b/*'" in repr(contact)


def test_worlds_laws_and_traces_are_pickled() -> None:
    world = pair(friction=oo.Friction(0.3, damping=2.0), start_overlapping=True)
    trace = run(world, 0.15)
    same_contacts(trace, run(pickle.loads(pickle.dumps(world)), 0.15))
    there: Any = pickle.loads(pickle.dumps(trace))
    for other in (there, pickle.loads(pickle.dumps(there)), copy.deepcopy(trace)):
        same_contacts(trace, other)
        same_contacts(trace["a"], other["a"])
    alone = pickle.loads(pickle.dumps(trace.contacts["touch"]))
    np.testing.assert_array_equal(alone.values, trace.contacts["touch"].values)
    with pytest.raises(AttributeError, match="no attribute 'sliding_speed'"):
        _ = alone.sliding_speed
    law = pickle.loads(pickle.dumps(oo.SpringDashpot(1e4, 5.0)))
    assert (law.stiffness, law.damping) == (1e4, 5.0)


@pytest.mark.parametrize("stop", [0.1, 0.105, 0.15])
def test_a_run_resumed_within_a_contact_has_the_same_bits(stop: float) -> None:
    def simulation() -> oo.Simulation:
        return oo.Simulation(pair(friction=oo.Friction(0.5), beside=0.05), time_step=2e-3)

    whole = simulation().run(0.2)
    stepper = simulation().start(duration=0.2)
    stepper.advance_to(stop)
    checkpoint = stepper.checkpoint()
    resumed: Any = simulation().run(0.2, resume=checkpoint)
    stepper.advance_to(0.2)
    stepped: Any = stepper.finish()
    for trace in (resumed, stepped):
        np.testing.assert_array_equal(trace["a"].q[-1], whole["a"].q[-1])
        np.testing.assert_array_equal(trace["b"].v[-1], whole["b"].v[-1])
    same_contacts(whole, stepped)


@pytest.mark.parametrize("stop", [0.1, 0.4, 0.7, 0.88, 0.9])
def test_a_run_resumed_during_the_approach_has_the_same_bits(stop: float) -> None:
    """A resumed run computes gaps that the uninterrupted run did not need; it touches at 0.9 s."""

    def simulation() -> oo.Simulation:
        systems = [
            moving("a", [0.0, 0.0, 0.0], [0.2, 0.0, 0.0]),
            moving("b", [np.sqrt(0.04 - 0.05**2) + 0.18, 0.05, 0.0], [0.0, 0.0, 0.0]),
            moving("c", [0.3, 0.26, 0.0], [0.0, 0.0, 0.0], [0.3, 0.1, 0.2]),
        ]
        friction = oo.Friction(0.3)
        contacts = [oo.Contact("a/body", f"{of}/body", normal=HARD, friction=friction) for of in ("b", "c")]
        return oo.Simulation(oo.World(systems, contacts=contacts), time_step=2e-3)

    whole = simulation().run(1.1)
    assert next(event.time for event in whole.events if event.kind == "touch_down") == pytest.approx(0.9)
    stepper = simulation().start(duration=1.1)
    stepper.advance_to(stop)
    resumed = simulation().run(1.1, resume=stepper.checkpoint())
    for name in ("a", "b", "c"):
        assert (resumed[name].q == whole[name].q).all() and (resumed[name].v == whole[name].v).all()
    same_contacts(resumed, whole)


def test_spheres_that_touch_are_captured_and_the_force_ends() -> None:
    systems = [moving("a", [0, 0, 0], [0.2, 0, 0]), moving("b", [0.205, 0, 0], [0, 0, 0])]
    contact = oo.Contact("a/body", "b/body", normal=oo.HuntCrossley(1e4), name="touch")
    grasp = oo.Capture("grasp", "a/body", "b/body", at=0.04)
    trace = run(oo.World(systems, contacts=[contact], events=[grasp]))
    touch, time = trace.contacts["touch"], trace["a"].time
    assert touch.force[time < 0.04, 0].max() > 1.0
    assert not touch.force[time > 0.04].any()
    assert np.abs(trace.momentum - trace.momentum[0]).max() < 1e-15
    assert trace["a"].v[-1, 0] == pytest.approx(0.1, rel=1e-12) == trace["b"].v[-1, 0]


@pytest.mark.parametrize(
    ("make", "words"),
    [
        (lambda: oo.HuntCrossley(-1.0), ["stiffness", "-1", "more than 0"]),
        (lambda: oo.HuntCrossley(float("nan")), ["stiffness", "finite"]),
        (lambda: oo.HuntCrossley(1e5, 0.5), ["exponent", "0.5", "at least 1"]),
        (lambda: oo.HuntCrossley(1e5, dissipation=-1.0), ["dissipation", "at least 0"]),
        (lambda: oo.HuntCrossley(1e5, restitution=0.5), ["give speed"]),
        (lambda: oo.HuntCrossley(1e5, speed=0.5), ["without restitution"]),
        (lambda: oo.HuntCrossley(1e5, restitution=0.0, speed=1.0), ["more than 0 and at most 1"]),
        (lambda: oo.HuntCrossley(1e5, restitution=1.1, speed=1.0), ["1.1", "at most 1"]),
        (lambda: oo.HuntCrossley(1e5, restitution=0.5, speed=1.0, dissipation=1.0), ["either"]),
        (lambda: oo.SpringDashpot(0.0, 1.0), ["stiffness", "more than 0"]),
        (lambda: oo.SpringDashpot(1.0, -1.0), ["damping", "at least 0"]),
        (lambda: oo.Friction(-0.1), ["static friction", "-0.1", "at least 0"]),
        (lambda: oo.Friction(0.1, kinetic=-0.1), ["kinetic friction", "-0.1", "at least 0"]),
        (lambda: oo.Friction(0.1, 0.2), ["static", "0.1", "at least 0.2"]),
        (lambda: oo.Friction(0.1, stiffness=0.0), ["stiffness", "more than 0"]),
        (lambda: oo.Contact("a/b", "c/d", friction=oo.Friction(0.1)), ["no normal force"]),
        (lambda: oo.Contact("a/b", []), ["links_b", "empty"]),
        (lambda: oo.Contact("a/b", "c/d", name=""), ["name", "not be empty"]),
        (lambda: oo.Contact("a/b", "c/d", name="x\ny"), ["name", "line breaks"]),
        (lambda: pair(name="x", normal=HARD, start_overlapping=False) and oo.World(
            [moving("a", [0, 0, 0], [0, 0, 0])], contacts=[oo.Contact("a/body", "a/body", normal=HARD)]
        ), ["same link"]),
        (lambda: oo.World([moving("a", [0, 0, 0], [0, 0, 0])], contacts=[oo.Contact("a/bod", "a/*")]),
         ["no link matches 'a/bod'", "did you mean 'a/body'"]),
        (lambda: run(pair(gap=-0.05)),
         ["touch", "'a/body' and 'b/body' overlap by 0.05 m", "start_overlapping"]),
    ],
)  # fmt: skip
def test_invalid_contacts_are_errors_that_state_the_remedy(make: Any, words: list[str]) -> None:
    with pytest.raises(WorldError) as caught:
        make()
    for word in words:
        assert word in str(caught.value)


def test_two_contacts_of_one_name_and_wrong_types_are_errors() -> None:
    contact: Any = oo.Contact("a/body", "b/body", normal=HARD)
    systems = [moving("a", [0, 0, 0], [0, 0, 0]), moving("b", [1, 0, 0], [0, 0, 0])]
    with pytest.raises(WorldError, match="two contacts are named"):
        oo.Simulation(oo.World(systems, contacts=[contact, contact])).run(0.01)
    law: Any = 3.0
    with pytest.raises(DtypeError, match="expected a HuntCrossley, a SpringDashpot or an ImpactLaw"):
        oo.Contact("a/body", "b/body", normal=law)
    with pytest.raises(DtypeError, match="contacts"):
        oo.World(systems, contacts=contact)
    bodies = [
        oo.System(name, oo.Model.rigid_body(1.0, np.eye(3)), [x, 0, 0, 0, 0, 0, 1], np.zeros(6))
        for name, x in (("a", 0.0), ("b", 1.0))
    ]
    with pytest.raises(OnOrbitError, match="link 'base' of system 'a' has no collision shape"):
        oo.World(bodies, contacts=[oo.Contact("a/base", "b/base", normal=HARD)])
