"""Xacro files through PyPI's xacro, without ROS: packages, arguments, omitted elements, invalid input."""

from __future__ import annotations

import importlib.util
import json
import pickle
import subprocess
import sys
import warnings
from pathlib import Path

import numpy as np
import pytest
from border import Bad, check
from commands import refusal

import onorbit_rs as oo

HAS_XACRO = importlib.util.find_spec("xacro") is not None
needs_xacro = pytest.mark.skipif(
    not HAS_XACRO, reason="xacro is not installed: pip install 'onorbit-rs[xacro]'"
)

HEAD = '<robot name="r" xmlns:xacro="http://www.ros.org/wiki/xacro">'
LINK = (
    '<link name="{0}"><inertial><mass value="{1}"/>'
    '<inertia ixx="1" iyy="1" izz="1" ixy="0" ixz="0" iyz="0"/></inertial></link>'
)
ARM = (
    HEAD
    + '<xacro:macro name="arm" params="prefix">'
    + LINK.format("${prefix}arm", "${2*3}")
    + '<joint name="${prefix}joint" type="continuous">'
    '<parent link="base"/><child link="${prefix}arm"/></joint></xacro:macro></robot>'
)
ROBOT = (
    HEAD
    + '<xacro:arg name="side" default="left"/>'
    + '<xacro:include filename="$(find arm_description)/urdf/arm.xacro"/>'
    + LINK.format("base", "10")
    + '<xacro:arm prefix="$(arg side)_"/></robot>'
)


@pytest.fixture
def robot(tmp_path: Path) -> Path:
    arm = tmp_path / "packages" / "arm_description" / "urdf" / "arm.xacro"
    arm.parent.mkdir(parents=True)
    arm.write_text(ARM)
    file = tmp_path / "elsewhere" / "robot.urdf.xacro"
    file.parent.mkdir()
    file.write_text(ROBOT)
    return file


def packages(robot: Path) -> Path:
    return robot.parents[1] / "packages"


@needs_xacro
def test_packages_and_arguments(robot: Path) -> None:
    model = oo.Model.from_urdf(robot, package_paths=[packages(robot)])
    assert (model.joint_names, model.mass) == (["left_joint"], 16.0)
    itself = packages(robot) / "arm_description"  # the folder of the package is accepted, too
    right = oo.Model.from_urdf(robot, package_paths=[itself], xacro_arguments={"side": "right"})
    assert right.joint_names == ["right_joint"]
    by_name = oo.robots.load(robot, package_paths=[packages(robot)], xacro_arguments={"side": 1})
    assert by_name.joint_names == ["1_joint"]


@needs_xacro
def test_a_package_above_the_file_is_found(robot: Path) -> None:
    inside = packages(robot) / "arm_description" / "urdf" / "robot.xacro"
    inside.write_text(ROBOT)
    assert oo.Model.from_urdf(inside).joint_names == ["left_joint"]


@needs_xacro
def test_a_urdf_with_xacro_is_expanded_on_request_only(tmp_path: Path) -> None:
    file = tmp_path / "robot.urdf"
    file.write_text(HEAD + '<xacro:property name="m" value="2"/>' + LINK.format("base", "${m}") + "</robot>")
    with pytest.raises(oo.exceptions.ModelError, match="xacro=True; the command line has --xacro"):
        oo.Model.from_urdf(file)
    assert oo.Model.from_urdf(file, xacro=True).mass == 2.0
    assert oo.Model.from_urdf(file, xacro_arguments={}).mass == 2.0
    assert pickle.loads(pickle.dumps(oo.Model.from_urdf(file, xacro=True))).mass == 2.0
    file.write_text(HEAD + LINK.format("base", "3") + "</robot>")  # only declares the namespace
    assert oo.Model.from_urdf(file).mass == 3.0


