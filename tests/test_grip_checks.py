"""Errors of grippers in Python worlds: fingers without opposite fingers, and objects that are too wide."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from numpy.typing import NDArray

import onorbit_rs as oo
from onorbit_rs.exceptions import ControlError, OnOrbitError
from onorbit_rs.tools.validation.contact_bodies import at, body

NORMAL = oo.HuntCrossley(2e4, 1.0, dissipation=20.0)


def world(
    model: oo.Model, q: NDArray[np.float64], joints: list[str], rate: float, *,
    shape: str = '<sphere radius="0.03"/>', links: tuple[str, ...] = ("left_finger", "right_finger"),
) -> oo.World:  # fmt: skip
    """Return a world of a gripper and an object that is far away."""
    law = oo.GripForce(5.0, closing_rate=rate, damping=40.0)
    control = oo.Control(law, joints=joints, name="grip")
    systems = [
        oo.System("hand", model, q, np.zeros(model.nv), controller=[control]),
        at("thing", body(shape, 5.0, 0.05), [0.0, 0.0, 3.0]),
    ]
    contacts = [oo.Contact(f"hand/{link}", "thing/body", normal=NORMAL) for link in links]
    return oo.World(systems, contacts=contacts)


def jaws(rate: float = -0.02, **options: Any) -> oo.World:
    model = oo.robots.load("jaw_hand")
    q = model.neutral()
    q[7:] = 0.03
    return world(model, q, ["left_jaw"], rate, **options)


def linkages(rate: float, **options: Any) -> oo.World:
    loops = [
        oo.Loop(f"{side}_linkage", "revolute", f"{side}_pin", f"{side}_rod_tip") for side in ("left", "right")
    ]
    model = oo.robots.load("four_bar_gripper").with_loops(loops)
    return world(model, model.neutral(), ["left_crank"], rate, **options)


def test_opposing_fingers_and_a_narrow_object_are_accepted() -> None:
    jaws()
    linkages(-0.3)


@pytest.mark.parametrize(
    ("build", "message"),
    [
        (lambda: jaws(0.02), "the links left_finger, right_finger do not approach any other link of 'hand'"),
        (lambda: jaws(links=("left_finger",)), "the link left_finger does not approach any other link"),
        (lambda: linkages(0.3), "the links left_finger, right_finger do not approach any other link"),
    ],
)
def test_fingers_without_an_opposite_finger(build: Any, message: str) -> None:
    with pytest.raises(ControlError, match=message) as error:
        build()
    assert error.value.name == "grip"
    assert isinstance(error.value, OnOrbitError)


@pytest.mark.parametrize(("radius", "fits"), [(0.059, True), (0.061, False)])
def test_an_object_wider_than_the_jaws_open(radius: float, fits: bool) -> None:
    shape = f'<sphere radius="{radius}"/>'
    if fits:
        jaws(shape=shape)
        return
    with pytest.raises(
        ControlError, match=r"opening of the gripper is 0.12 m, but .* thing/body is 0.122 m wide"
    ):
        jaws(shape=shape)


@pytest.mark.parametrize(("radius", "fits"), [(0.093, True), (0.096, False)])
def test_linkages_open_until_the_first_limit(radius: float, fits: bool) -> None:
    """The cranks open to 1.2 rad, and the jaws to 2 (0.02 + 0.08 sin 1.2) m, parallel to each other."""
    shape = f'<sphere radius="{radius}"/>'
    assert 2.0 * 0.093 < 2.0 * (0.02 + 0.08 * np.sin(1.2)) < 2.0 * 0.096
    if fits:
        linkages(-0.3, shape=shape)
        return
    with pytest.raises(ControlError, match=r"thing/body is 0\.192 m wide"):
        linkages(-0.3, shape=shape)
