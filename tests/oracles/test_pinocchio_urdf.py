"""Every kernel against Pinocchio for the same URDF: random trees, quirky robots, the bundled robots."""

from __future__ import annotations

import warnings

import numpy as np
import pytest
import quirky_robots

import onorbit_rs as oo
from onorbit_rs.tools.validation.trees import TOOL, build, deviation, random_state, random_tree, urdf

pin = pytest.importorskip("pinocchio", reason="the oracle is not installed: pip install pin")
import pin_file  # noqa: E402
import pin_robot  # noqa: E402

GATE = 1e-12  # as in test_pinocchio.py


def compare(model: oo.Model, text: str, tool: str, seed: int) -> None:
    robot = pin_robot.PinRobot(pin_robot.from_urdf(text), model.joint_names)
    assert model.mass == pytest.approx(pin.computeTotalMass(robot.model), rel=1e-14)
    rng = np.random.default_rng(seed)
    for _ in range(4):
        state = random_state(model, rng)
        ours = pin_robot.same_kernels(model, state, tool)
        theirs = pin_robot.every_kernel(robot, state, tool)
        if np.dot(ours["integrate"][3:7], theirs["integrate"][3:7]) < 0:
            theirs["integrate"][3:7] *= -1
        for kernel, value in theirs.items():
            off = deviation(ours[kernel], value)
            assert off < GATE, f"{kernel} is off by {off:.2e} (seed {seed})"


@pytest.mark.parametrize("seed", range(100, 120))
def test_random_trees_from_urdf_text(seed: int) -> None:
    text = urdf(random_tree(seed, rotors=False))
    compare(oo.Model.from_urdf_string(text), text, TOOL, seed)


def test_urdf_text_and_builder_give_the_same_robot() -> None:
    tree = random_tree(5, rotors=False)
    built, read = build(tree), oo.Model.from_urdf_string(urdf(tree))
    assert built.joint_names == read.joint_names
    state = random_state(built, np.random.default_rng(5))
    assert deviation(read.mass_matrix(state.q), built.mass_matrix(state.q)) < GATE


@pytest.mark.parametrize("name", ["humanoid_torso", "humanoid_dual_arm", "servicer"])
def test_bundled_robots(name: str) -> None:
    text = oo.robots.path(name).read_text()
    model = oo.robots.load(name)
    compare(model, text, model.frame_names[-1], 1)


@pytest.mark.parametrize(
    ("root", "seeds"),
    [
        ("body", range(20)),
        ("world of two", range(20, 35)),
        ("world", range(35, 50)),
    ],
)
def test_quirky_robots(root: str, seeds: range) -> None:
    for seed in seeds:
        text = quirky_robots.text(seed, root=root)
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")
            model = oo.Model.from_urdf_string(text)
        found = pin_file.deviations(model, pin_robot.from_urdf(text), seed)
        assert all(off < GATE for off in found.values()), f"seed {seed}: {found}"


def test_a_quirky_robot_of_75_links() -> None:
    """The number of links of a robot with two arms and two hands."""
    text = quirky_robots.text(75, links=75)
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        model = oo.Model.from_urdf_string(text)
    assert len(model.frame_names) >= 75
    compare(model, text, model.body_names[-1], 2)
