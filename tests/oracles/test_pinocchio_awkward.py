"""Unusual files give the same robot as in Pinocchio, including the base frame, or are rejected as listed."""

from __future__ import annotations

import importlib.util
import re
import warnings
from pathlib import Path

import awkward
import pytest

import onorbit_rs as oo

pin = pytest.importorskip("pinocchio", reason="the oracle is not installed: pip install pin")
import pin_file  # noqa: E402

GATE = 1e-12  # as in test_pinocchio.py
HAS_XACRO = importlib.util.find_spec("xacro") is not None

# rejected by urdfdom, Pinocchio's reader
REFUSED_BY_PINOCCHIO = {
    "ball_joint": "URDF has no such joint",
    "duplicate_material": "a material is defined once",
    "dynamics_empty": "dynamics give damping or friction",
    "effort_and_velocity_negative": "limits are positive",
    "infinite_limits": "inf is no number",
    "limit_without_velocity": "a limit gives velocity and effort",
    "revolute_without_limit": "a revolute joint has a limit",
    "robot_without_name": "a robot has a name",
    "safety_controller_bare": "a safety controller has a gain",
    "stylesheet": "an instruction is taken for a second declaration",
    "tabs_and_newlines_in_vector": "only spaces separate numbers",
    "version_unknown": "there is no version 2.0",
}
# read by both, with different results
READ_OTHERWISE = {
    "armature": "Pinocchio takes a rotor inertia from no URDF",
    "axis_without_xyz": "Pinocchio's axis has no length; it is x in URDF",
    "inertia_without_products": "Pinocchio reports it and leaves the link without inertia",
    "planar_joint_without_axis": "Pinocchio's plane is that of x and y; URDF's lies across the axis",
}
# the link below the joint
SEVERAL_DEGREES = {
    "planar_joint": "arm",
    "planar_joint_with_taken_name": "slide_x",
    "planar_joint_without_axis": "arm",
    "floating_joint_between_bodies": "arm",
}
CRASHES_PINOCCHIO = {"self_parent"}  # it recurses until the stack overflows

COMPARED = [
    name
    for name, to in awkward.EXPECTED.items()
    if to.loads and name not in {*REFUSED_BY_PINOCCHIO, *READ_OTHERWISE, *SEVERAL_DEGREES}
]


def load(file: Path) -> oo.Model:
    if file.suffix == ".xacro" and not HAS_XACRO:
        pytest.skip("xacro is not installed: pip install 'onorbit-rs[xacro]'")
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")  # test_awkward_files.py has them
        return oo.Model.from_urdf(file)


def off(deviations: dict[str, float]) -> dict[str, float]:
    return {name: value for name, value in deviations.items() if not value < GATE}


@pytest.mark.parametrize("name", COMPARED)
def test_it_is_the_same_robot(name: str, tmp_path: Path) -> None:
    file = awkward.path(name)
    model = load(file)
    if name == "latin1_name":  # Pinocchio reads the names, but cannot pass names that are not UTF-8 to Python
        text = file.read_text(encoding="latin-1")
        file = tmp_path / file.name
        file.write_text(text, encoding="utf-8")
    theirs = pin_file.read(file, root_joint=name != "floating_joint_below_massless_root")
    assert not off(pin_file.deviations(model, theirs, seed=1))


def moving_alike(name: str) -> dict[str, float]:
    file = awkward.path(name)
    return pin_file.moving_alike(load(file), pin_file.read(file), SEVERAL_DEGREES[name], seed=1)


@pytest.mark.parametrize("name", [name for name in SEVERAL_DEGREES if name not in READ_OTHERWISE])
def test_joints_of_several_degrees_of_freedom_move_alike(name: str) -> None:
    assert not off(moving_alike(name))


@pytest.mark.parametrize("name", READ_OTHERWISE)
def test_files_that_pinocchio_reads_differently(name: str) -> None:
    assert awkward.EXPECTED[name].loads
    file = awkward.path(name)
    if name in SEVERAL_DEGREES:
        assert off(moving_alike(name))
    else:
        assert off(pin_file.deviations(load(file), pin_file.read(file), seed=1))


EQUATIONS = {"mass_matrix", "inverse_dynamics", "forward_dynamics"}


@pytest.mark.parametrize(
    ("old", "new", "found"),
    [
        ('izz="0.2"', 'izz="0.200001"', EQUATIONS),
        ('xyz="1 2 3"', 'xyz="1 2 3.000001"', {*EQUATIONS, "frame_pose"}),
        ('rpy="0.2 0 0.1"', 'rpy="0.2 0 0.100001"', {*EQUATIONS, "frame_pose"}),
        ('mass value="3"', 'mass value="3.000001"', {*EQUATIONS, "mass"}),
    ],
)
def test_a_robot_that_differs_in_one_number_is_detected(
    old: str, new: str, found: set[str], tmp_path: Path
) -> None:
    file = awkward.path("two_fixed_children_of_massless_root")
    other = tmp_path / "other.urdf"
    other.write_text(file.read_text().replace(old, new, 1))
    assert other.read_text() != file.read_text()
    assert set(off(pin_file.deviations(load(file), pin_file.read(other), seed=1))) == found


@pytest.mark.parametrize("name", REFUSED_BY_PINOCCHIO)
def test_files_that_pinocchio_rejects_and_the_package_reads(name: str) -> None:
    assert awkward.EXPECTED[name].loads
    with pytest.raises(ValueError, match=r"not contain a valid URDF|greater than max_effort"):
        pin_file.read(awkward.path(name))


REFUSED = [name for name, to in awkward.EXPECTED.items() if not to.loads and name not in CRASHES_PINOCCHIO]


@pytest.mark.parametrize("name", REFUSED)
def test_files_that_only_the_package_rejects_are_physically_invalid(name: str) -> None:
    try:
        pin_file.read(awkward.path(name))
    except ValueError as error:
        assert re.search("not contain a valid URDF", str(error))
        is_read = False
    else:
        is_read = True
    assert is_read == awkward.EXPECTED[name].is_physics
