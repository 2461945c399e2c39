"""Conversion of OnOrbitROS files to scenarios: the result of each line, and invalid input."""

from __future__ import annotations

import math
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from border import Bad, check
from commands import onorbit

import onorbit_rs as oo
from onorbit_rs.common.evaluator import Evaluator
from onorbit_rs.robots import expressions as of_robots
from onorbit_rs.scenario import load
from onorbit_rs.scenario.build import build
from onorbit_rs.tools.interop import expressions as arithmetic
from onorbit_rs.tools.interop.expressions import evaluate
from onorbit_rs.tools.interop.onorbitros import Conversion, convert
from onorbit_rs.tools.interop.source import Source

# in the format of OnOrbitROS, with its two misspelt keys
ORBIT = """\
publish_rate: 10
eccentricity: 0.001
semi_major_axix: 7000
inclination: (51.6*pi)/180.0
rate_of_right_ascension: 0.0
right_ascension_ini: 0.5
argument_of_perigee_ini: 0.25
rate_argument_Of_perigee: 0.0
mean_anomaly_ini: (60.0*pi)/180.0
time_pass_perigee: {sec: 0, min: 0, hour: 0, mday: 1, mon: 0, year: 2000}
time_start: {sec: 30, min: 1, hour: 0, mday: 1, mon: 0, year: 2000}
angular_velocity: 0.0010948236924738
"""
POSE = """\
publish_rate: 10
pos_x: 6778.0
pos_y: 0.0
pos_z: 0.0
orientation_x: 0.0
orientation_y: 0.0
orientation_z: 0.7071067811865476
orientation_w: 0.7071067811865476
"""
CONTROL = """\
talos:
  right_arm_controller:
    type: "talos_control/TorsoEffortController"
    end_effector_link: tool
    base_link: dummy
    joints: [arm_joint_1, arm_joint_2]
    trajectory_duration: 15.0
    goal_tolerance: 0.015
    kp_value: 1000.0
    kv_value: 200.0
  left_arm_controller:
    type: "talos_control/TorsoEffortController"
    end_effector_link: torso
    kp_value: 10.0
"""
ROBOT = oo.robots.path("humanoid_torso")


def write(folder: Path, **texts: str) -> list[Path]:
    files = [folder / f"{name}.yaml" for name in texts]
    for file, text in zip(files, texts.values(), strict=True):
        file.write_text(text)
    return files


def verdicts(done: Conversion) -> dict[str, str]:
    return {note.key: note.verdict for note in done.notes}


def test_an_orbit(tmp_path: Path) -> None:
    done = convert(write(tmp_path, orbit=ORBIT))
    orbit = done.scenario["orbit"]
    # its node starts n (start - perigee) after the file's mean anomaly
    shift = math.sqrt(oo.MU_EARTH / 7e6**3) * 90.0
    assert orbit == {
        "kind": "kepler",
        "semi_major_axis": 7e6,
        "eccentricity": 0.001,
        "inclination": pytest.approx(math.radians(51.6)),
        "raan": 0.5,
        "argument_of_periapsis": 0.25,
        "mean_anomaly": pytest.approx(math.pi / 3 + shift, rel=1e-15),
    }
    built = build(load(done.scenario))
    assert built.orbit is not None and built.orbit.semi_major_axis == pytest.approx(7e6)
    # negative control: without the two dates the spacecraft is 90 s behind
    early = convert(write(tmp_path, early="\n".join(ORBIT.splitlines()[:9])))
    before = oo.Kepler(**{key: value for key, value in early.scenario["orbit"].items() if key != "kind"})
    np.testing.assert_allclose(before.state(90.0)[0], built.orbit.state(0.0)[0], rtol=1e-9)
    assert np.linalg.norm(before.state(0.0)[0] - built.orbit.state(0.0)[0]) > 6e5


