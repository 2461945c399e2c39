"""Every kernel against Pinocchio where both read the same URDF: random ones, ours, and real files."""

from __future__ import annotations

import warnings
from pathlib import Path

import numpy as np
import pytest

import onorbit_rs as oo
from onorbit_rs.validation.trees import TOOL, build, deviation, random_state, random_tree, urdf

pin = pytest.importorskip("pinocchio", reason="the oracle is in the test extra: pip install pin")
import pin_robot  # noqa: E402

GATE = 1e-12  # as in test_pinocchio.py
REAL_GATE = 1e-10  # real files have links of grams beside a torso: condition up to 1e7

# what both read; mimic joints are joints of their own to both
REAL = [
    "drake_kuka_iiwa14_benchmark.urdf",
    "pinocchio_baxter_simple.urdf",
    "rbdjl_atlas.urdf",
    "rbdl_tiago_dual.urdf",
]


def compare(model: oo.Model, text: str, tool: str, seed: int, gate: float) -> float:
    robot = pin_robot.PinRobot(pin_robot.from_urdf(text), model.joint_names)
    assert model.mass == pytest.approx(pin.computeTotalMass(robot.model), rel=1e-14)
    rng = np.random.default_rng(seed)
    largest = 0.0
    for _ in range(4):
        state = random_state(model, rng)
        ours = pin_robot.same_kernels(model, state, tool)
        theirs = pin_robot.every_kernel(robot, state, tool)
        if np.dot(ours["integrate"][3:7], theirs["integrate"][3:7]) < 0:
            theirs["integrate"][3:7] *= -1
        for kernel, value in theirs.items():
            off = deviation(ours[kernel], value)
            largest = max(largest, off)
            assert off < gate, f"{kernel} is off by {off:.2e} (seed {seed})"
    return largest


@pytest.mark.parametrize("seed", range(100, 120))
def test_random_trees_through_their_text(seed: int) -> None:
    text = urdf(random_tree(seed, rotors=False))
    compare(oo.Model.from_urdf_string(text), text, TOOL, seed, GATE)


def test_text_and_builder_make_the_same_robot() -> None:
    tree = random_tree(5, rotors=False)
    built, read = build(tree), oo.Model.from_urdf_string(urdf(tree))
    assert built.joint_names == read.joint_names
    state = random_state(built, np.random.default_rng(5))
    assert deviation(read.mass_matrix(state.q), built.mass_matrix(state.q)) < GATE


@pytest.mark.parametrize("name", ["humanoid_torso", "humanoid_dual_arm"])
def test_bundled_robots(name: str) -> None:
    text = oo.robots.path(name).read_text()
    model = oo.robots.load(name)
    compare(model, text, model.frame_names[-1], 1, GATE)


@pytest.mark.parametrize("name", REAL)
def test_real_files(name: str, shared: Path) -> None:
    file = shared / "models" / name
    if not file.is_file():
        pytest.skip(f"{file} is not there")
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")  # real files break the triangle inequality: no concern of this test
        model = oo.Model.from_urdf(file)
    text = file.read_text()
    if "iiwa14" in name:  # its joints have no limits, so Pinocchio's reader takes them only as continuous
        text = text.replace('type="revolute"', 'type="continuous"')
    largest = compare(model, text, model.body_names[-1], 2, REAL_GATE)
    print(f"{name}: largest deviation {largest:.1e}")
