"""Error messages of invalid scenarios: line, value found, accepted values, suggested fix."""

from __future__ import annotations

import warnings
from pathlib import Path

import pytest

from onorbit_rs import Model, robots, run, scenarios
from onorbit_rs.common.suggestions import nearest
from onorbit_rs.exceptions import ControlError, DtypeError, InputError, NotFoundError, OnOrbitError
from onorbit_rs.scenario import load
from onorbit_rs.scenario.build import build
from onorbit_rs.scenario.control.computed_torque import ComputedTorqueController

ROBOT = "robot: humanoid_torso\n"
RUN = "simulation: {duration: 1 s}\n"
LAW = ROBOT + "tool: tool\ncontroller: computed_torque\n" + RUN
ORBIT = LAW + "orbit: {semi_major_axis: 6778 km}\n"
TARGET = LAW + "reference:\n  kind: hold\n  frame:\n    target:\n      velocity: [1, 0, 0]\n"
LINE = LAW + "reference: {kind: line, duration: 1, goal: {displacement: [0.1, 0, 0]}"
JOINTS = ROBOT + RUN

# name: text, line and place in the message, words of the message
WRONG: dict[str, tuple[str, str, tuple[str, ...]]] = {
    "target, other word": (
        TARGET + "      angular_velocity: [0, 0, 0.1]\n",
        "10: reference.frame.target.angular_velocity",
        ("did you mean 'spin'?", "known keys: position, attitude, velocity, spin, size"),
    ),
    "target, misspelt": (
        TARGET + "      atitude: 1\n",
        "10: reference.frame.target.atitude",
        ("did you mean 'attitude'?",),
    ),
    "target, unit": (
        TARGET + "      spin: [0, 0, 1 deg]\n",
        "10: reference.frame.target.spin[2]",
        ("not an angular rate", "deg/s"),
    ),
    "target, empty": (
        LAW + "reference:\n  kind: hold\n  frame:\n    target:\n",
        "8: reference.frame.target",
        ("must be a mapping", "not nothing"),
    ),
    "frame, misspelt key": (
        LAW + "reference: {kind: hold, frame: {targt: {}}}\n",
        "5: reference.frame.targt",
        ("did you mean 'target'?",),
    ),
    "frame, misspelt": (
        LAW + "reference: {kind: hold, frame: wrold}\n",
        "5: reference.frame",
        ("'wrold'", "did you mean 'world'?", "world, lvlh, base, SYSTEM/FRAME, or {target: {position"),
    ),
    "frame, a list": (
        LAW + "reference: {kind: hold, frame: [1, 0, 0]}\n",
        "5: reference.frame",
        ("[1, 0, 0] is not a frame", "{target: {position"),
    ),
    "attitude, other word": (
        LAW + "initial: {attitude: {rpy: [0, 0, 0]}}\n",
        "5: initial.attitude.rpy",
        ("did you mean 'roll_pitch_yaw'?",),
    ),
    "attitude, a list": (LAW + "initial: {attitude: [0, 0, 0, 1]}\n", "5: initial.attitude", ("write",)),
    "initial, other word": (
        LAW + "initial: {spin: [0, 0, 1]}\n",
        "5: initial.spin",
        ("did you mean 'angular_velocity'?",),
    ),
    "a key that already exists": (
        LAW + "initial: {joint_rates: [0, 0, 0, 0, 0, 0, 0], joint_rate: [1]}\n",
        "5: initial.joint_rate",
        ("did you mean 'joints'?", "known keys: frame"),
    ),
    "time step, other word": (
        ROBOT + "simulation: {duration: 1, dt: 0.1}\n",
        "2: simulation.dt",
        ("did you mean 'time_step'?",),
    ),
    "kind of a reference, missing": (
        LAW + "reference: {duration: 1}\n",
        "5: reference",
        ("has no 'kind'; give one of hold, line_parabola, line,",),
    ),
    "kind of an effect, missing": (
        ORBIT + "environment:\n  - {body: base}\n",
        "7: environment[0]",
        ("has no 'kind'; give one of gravity_field,", "body_wrench"),
    ),
    "kind of a controller, missing": (
        JOINTS + "controllers: [{name: a}]\n",
        "3: controllers[0]",
        ("has no 'kind'; give one of computed_torque,",),
    ),
    "kind, misspelt": (LAW + "orbit: {kind: keplr}\n", "5: orbit.kind", ("did you mean 'kepler'?",)),
    "kind, a number": (JOINTS + "controller: 5\n", "3: controller", ("'kind' (computed_torque", "not 5")),
    "effect, empty": (
        ORBIT + "environment:\n  -\n",
        "7: environment[0]",
        ("mapping with a 'kind'", "not nothing"),
    ),
    "key of another kind": (
        LINE + ", height: [0, 0, 1]}\n",
        "5: reference.height",
        ("unknown key for kind 'line'", "a key of line_parabola"),
    ),
    "key of another orbit": (
        LAW + "orbit: {semi_major_axis: 6778 km, gravity_mode: carried}\n",
        "5: orbit.gravity_mode",
        ("for kind 'kepler'", "it is a key of sgp4, custom_path, fixed_frame"),
    ),
    "key of the orbit beside it": (
        ORBIT + "gravity_mode: carried\n",
        "6: gravity_mode",
        ("unknown key; it belongs in 'orbit'",),
    ),
    "key of the simulation beside it": (ORBIT + "duration: 3 s\n", "6: duration", ("in 'simulation'",)),
    "key of two parts beside them": (ORBIT + "attitude: 3\n", "6: attitude", ("in 'orbit' or 'initial'",)),
    "kind beside all parts": (ORBIT + "kind: kepler\n", "6: kind", ("unknown key",)),
    "gain by its other name": (
        JOINTS + "controller: {kind: joint_pid, kp: 5}\n",
        "3: controller.kp",
        ("unknown key for kind 'joint_pid'; did you mean 'p'?",),
    ),
    "gain of one of several by its other name": (
        JOINTS + "controllers: [{name: a, kind: joint_pid, p: 1, kd: 5}]\n",
        "3: controllers[0].kd",
        ("did you mean 'd'?",),
    ),
    "two lines as a list": (
        LAW + "orbit:\n  kind: sgp4\n  tle:\n    - 1 25544U\n    - 2 25544\n",
        "7: orbit.tle",
        ("must be text, not a list; write 'tle: |'", "'line1' and 'line2'"),
    ),
    "air, misspelt": (
        ORBIT + "environment: [{kind: drag, atmosphere: exponantial}]\n",
        "6: environment[0].atmosphere.kind",
        ("did you mean 'exponential'?",),
    ),
    "surface of one body": (
        ORBIT + "environment: [{kind: drag, bodies: {torso: {kind: cannonball, aera: 1}}}]\n",
        "6: environment[0].bodies.torso.aera",
        ("did you mean 'area'?",),
    ),
    "index, too few": (
        ORBIT + "environment: [{kind: drag, atmosphere: {kind: nrlmsise00, ap: [1, 2]}}]\n",
        "6: environment[0].atmosphere.ap",
        ("ap is a list with 2 entries; give the daily value as one number, or NRLMSISE-00's list of seven",),
    ),
    "index, a word": (
        ORBIT + "environment: [{kind: drag, atmosphere: {kind: nrlmsise00, ap: high}}]\n",
        "6: environment[0].atmosphere.ap",
        ("'high' is not a plain number",),
    ),
    "effects, no list": (
        ORBIT + "environment: gravity_gradient\n",
        "6: environment",
        ("must be a list", "start with '- '"),
    ),
    "effects, nothing": (ORBIT + "environment:\n", "6: environment", ("must be a list", "not nothing")),
    "force, no list": (
        ORBIT + "environment: [{kind: body_wrench, body: torso, force: 5 N}]\n",
        "6: environment[0].force",
        ("must be a list", "not '5 N'"),
    ),
    "argument of xacro": (
        "robot: {urdf: a.xacro, xacro_arguments: {side: [left]}}\n" + RUN,
        "1: robot.xacro_arguments.side",
        ("text, a number, true or false, not ['left']",),
    ),
    "robot, missing": (RUN, "1: robot", ("is missing", "a URDF", "rigid_body")),
    "simulation, missing": (ROBOT, "1: simulation", ("is missing", "{duration: 10 s}")),
    "simulation, a number": (ROBOT + "simulation: 5 s\n", "2: simulation", ("must be a mapping", "'5 s'")),
    "rows, a fraction": (
        ROBOT + "simulation: {duration: 1, record_every: 2.5}\n",
        "2: simulation.record_every",
        ("must be a whole number, not 2.5",),
    ),
    "rows, too few": (
        ROBOT + "simulation: {duration: 1, record_every: 5000}\n",
        "2: simulation.record_every",
        ("5000 exceeds the number of steps, 1000", "at most 1000"),
    ),
    "rows, a switch": (
        ROBOT + "simulation: {duration: 1, record_every: true}\n",
        "2: simulation.record_every",
        ("must be a whole number, not true",),
    ),
    "elements by their letters": (
        LAW + "orbit: {a: 7000 km}\n",
        "5: orbit.a",
        ("did you mean 'semi_major_axis'?",),
    ),
    "light without an orbit": (
        LAW + "environment: [radiation_pressure]\n",
        "5: environment[0]",
        ("the effect radiation_pressure requires an orbit",),
    ),
    "unknown unit": (
        ROBOT + "simulation: {duration: 5 sec}\n",
        "2: simulation.duration",
        ("unknown unit 'sec';", "s, ms, us, min"),
    ),
    "no points": (
        LAW + "reference: {kind: waypoints, points: [], speed: 1}\n",
        "5: reference.points",
        ("has 0 entries; give at least one",),
    ),
    "a quote left open": ("robot: 'humanoid\n" + RUN, "3", ("invalid YAML", "is a quote not closed?")),
    "a sign of YAML's": ("robot: @torso\n" + RUN, "1", ("'@'", "in quotes")),
    "integrator": (
        ROBOT + "simulation: {duration: 1, integrator: euler}\n",
        "2: simulation.integrator",
        ("'rk4', 'semi_implicit_euler' or 'dormand_prince'", "did you mean 'semi_implicit_euler'?"),
    ),
    "tolerance, too large": (
        ROBOT + "simulation: {duration: 1, tolerance: 1}\n",
        "2: simulation.tolerance",
        ("above the maximum, 0.1",),
    ),
    "tolerance, a word": (
        ROBOT + "simulation: {duration: 1, tolerance: tight}\n",
        "2: simulation.tolerance",
        ("'tight' is not a plain number",),
    ),
    "duration, nothing": (
        ROBOT + "simulation: {duration: }\n",
        "2: simulation.duration",
        ("nothing is not a time", "min, h, day"),
    ),
    "drift, a word": (
        ROBOT + "simulation: {duration: 1, rereference_beyond: always}\n",
        "2: simulation.rereference_beyond",
        ("is not a length", "give a number in m, or", ", or 'never'"),
    ),
    "a switch": (
        ROBOT + "simulation: {duration: 1, enforce_limits: perhaps}\n",
        "2: simulation.enforce_limits",
        ("true or false, not 'perhaps'",),
    ),
    "text, a number": (LAW.replace("tool: tool", "tool: 5"), "2: tool", ("must be text", "not 5")),
    "times of points": (
        LAW + "reference: {kind: waypoints, times: [1, 2], points: [{displacement: [0, 0, 0]}]}\n",
        "5: reference",
        ("'times' has 2 entries for 1 point;",),
    ),
    "times of moves": (
        JOINTS
        + "controller: joint_computed_torque\nreference:\n  kind: joint_ramps\n  times: [1, 2]\n"
        + "  moves: [{joint: arm_joint_1, to: 1}]\n",
        "4: reference",
        ("'times' has 2 entries for 1 move;",),
    ),
    "one entry": (
        JOINTS + "initial: {position: [1]}\n",
        "3: initial.position",
        ("has 1 entry; give 3",),
    ),
    "a step of no time": (
        ROBOT + "simulation: {duration: 1e-298, time_step: 1e-300}\n",
        "2: simulation",
        ("time_step is 1e-300 s; it must be between 1e-12 and 1e9 s",),
    ),
    "a spin beyond all": (
        JOINTS + "initial: {angular_velocity: [1e200, 0, 0]}\n",
        "3: initial",
        ("the angular velocity of the base about x, is 1e200 rad/s", "below 1e9 rad/s"),
    ),
    "beyond the speed of light": (
        JOINTS + "initial: {linear_velocity: [0, 4e5 km/s, 0]}\n",
        "3: initial",
        ("velocity of the base along y, is 400000000 m/s", "299792458 m/s, the speed of light"),
    ),
    "noise of a conversion": (
        LAW + "orbit: {kind: kepler, semi_major_axis: 700.1 km}\n",
        "5: orbit",
        ("700100 m",),
    ),
    "no gains": (
        JOINTS + "controller: joint_pid\n",
        "3: controller",
        ("has no gains", "'p', 'i' or 'd'"),
    ),
    "name of a controller": (
        JOINTS + "controllers: [{kind: joint_pid, p: 1, name: a b}]\n",
        "3: controllers[0].name",
        ("'a b'", "letters, digits"),
    ),
    "a key that is a number": (ROBOT + "5: x\n" + RUN, "2", ("must be text, not 5",)),
    "keys merged": (
        ROBOT + "simulation:\n  <<: {duration: 1}\n",
        "3",
        ("'<<'", "write the keys"),
    ),
    "a tab": (ROBOT + "simulation:\n\tduration: 5\n", "3", ("invalid YAML", "with spaces instead of tabs")),
    "a colon left out": ("robot humanoid_torso\n" + RUN, "2", ("invalid YAML", "is a ':' missing above")),
    "two scenarios": (JOINTS + "---\n" + JOINTS, "3", ("invalid YAML", "a file contains one scenario")),
    "an alias of nothing": (ROBOT + "simulation: *run\n", "2", ("'run'", "define the alias with '&' above")),
    "a tag": ("robot: !robot x\n" + RUN, "1", ("'!robot'", "tags ('!') are not supported")),
    "a bracket left open": (
        ROBOT + "initial: {joints: [1, 2\n" + RUN,
        "3",
        ("invalid YAML", "bracket or brace not closed"),
    ),
}  # fmt: skip