def test_every_line_of_an_orbit_has_a_verdict(tmp_path: Path) -> None:
    done = convert(write(tmp_path, orbit=ORBIT))
    assert verdicts(done) == {
        "publish_rate": "no meaning",
        "eccentricity": "understood",
        "semi_major_axix": "corrected",
        "inclination": "corrected",
        "rate_of_right_ascension": "no meaning",
        "right_ascension_ini": "understood",
        "argument_of_perigee_ini": "understood",
        "rate_argument_Of_perigee": "no meaning",
        "mean_anomaly_ini": "corrected",
        "time_pass_perigee": "understood",
        "time_start": "understood",
        "angular_velocity": "no meaning",
    }
    assert [note.line for note in done.notes] == list(range(1, 13))
    texts = {note.key: note.text for note in done.notes}
    assert "uses 12000 km" in texts["semi_major_axix"]  # OnOrbitROS ignores the misspelt key
    assert "0.00107801" in texts["angular_velocity"]  # sqrt(398600.4418 / 7000³) rad/s, by hand


def test_missing_keys_have_the_defaults_of_onorbitros(tmp_path: Path) -> None:
    done = convert(write(tmp_path, orbit="semi_major_axis: 7000\n"))
    assert done.scenario["orbit"]["inclination"] == math.radians(51.6427)
    assert verdicts(done)["inclination"] == "corrected"


@pytest.mark.parametrize(
    "wrapped",
    [
        "/**:\n  ros__parameters:\n    semi_major_axis: 7000\n",
        "orbit_node:\n  ros__parameters:\n    semi_major_axis: 7000\n",
        "chaser:\n  semi_major_axis: 7000\n",
        "semi_major_axis: 7000\ntime_pass_perigee/sec: 3\n",
    ],
)
def test_wrappers_and_flat_keys(wrapped: str, tmp_path: Path) -> None:
    done = convert(write(tmp_path, orbit=wrapped))
    assert done.scenario["orbit"]["semi_major_axis"] == 7e6
    load(done.scenario)


def test_a_fixed_pose(tmp_path: Path) -> None:
    done = convert(write(tmp_path, pose=POSE))
    half = math.sqrt(0.5)
    orbit = done.scenario["orbit"]
    assert (orbit["kind"], orbit["position"]) == ("fixed_frame", [6.778e6, 0.0, 0.0])
    assert orbit["attitude"] == {"quaternion_xyzw": pytest.approx([0.0, 0.0, half, half])}
    assert (orbit["mu"], orbit["gravity_mode"]) == (oo.MU_EARTH, "carried")
    built = build(load(done.scenario))
    assert built.orbit is not None
    np.testing.assert_allclose(built.orbit.state(5.0)[0], orbit["position"])
    at_center = convert(write(tmp_path, center="pos_x: 0.0\norientation_w: 1.0\n"))
    assert "mu" not in at_center.scenario["orbit"]  # there is no gravity there
    build(load(at_center.scenario))


def test_a_controller_with_its_robot(tmp_path: Path) -> None:
    done = convert([*write(tmp_path, orbit=ORBIT, control=CONTROL), ROBOT])
    scenario = done.scenario
    assert (scenario["tool"], scenario["controller"]) == (
        "tool",
        {"kind": "computed_torque", "kp": 1000.0, "kd": 200.0},
    )
    assert scenario["reference"]["duration"] == scenario["simulation"]["duration"] == 15.0
    assert build(load(scenario)).model.joint_names[0] == "arm_joint_1"
    texts = verdicts(done)
    assert texts["left_arm_controller"] == texts["joints"] == texts["goal_tolerance"] == "no meaning"
    other = convert([*write(tmp_path, control=CONTROL), ROBOT], controller="left_arm_controller")
    assert (other.scenario["tool"], other.scenario["controller"]["kp"]) == ("torso", 10.0)
    assert "kd" not in other.scenario["controller"] and verdicts(other)["kv_value"] == "corrected"


@pytest.mark.parametrize(
    ("text", "value"),
    [
        ("(60.0*pi)/180.0", math.pi / 3),
        ("-pi/2", -math.pi / 2),
        ("2**3", 8.0),
        ("sqrt(2)*1e3", math.sqrt(2e6)),
        ("deg(180)", math.pi),
        ("rad(2*pi)", 2 * math.pi),
        ("  1.5 ", 1.5),
        (7, 7.0),
        ("+3", 3.0),
    ],
)
def test_expressions(text: Any, value: float) -> None:
    assert evaluate(text) == pytest.approx(value, rel=1e-15)