@needs_xacro
def test_xacro_can_be_requested_in_a_scenario_and_on_the_command_line(tmp_path: Path) -> None:
    file = tmp_path / "robot.urdf"
    file.write_text(HEAD + '<xacro:property name="m" value="2"/>' + LINK.format("base", "${m}") + "</robot>")
    command = [sys.executable, "-m", "onorbit_rs", "info", str(file)]
    done = subprocess.run([*command, "--json"], capture_output=True, text=True, check=False)
    assert done.returncode == 2
    assert "--xacro" in done.stderr
    done = subprocess.run([*command, "--json", "--xacro"], capture_output=True, text=True, check=True)
    assert json.loads(done.stdout)["mass_kg"] == 2.0
    from onorbit_rs.scenario import load

    scenario = load({"robot": {"urdf": str(file), "xacro": True}, "simulation": {"duration": 0.01}})
    assert scenario.robot.build(scenario).mass == 2.0
    assert scenario.resolved()["robot"]["xacro"] is True


@needs_xacro
def test_a_scenario_gives_packages_and_arguments(robot: Path) -> None:
    file = robot.parents[1] / "mine.yaml"
    file.write_text(
        "robot:\n  urdf: elsewhere/robot.urdf.xacro\n  package_paths: [packages]\n"
        "  xacro_arguments: {side: right}\n"
        "simulation: {duration: 0.01 s}\n"
    )
    from onorbit_rs.scenario import load
    from onorbit_rs.scenario.build import build

    assert build(load(file)).model.joint_names == ["right_joint"]
    assert load(file).resolved()["robot"]["xacro_arguments"] == {"side": "right"}


@needs_xacro
def test_extensions_of_simulators_are_omitted_with_a_warning(tmp_path: Path) -> None:
    file = tmp_path / "a.xacro"
    extras = '<xacro:include filename="$(find x)/a.gazebo.xacro"/><xacro:a_gazebo/>'
    file.write_text(HEAD + extras + LINK.format("base", 1) + "</robot>")
    with pytest.warns(UserWarning) as caught:
        model = oo.Model.from_urdf(file)
    assert model.frame_names == ["base"]
    assert sum("only simulators need it" in str(warning.message) for warning in caught) == 2
    assert model.warnings == [str(warning.message) for warning in caught]


@needs_xacro
def test_an_unused_argument_is_reported(robot: Path) -> None:
    with pytest.warns(UserWarning, match="does not use the argument 'sides'; did you mean 'side'"):
        oo.Model.from_urdf(robot, package_paths=[packages(robot)], xacro_arguments={"sides": "right"})


@needs_xacro
def test_the_state_of_xacro_is_restored(robot: Path) -> None:
    import xacro
    from xacro import substitution_args

    before = (xacro.process_include, xacro.handle_macro_call, substitution_args._eval_find)
    oo.Model.from_urdf(robot, package_paths=[packages(robot)])
    with pytest.raises(oo.OnOrbitError):
        oo.Model.from_urdf(robot)
    assert before == (xacro.process_include, xacro.handle_macro_call, substitution_args._eval_find)


