"""Springs at joints in scenarios and URDF files: values, units, warnings, and errors with their line."""

from __future__ import annotations

import json
import warnings
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import onorbit_rs as oo
from onorbit_rs.cli import main
from onorbit_rs.exceptions import FrameError, ModelError, OnOrbitError
from onorbit_rs.robots.urdf import urdf_text
from onorbit_rs.scenario.build import build
from onorbit_rs.tools.validation.springs import REDUCED, wheel

URDF = """\
<robot name="craft">
  <link name="base"><inertial><mass value="20"/>
    <inertia ixx="2" iyy="2" izz="2" ixy="0" ixz="0" iyz="0"/></inertial></link>
  <joint name="spin" type="continuous">
    <parent link="base"/><child link="wheel"/><axis xyz="0 0 1"/>
    <spring stiffness="30" cubic_stiffness="-4.5" rest_position="0.25"/>
  </joint>
  <link name="wheel"><inertial><mass value="5"/>
    <inertia ixx="0.5" iyy="0.5" izz="0.5" ixy="0" ixz="0" iyz="0"/></inertial></link>
</robot>
"""
SCENARIO = """\
robot:
  urdf: craft.urdf
  joints:
    spin: JOINT
initial: {joints: [0.3]}
simulation: {duration: 0.2 s, time_step: STEP}
"""
pytestmark = pytest.mark.filterwarnings("ignore:joint .spin.. the tangent stiffness")


def spring_of(model: oo.Model, joint: int = 0) -> tuple[float, float, float]:
    found = model.joints[joint]
    return found.stiffness, found.cubic_stiffness, found.rest_position


def scenario(folder: Path, joint: str, step: str = "2 ms", urdf: str = URDF) -> Path:
    (folder / "craft.urdf").write_text(urdf)
    file = folder / "mine.yaml"
    file.write_text(SCENARIO.replace("JOINT", joint).replace("STEP", step))
    return file


def test_a_urdf_has_springs_and_keeps_them_when_it_is_written() -> None:
    model = oo.Model.from_urdf_string(URDF)
    assert spring_of(model) == (30.0, -4.5, 0.25)
    assert spring_of(oo.Model.from_urdf_string(urdf_text(model))) == (30.0, -4.5, 0.25)
    plain = urdf_text(wheel(stiffness=0.0))
    assert "<spring" not in plain and spring_of(oo.Model.from_urdf_string(plain)) == (0.0, 0.0, 0.0)


@pytest.mark.parametrize(
    ("old", "new", "message"),
    [
        ('"30" ', '"-30" ', "line 4: joint 'spin': the stiffness of the spring is -30 N m/rad"),
        ('"30" ', '"nan" ', "line 6: joint 'spin': stiffness=\"nan\" of <spring> is not a finite"),
        ('"0.25"', '"soft"', "line 6: joint 'spin': rest_position=\"soft\" of <spring> is not a"),
        (
            'stiffness="30" cubic_stiffness="-4.5" ', 'stifness="30" ',
            "line 6: <spring> of joint 'spin' has no attribute 'stiffness'",
        ),
        ('stiffness="30" ', "", "line 4: joint 'spin': the cubic stiffness of the spring is -4.5 N m/rad3"),
        ('"continuous"', '"fixed"', "line 4: joint 'spin' is fixed and cannot have a spring"),
    ],
)  # fmt: skip
def test_invalid_springs_of_a_urdf_are_errors_with_their_line(old: str, new: str, message: str) -> None:
    text = URDF.replace(old, new)
    assert text != URDF
    with pytest.raises(ModelError) as caught:
        oo.Model.from_urdf_string(text)
    assert message in str(caught.value)


def test_a_spring_of_a_ball_joint_is_ignored_with_a_warning() -> None:
    with pytest.warns(UserWarning, match="is a ball joint .* its <spring> is ignored"):
        model = oo.Model.from_urdf_string(URDF.replace('"continuous"', '"ball"'))
    assert all(joint.stiffness == 0.0 for joint in model.joints)


def test_a_scenario_replaces_the_properties_of_joints(tmp_path: Path) -> None:
    joint = (
        "{stiffness: 40 N m/rad, cubic_stiffness: 0.01 N m/deg^3, rest_position: 10 deg, "
        "damping: 0.1 N m s/rad, friction: 0.2 N m, static_friction: 0.3 N m, rotor_inertia: 1e3 kg cm^2}"
    )
    built = build(oo.scenario.load(scenario(tmp_path, joint)))
    found = built.model.joints[0]
    assert spring_of(built.model) == pytest.approx(
        (40.0, 0.01 * np.rad2deg(1.0) ** 3, np.deg2rad(10.0)), rel=1e-14
    )
    assert (found.damping, found.friction, found.static_friction) == (0.1, 0.2, 0.3)
    assert found.rotor_inertia == pytest.approx(0.1)
    # properties that are not given keep the value of the file
    kept = build(oo.scenario.load(scenario(tmp_path, "{damping: 1}"))).model
    assert spring_of(kept) == (30.0, -4.5, 0.25) and kept.joints[0].damping == 1.0
    # the resolved scenario, which an output folder contains, has the same robot
    data = oo.scenario.load(scenario(tmp_path, joint)).resolved(tmp_path)
    assert spring_of(build(oo.scenario.load(data)).model) == spring_of(built.model)