@pytest.mark.parametrize(
    "text",
    [
        "__import__('os').system('true')",
        "pi.real",
        "[1][0]",
        "lambda: 1",
        "1 if 1 else 2",
        "x",
        "open('f')",
        "1j",
        "'a'*9",
        "9**9**9**9",
        "1/0",
        "sqrt(-1)",
        "1e999",
        "(" * 300,
        "(" * 90 + "1" + ")" * 90,
        "",
        "1,2",
        "True",
        True,
        None,
        [1],
        math.nan,
        10**400,
        "f()",
        "sqrt(1, 2)",
        "sqrt(*[1])",
        "sqrt(x=1)",
        "1 % 2",
        "not 1",
        "1 < 2",
        "(lambda: 1)()",
        "1 +",
        "pi = 3",
        "a" * 500,
        "-" * 190 + "1",
    ],
)
def test_expressions_other_than_arithmetic_are_rejected(text: Any) -> None:
    if text in ("(" * 90 + "1" + ")" * 90, "-" * 190 + "1"):
        assert abs(evaluate(text)) == 1.0  # long, but arithmetic
        return
    with pytest.raises(oo.exceptions.QuantityError):
        evaluate(text)


def test_both_kinds_of_files_use_one_evaluator() -> None:
    """Two separate evaluators once accepted different expressions."""
    for kind in (arithmetic._Arithmetic, of_robots._Evaluation):
        assert issubclass(kind, Evaluator) and kind.generic_visit is Evaluator.generic_visit
        known = {name for name in dir(kind) if name.startswith("visit_")}
        assert not known & {
            "visit_Lambda",
            "visit_ListComp",
            "visit_NamedExpr",
            "visit_Starred",
            "visit_JoinedStr",
        }


BAD: dict[str, tuple[str, str, tuple[str, ...]]] = {
    "unknown key": (
        "semi_major_axes: 7000",
        "ScenarioError",
        (":1:", "semi_major_axes", "semi_major_axis", "use keep_going=True to ignore it"),
    ),
    "unknown key inside": (
        CONTROL.replace("kp_value: 1000", "kp_valeu: 1000"),
        "ScenarioError",
        (":9:", "kp_value"),
    ),
    "metres": ("semi_major_axis: 7000000", "ScenarioError", (":1:", "km")),
    "degrees": ("inclination: 51.6", "ScenarioError", ("51.6 rad", "(51.6*pi)/180.0")),
    "no number": ("eccentricity: round", "ScenarioError", ("eccentricity", "'round'")),
    "code": ("eccentricity: __import__('os')", "ScenarioError", ("eccentricity",)),
    "both spellings": (
        "semi_major_axis: 7000\nsemi_major_axix: 7000",
        "ScenarioError",
        (":2:", "remove one"),
    ),
    "date": (
        "eccentricity: 0\ntime_start: {sec: x, min: 0, hour: 0, mday: 1, mon: 0, year: 2000}",
        "ScenarioError",
        ("sec",),
    ),
    "part of a date": ("eccentricity: 0\ntime_start: {second: 1}", "ScenarioError", ("second", "sec")),
    "year": (
        "eccentricity: 0\ntime_start: {sec: 0, min: 0, hour: 0, mday: 1, mon: 0, year: 99999}",
        "ScenarioError",
        ("99999",),
    ),
    "no quaternion": (POSE.replace("orientation_w: 0.7", "orientation_w: 7.7"), "ScenarioError", ("norm",)),
    "no link": (
        CONTROL.replace("    end_effector_link: tool\n", ""),
        "ScenarioError",
        ("end_effector_link", "missing"),
    ),
    "gain negative": (CONTROL.replace("1000.0", "-1"), "ScenarioError", ("kp_value", "negative")),
    "duration": (CONTROL.replace("15.0", "0"), "ScenarioError", ("trajectory_duration", "positive")),
    "joints no list": (
        CONTROL.replace("[arm_joint_1, arm_joint_2]", "3"),
        "ScenarioError",
        ("joints", "list"),
    ),
    "ROS Control": (
        "arm:\n  type: position_controllers/JointTrajectoryController\n",
        "ScenarioError",
        ("ROS Control", "Trajectory"),
    ),
    "ROS Control, a joint without gains": (
        "arm:\n  type: effort_controllers/JointTrajectoryController\n  joints: [a,b]\n  gains: {a: {p: 1}}\n",
        "ScenarioError",
        (":4:", "arm.gains", "no gains for b"),
    ),
    "ROS Control, a gain misspelt": (
        "arm:\n  type: effort_controllers/JointPositionController\n  joint: a\n  pid: {p: 1, dd: 2}\n",
        "ScenarioError",
        (":4:", "arm.pid.dd", "i_clamp"),
    ),
    "empty": ("", "ScenarioError", ("no parameters",)),
    "a list": ("- 1", "ScenarioError", ("no parameters",)),
    "no YAML": ("a: [", "ScenarioError", ("invalid YAML",)),
}