BODIES = {
    "argument not given": (LINK.format("$(arg zz)", 1), ("'zz' is not given", "xacro_arguments")),
    "unknown property": (LINK.format("${zz}", 1), ("'zz' is not defined",)),
    "division by zero": (LINK.format("${1/0}", 1), ("division by zero", "1/0")),
    "unknown macro": ("<xacro:foo/>" + LINK.format("a", 1), ("xacro:foo",)),
    "missing package": (
        '<xacro:include filename="$(find arm_description)/arm.xacro"/>',
        ("package 'arm_description' was not found", "package_paths="),
    ),
    "missing file of a package": (
        '<xacro:arg name="a" default="big"/><xacro:include filename="$(dirname)/$(arg a)/arm.xacro"/>',
        ("/big/arm.xacro': the file does not exist",),
    ),
    "empty argument": (
        '<xacro:arg name="model" default=""/><xacro:include filename="$(find arm)/$(arg model)/a.xacro"/>',
        ("the argument 'model' is empty", "xacro_arguments={'model': ...}"),
    ),
    "empty argument alone": (
        '<xacro:arg name="model" default=""/><xacro:include filename="$(arg model)"/>',
        ("the argument 'model' is empty",),
    ),
    "data of a missing package": (
        "<a b=\"${xacro.load_yaml('$(find arm_description)/a.yaml')}\"/>",
        ("the package 'arm_description' was not found", "package_paths="),
    ),
    "missing file": ('<xacro:include filename="other.xacro"/>', ("'other.xacro'", "does not exist")),
    "endless macro": (
        '<xacro:macro name="m"><xacro:m/></xacro:macro><xacro:m/>',
        ("nested too deeply: the macro 'm' contains itself on",),
    ),
    "a file in itself": (
        '<xacro:include filename="$(dirname)/bad.xacro"/>',
        ("nested too deeply: the file '$(dirname)/bad.xacro' contains itself on",),
    ),
    "deep": ("<a>" * 3000 + "</a>" * 3000, ("nested too deeply",)),
    "deep macro": (
        '<xacro:macro name="m">' + "<a>" * 300 + "</a>" * 300 + "</xacro:macro>"
        + "<a>" * 100 + "<xacro:m/>" + "</a>" * 100, ("nested too deeply: in the macro 'm'",),
    ),
    "no link": ("", ("no links",)),
    "macros alone": (
        '<xacro:macro name="m"><link name="a"/></xacro:macro>',
        ("macros", "give the file that calls the macros"),
    ),
    "python's own names": (LINK.format("${__import__('os').getcwd()}", 1), ("__import__",)),
    "unknown kind of joint": (
        LINK.format("a", 1) + LINK.format("b", 1)
        + '<joint name="j" type="screw"><parent link="a"/><child link="b"/></joint>',
        ("'screw'", "prismatic and a revolute"),
    ),
}  # fmt: skip


@needs_xacro
@pytest.mark.parametrize("name", BODIES)
def test_expansion_errors_name_the_file(name: str, tmp_path: Path) -> None:
    body, words = BODIES[name]
    file = tmp_path / "bad.xacro"
    file.write_text(HEAD + body + "</robot>")
    check(Bad(lambda: oo.Model.from_urdf(file), "ModelError", (str(file), *words), {"path": str(file)}))


@needs_xacro
@pytest.mark.parametrize("name", ["endless macro", "a file in itself", "deep", "deep macro"])
def test_errors_of_nesting_have_no_context(name: str, tmp_path: Path) -> None:
    """Dask registers functions that pickle the context of every error, which fails for a deep traceback."""
    file = tmp_path / "bad.xacro"
    file.write_text(HEAD + BODIES[name][0] + "</robot>")
    with pytest.raises(oo.exceptions.ModelError) as caught:
        oo.Model.from_urdf(file)
    assert caught.value.__context__ is None
    assert caught.value.__cause__ is None
    assert len(caught.traceback) < 10


@needs_xacro
def test_a_macro_that_calls_itself_as_a_loop_is_expanded(tmp_path: Path) -> None:
    file = tmp_path / "chain.xacro"
    file.write_text(
        HEAD
        + '<xacro:macro name="part" params="n">' + LINK.format("a${n}", 1)
        + '<xacro:if value="${n > 0}"><joint name="j${n}" type="fixed"><parent link="a${n}"/>'
        '<child link="a${n-1}"/></joint><xacro:part n="${n-1}"/></xacro:if></xacro:macro>'
        '<xacro:part n="60"/></robot>'
    )  # fmt: skip
    assert oo.Model.from_urdf(file).mass == 61.0


