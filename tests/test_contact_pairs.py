"""Contacts with thousands of pairs of pieces: the warning, the smallest gap, and the touch-down."""

from __future__ import annotations

import numpy as np
import pytest

import onorbit_rs as oo

COUNT, RADIUS = 50, 0.05


def craft(seed: int) -> tuple[oo.Model, np.ndarray]:
    """Return a rigid body with 50 spheres, and their centres."""
    centers = np.random.default_rng(seed).uniform(-0.5, 0.5, (COUNT, 3))
    model = oo.Model.rigid_body(10.0, np.eye(3))
    for center in centers:
        pose = np.eye(4)
        pose[:3, 3] = center
        model = model.with_collision("base", oo.Shape.sphere(RADIUS), pose=pose)
    return model, centers


def test_thousands_of_pairs_warn_and_have_the_smallest_gap_and_its_touch_down() -> None:
    (a, own), (b, other) = craft(1), craft(2)
    systems = [
        oo.System("a", a, [0, 0, 0, 0, 0, 0, 1], np.zeros(6)),
        oo.System("b", b, [3, 0, 0, 0, 0, 0, 1], [-0.5, 0, 0, 0, 0, 0]),
    ]
    law = oo.HuntCrossley(1e4, restitution=0.9, speed=0.5)
    contact = oo.Contact("a/*", "b/*", normal=law, name="all")
    message = (
        r"2500 pairs .* with the most pairs is 'all', whose sides have 50 and 50 pieces"
        r".*SYSTEM/gripper\* instead of SYSTEM/\*"
    )
    with pytest.warns(UserWarning, match=message):
        simulation = oo.Simulation(oo.World(systems, contacts=[contact]), time_step=0.05)
    trace = simulation.run(6.0)
    # the line of centres of each pair, as long as b moves along x
    offset = other[None] - own[:, None]
    across = np.maximum(4 * RADIUS**2 - offset[..., 1] ** 2 - offset[..., 2] ** 2, 0.0)
    reached = np.where(across > 0.0, 3.0 + offset[..., 0] - np.sqrt(across), np.inf)
    down = trace.events[0]
    assert down.kind == "touch_down"
    assert abs(down.time - reached.min() / 0.5) < 1e-9
    before = trace.time < down.time
    for t, gap in zip(trace.time[before], trace.contacts["all"].gap[before], strict=True):
        centers = offset + np.array([3.0 - 0.5 * t, 0.0, 0.0])
        assert abs(gap - (np.linalg.norm(centers, axis=-1).min() - 2 * RADIUS)) < 1e-12
    assert before.sum() > 20
    assert np.abs(trace.momentum - trace.momentum[0]).max() < 1e-13


def test_a_pattern_on_both_sides_names_each_pair_once() -> None:
    """The exchanged pair would double the force, and both would cancel in the record."""
    ball, law = oo.robots.load("ball"), oo.HuntCrossley(1e6)
    systems = [
        oo.System("a", ball, [0, 0, 0, 0, 0, 0, 1], [0.1, 0, 0, 0, 0, 0]),
        oo.System("b", ball, [0.22, 0, 0, 0, 0, 0, 1], np.zeros(6)),
    ]
    touches = []
    for sides in (("a/*", "b/*"), ("*", "*"), (["a/*", "b/*"], "*")):
        contact = oo.Contact(*sides, normal=law, name="touch")
        trace = oo.Simulation(oo.World(systems, contacts=[contact]), time_step=0.01).run(0.5)
        touches.append(trace.contacts["touch"])
    for touch in touches[1:]:
        np.testing.assert_array_equal(touch.gap, touches[0].gap)
        np.testing.assert_array_equal(touch.force, touches[0].force)
    assert touches[0].impulse[-1, 0] > 0.3