@pytest.mark.parametrize(
    ("joint", "expected"),
    [
        ("{stiffness: -40}", ".stiffness: -40 is out of range; it must be zero or above"),
        ("{stiffness: .nan}", ".stiffness: "),
        ("{stiffness: 40 N/m}", ": stiffness is a stiffness, but the joint 'spin' is revolute; give an"),
        ("{rest_position: 3 cm}", ": rest_position is a length, but the joint 'spin' is revolute"),
        ("{stiffness: 40 N}", ".stiffness: '40 N' is not an angular stiffness or a stiffness; give"),
        ("{stifness: 40}", ".stifness: unknown key; did you mean 'stiffness'?"),
        ("{springref: 40}", ".springref: unknown key; did you mean 'rest_position'?"),
        ("{stiffness: 0, cubic_stiffness: -1}", ": joint 'spin': the cubic stiffness of the spring is -1"),
        ("{friction: 2, static_friction: 1}", ": joint 'spin': the static friction, 1 N m, is below"),
    ],
)  # fmt: skip
def test_invalid_properties_are_errors_with_line_and_path(tmp_path: Path, joint: str, expected: str) -> None:
    with pytest.raises(OnOrbitError) as caught:
        build(oo.scenario.load(scenario(tmp_path, joint)))
    assert f"mine.yaml:4: robot.joints.spin{expected}" in str(caught.value)


def test_an_unknown_joint_is_an_error_with_the_nearest_name(tmp_path: Path) -> None:
    with pytest.raises(FrameError, match=r"mine.yaml:5: robot.joints.spinn: there is no joint 'spinn'; did"):
        build(oo.scenario.load(scenario(tmp_path, "{stiffness: 1}\n    spinn: {stiffness: 1}")))


def warnings_of(file: Path) -> list[str]:
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        return [text for text in build(oo.scenario.load(file)).warnings if "spring" in text]


def test_a_step_that_does_not_resolve_a_spring_is_a_warning(tmp_path: Path) -> None:
    stiffness = 1e4 * REDUCED  # 100 rad/s
    joint = f"{{stiffness: {stiffness!r}, cubic_stiffness: 0, rest_position: 0.3}}"
    assert warnings_of(scenario(tmp_path, joint, "1.9 ms")) == []
    (coarse,) = warnings_of(scenario(tmp_path, joint, "2.1 ms"))
    assert coarse.startswith(
        "robot: the spring of joint 'spin' oscillates at 100 rad/s with the inertia at the start; with a "
        "time_step of 0.0021 s, the product of both is 0.21, and rk4 removes the fraction 4e-05 of the "
        "energy of the oscillation in each period"
    )
    assert "use a time_step of at most 0.001 s" in coarse
    (unstable,) = warnings_of(scenario(tmp_path, joint, "29 ms"))
    assert "product of both is 2.9, and rk4 diverges above a product of 2.83" in unstable
    adaptive = scenario(tmp_path, joint, "29 ms")
    adaptive.write_text(adaptive.read_text().replace("time_step:", "integrator: dormand_prince, time_step:"))
    assert warnings_of(adaptive) == []


@pytest.mark.parametrize(("product", "grows"), [(2.7, False), (2.9, True)])
def test_the_limit_of_the_warning_is_that_of_the_integrator(product: float, grows: bool) -> None:
    model = wheel(stiffness=1e4 * REDUCED)
    q = model.neutral()
    q[7] = 0.01
    trace = oo.Simulation(model, q, np.zeros(7), time_step=product / 100.0).run(2.0)
    assert (abs(trace.q[-1, 7]) > 0.01) == grows


def test_rk4_loses_as_much_energy_as_the_warning_says() -> None:
    model = wheel(stiffness=1e4 * REDUCED)
    q = model.neutral()
    q[7] = 0.01
    trace = oo.Simulation(model, q, np.zeros(7), time_step=2.1e-3).run(2.0 * np.pi / 100.0 * 10)
    energy = trace.kinetic_energy + trace.spring_energy
    assert 1.0 - energy[-1] / energy[0] == pytest.approx(10 * 2.0 * np.pi * 0.21**5 / 72.0, rel=0.03)


def test_info_lists_springs(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    file = tmp_path / "craft.urdf"
    file.write_text(URDF)
    with pytest.raises(SystemExit):
        main(["info", str(file)])
    printed = capsys.readouterr().out
    assert "springs: N m/rad, N m/rad³, rad" in printed
    assert ["spin", "30", "-4.5", "0.25"] in [line.split() for line in printed.splitlines()]
    with pytest.raises(SystemExit):
        main(["info", str(file), "--json"])
    (joint,) = json.loads(capsys.readouterr().out)["joints"]
    assert (joint["stiffness"], joint["cubic_stiffness"], joint["rest_position"]) == (30.0, -4.5, 0.25)


def test_the_run_folder_has_the_energy_of_the_springs(tmp_path: Path) -> None:
    result = oo.run(scenario(tmp_path, "{stiffness: 40}"), quiet=True, out=tmp_path / "out")
    trace: Any = result.trace
    with np.load(tmp_path / "out" / "trace.npz") as stored:
        np.testing.assert_array_equal(stored["spring_energy"], trace.spring_energy)
    assert trace.spring_energy[0] == pytest.approx(0.5 * 40 * 0.05**2 - 0.25 * 4.5 * 0.05**4)