@needs_xacro
def test_fixes_are_suggested_in_the_callers_terms(tmp_path: Path) -> None:
    """These are parameters of Python, options of the command line or keys of a scenario."""
    robot, scenario = tmp_path / "bad.xacro", tmp_path / "bad.yaml"
    scenario.write_text("name: a\nrobot: bad.xacro\nsimulation: {duration: 1, time_step: 0.1}\n")
    package, argument = '<xacro:include filename="$(find arm)/a"/>', '<a b="$(arg zz)"/>'
    given = "robot.xacro_arguments: {zz: ...}"
    for body, python, command_line, keys in (
        (package, "package_paths=", "--package-path", "robot.package_paths"),
        (argument, "xacro_arguments={'zz': ...}", "--arg zz=VALUE", given),
    ):
        robot.write_text(HEAD + body + "</robot>")
        with pytest.raises(oo.OnOrbitError) as caught:
            oo.Model.from_urdf(robot)
        assert str(caught.value).endswith(f"with {python}")
        for command in ("info", "new"):
            assert refusal(command, robot).endswith(f"with {command_line}")
        assert f"with {keys}" in refusal("check", scenario)


@needs_xacro
@pytest.mark.parametrize(
    ("content", "word"),
    [
        (b"", "empty"),
        (b"\xff\xfe<\x00r\x00", "UTF-8"),
        (b"hello", "not valid XML"),
        (b"<robot><xacro:foo/></robot>", "xmlns:xacro"),
        (b"<robot", "not valid XML"),
    ],
)
def test_files_that_are_not_xacro(content: bytes, word: str, tmp_path: Path) -> None:
    file = tmp_path / "bad.xacro"
    file.write_bytes(content)
    check(Bad(lambda: oo.Model.from_urdf(file), "ModelError", (str(file), word)))


def test_missing_files_are_reported(tmp_path: Path) -> None:
    check(
        Bad(lambda: oo.Model.from_urdf(tmp_path / "no.xacro"), "NotFoundError", ("no.xacro", "no such file"))
    )
    folder = tmp_path / "folder.xacro"
    folder.mkdir()
    check(Bad(lambda: oo.Model.from_urdf(folder), "ReadError", ("folder",)))


def test_without_xacro_the_error_says_what_to_install(tmp_path: Path) -> None:
    file = tmp_path / "a.xacro"
    file.write_text(ROBOT)
    program = (
        "import sys; sys.modules['xacro'] = None\nimport onorbit_rs as oo\n"
        f"try:\n    oo.Model.from_urdf({str(file)!r})\nexcept oo.exceptions.ModelError as e:\n    print(e)"
    )
    done = subprocess.run([sys.executable, "-c", program], capture_output=True, text=True, check=True)
    assert done.stdout.strip().endswith("pip install 'onorbit-rs[xacro]'")


@needs_xacro
def test_a_package_with_macros_arguments_and_includes() -> None:
    package = Path(__file__).parent / "fixtures" / "robots" / "long_arm_description"
    file = package / "urdf" / "long_arm.urdf.xacro"

    def load(**arguments: object) -> oo.Model:
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")  # they are checked below
            return oo.Model.from_urdf(file, xacro_arguments=arguments)

    model = load()
    assert (len(model.bodies), len(model.frames)) == (8, 9)
    assert model.mass == pytest.approx(2 * 240 + 4 * 110 + (45 + 40) * 7, rel=1e-15)
    assert load(boom_length=3).mass == pytest.approx(model.mass - (45 + 40) * 4, rel=1e-15)
    # columns 0.35 m wide: two of 7 m between four of 0.45 m, on one of 0.9 m
    boom = next(body for body in model.bodies if body.name == "upper_boom")
    np.testing.assert_allclose(np.diag(boom.inertia), [*[315 / 12 * (0.35**2 + 7**2)] * 2, 315 / 6 * 0.35**2])
    stage, latch = (model.frame_pose(model.neutral(), name) for name in ("stage", "latch"))
    np.testing.assert_allclose(
        (np.linalg.inv(stage) @ latch)[:3, 3], [0, 0, 0.9 + 4 * 0.45 + 2 * 7], atol=1e-14
    )
    assert model.joints[0].upper == pytest.approx(np.radians(270), rel=1e-15)
    assert any("long_arm.gazebo.xacro' does not exist" in warning for warning in model.warnings)
    assert any("<xacro:long_arm_gazebo>" in warning for warning in model.warnings)
    assert any("8 mesh files were not found" in warning for warning in model.warnings)
    assert len(load(simulated="false").warnings) == 1  # the meshes