@pytest.mark.parametrize("name", WRONG)
def test_an_invalid_scenario_is_reported_with_line_and_fix(tmp_path: Path, name: str) -> None:
    text, place, words = WRONG[name]
    file = tmp_path / "mine.yaml"
    file.write_text(text)
    with pytest.raises(OnOrbitError) as caught, warnings.catch_warnings():
        warnings.simplefilter("ignore")
        build(load(file))
    message = str(caught.value)
    assert message.startswith(f"{file}:{place}: "), message
    assert all(word in message for word in words), message
    assert "more)" not in message and "\n" not in message and "pydantic" not in message.lower(), message


def test_a_tool_on_few_joints_is_reported_with_suitable_control_laws() -> None:
    hinge = (
        "<robot name='r'>"
        + "".join(
            f"<link name='{link}'><inertial><mass value='1'/>"
            "<inertia ixx='1' iyy='1' izz='1' ixy='0' ixz='0' iyz='0'/></inertial></link>"
            for link in ("base", "hand")
        )
        + "<joint name='j' type='continuous'><parent link='base'/><child link='hand'/></joint></robot>"
    )
    model = Model.from_urdf_string(hinge)
    with pytest.raises(ControlError, match=r"moved by 1 joint.*use joint_computed_torque.*or compliance"):
        ComputedTorqueController().build_law(model, "hand", Path())
    with pytest.raises(ControlError) as caught:  # negative control: a wrong gain has another message
        ComputedTorqueController(kp=-1.0).build_law(robots.load("humanoid_torso"), "tool", Path())
    assert "compliance" not in str(caught.value)