@pytest.mark.parametrize("name", BAD)
def test_bad_input(name: str, tmp_path: Path) -> None:
    text, error, words = BAD[name]
    (file,) = write(tmp_path, bad=text)
    bad = Bad(lambda: convert([file, ROBOT]), error, (str(file), *words), {"file": str(file)})
    check(bad)


def test_files_that_do_not_fit_together_are_rejected(tmp_path: Path) -> None:
    orbit, pose, control = write(tmp_path, orbit=ORBIT, pose=POSE, control=CONTROL)
    for files, word in (([orbit, pose], r"also defined in .*orbit\.yaml"), ([control], "requires a robot")):
        with pytest.raises(oo.exceptions.ScenarioError, match=word):
            convert(files)
    with pytest.raises(oo.exceptions.InputError, match="2 robots are given"):
        convert([ROBOT, ROBOT])
    with pytest.raises(oo.exceptions.InputError, match="no file"):
        convert([])
    with pytest.raises(oo.exceptions.NotFoundError):
        convert([tmp_path / "none.yaml"])
    with pytest.raises(oo.exceptions.ScenarioError, match="did you mean 'left_arm_controller'"):
        convert([control, ROBOT], controller="left_arm_controler")


def test_unknown_keys_can_be_ignored(tmp_path: Path) -> None:
    done = convert(write(tmp_path, orbit=ORBIT + "colour: red\n"), keep_going=True)
    assert verdicts(done)["colour"] == "no meaning"


def test_the_command(tmp_path: Path) -> None:
    write(tmp_path, orbit=ORBIT, control=CONTROL)
    (tmp_path / "out").mkdir()
    made = ("convert", "orbit.yaml", "control.yaml", ROBOT, "--out", "out/mine.yaml")
    done = onorbit(*made, cwd=tmp_path)
    assert done.returncode == 0, done
    assert "orbit.yaml:3: semi_major_axix: corrected" in done.stderr
    assert "next: onorbit check out/mine.yaml" in done.stdout
    text = (tmp_path / "out" / "mine.yaml").read_text()
    assert "# orbit.yaml:3: semi_major_axix: 7000" in text
    checked = onorbit("check", "out/mine.yaml", cwd=tmp_path)
    assert checked.stdout.startswith("ok: mine: humanoid_torso"), checked
    again = onorbit(*made, cwd=tmp_path)
    assert (again.returncode, len(again.stderr.splitlines())) == (2, 1) and "--force" in again.stderr
    assert onorbit(*made, "--force", cwd=tmp_path).returncode == 0
    refused = onorbit("convert", "nothing.yaml", cwd=tmp_path)
    assert (refused.returncode, len(refused.stderr.splitlines())) == (2, 1)
    write(tmp_path, odd="semi_major_axes: 7000")
    assert "use --keep-going to ignore it" in onorbit("convert", "odd.yaml", cwd=tmp_path).stderr


def test_a_missing_number_without_a_default_is_an_error_of_the_file(tmp_path: Path) -> None:
    source = Source(tmp_path / "a.yaml", {}, ("arm",), {}, False, [])
    assert source.number("kp", 2.0) == 2.0
    with pytest.raises(oo.exceptions.ScenarioError, match=r"a\.yaml: arm\.kp: is missing; give a number"):
        source.number("kp")