def test_an_empty_scenario_suggests_how_to_start(tmp_path: Path) -> None:
    (tmp_path / "empty.yaml").write_text("# nothing yet\n")
    with pytest.raises(
        OnOrbitError,
        match=r"the content is empty; a scenario must be a mapping of keys to values \(onorbit new writes",
    ):
        load(tmp_path / "empty.yaml")


@pytest.mark.parametrize(
    "extra", ["controller: {kind: joint_pid, p: 0}\n", "controller: {kind: joint_pid, i: 1}\n"]
)
def test_given_gains_are_accepted(tmp_path: Path, extra: str) -> None:
    """Zero is accepted, too: a sweep of gains may start there, and resolved scenarios contain it."""
    (tmp_path / "mine.yaml").write_text(JOINTS + extra)
    scenario = load(tmp_path / "mine.yaml")
    assert load(scenario.resolved()).resolved() == scenario.resolved()


@pytest.mark.parametrize("source", [5, None, ["humanoid_reach"]])
def test_arguments_that_are_not_scenarios_are_reported(source: object) -> None:
    with pytest.raises(
        DtypeError, match=r"\((int|NoneType|list)\) is not a scenario; give a bundled name"
    ) as caught:
        run(source, quiet=True)  # type: ignore[arg-type]  # that is what is tested
    assert isinstance(caught.value, TypeError)


def test_an_unknown_bundled_scenario_suggests_the_nearest_name() -> None:
    with pytest.raises(NotFoundError, match="did you mean 'humanoid_reach'"):
        scenarios.path("humanoid_rech")
    assert scenarios.path("humanoid_reach").is_file()


def test_a_part_of_a_name_suggests_it() -> None:
    integrators = ("rk4", "semi_implicit_euler", "dormand_prince")
    assert nearest("euler", integrators) == "semi_implicit_euler"
    assert nearest("prince", integrators) == "dormand_prince"
    assert nearest("i", integrators) is None
    assert nearest("arm", ("arm_left_link", "arm_right_link")) is None


@pytest.mark.parametrize(
    "every", ["5", None, True, -1.0, float("nan"), float("inf"), pytest.param(10**400, id="vast")]
)
def test_an_invalid_checkpoint_interval_is_reported(every: object) -> None:
    with pytest.raises(InputError, match=r"checkpoint_every is .* a finite number of seconds, at least 0"):
        run("free_tumble", quiet=True, checkpoint_every=every)  # type: ignore[arg-type]  # that is what is tested
