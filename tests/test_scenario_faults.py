"""All errors of a scenario at once, also of different stages, and none that another error has caused."""

from __future__ import annotations

from pathlib import Path

import pytest

import onorbit_rs as oo
from onorbit_rs.exceptions import FrameError, NotFoundError, OnOrbitError, ScenarioError

SINGLE = """\
robot: humanoid_torso
tool: tool
orbit: {kind: kepler, semi_major_axis: 7000 km}
environment:
  - {kind: gravity_gradient}
  - {kind: gravity_field, model: zonal, degree: 2}
controllers:
  - {kind: joint_pid, name: a, joints: [arm_joint_1], p: 1, d: 1, reference: {kind: joint_hold}}
  - {kind: joint_pid, name: b, joints: [arm_joint_2], p: 1, d: 1, reference: {kind: joint_hold}}
initial: {joints: {arm_joint_1: 0.1}}
simulation: {duration: 1, time_step: 1 ms}
"""
WORLD = """\
systems:
  chaser: {robot: servicer, tool: tool, initial: {joints: {joint_1: 0.1}}}
  target: {robot: target_satellite, tool: handle}
contacts: []
simulation: {duration: 1, time_step: 1 ms}
"""


def errors_of(folder: Path, text: str, *changes: tuple[str, str]) -> list[str]:
    """Returns the errors of a scenario whose text was changed, without the file: ``line: key: message``."""
    for before, after in changes:
        assert text.count(before) == 1, before
        text = text.replace(before, after)
    file = folder / "wrong.yaml"
    file.write_text(text)
    with pytest.raises(OnOrbitError) as caught:
        oo.run(file, quiet=True)
    error = caught.value
    assert isinstance(error, ScenarioError) or not hasattr(error, "errors")
    found = str(error).replace(f"{file}:", "").splitlines()
    assert len(found) == max(1, len(getattr(error, "errors", ())))
    return found


def starts(found: list[str]) -> list[str]:
    """Returns the lines and keys of the errors."""
    return [": ".join(error.split(": ")[:2]) for error in found]


@pytest.mark.parametrize("text", [SINGLE, WORLD])
def test_the_unchanged_scenario_is_valid(text: str, tmp_path: Path) -> None:
    file = tmp_path / "right.yaml"
    file.write_text(text)
    assert len(oo.run(file, quiet=True, changes={"simulation.duration": "2 ms"}).trace) == 3


def test_unknown_keys_do_not_hide_wrong_values(tmp_path: Path) -> None:
    found = errors_of(
        tmp_path, SINGLE,
        ("7000 km", "7000 s, inclinaton: 3, eccentricity: -1"),
        ("[arm_joint_1], p: 1, d: 1", "[arm_joint_1], pp: 1, d: x"),
        ("duration: 1,", "duration: -1, foo: 2,"),
    )  # fmt: skip
    assert starts(found) == [
        "3: orbit.inclinaton", "3: orbit.semi_major_axis", "3: orbit.eccentricity",
        "8: controllers[0].pp", "8: controllers[0].d",
        "11: simulation.foo", "11: simulation.duration",
    ]  # fmt: skip


def test_all_unknown_keys_of_a_part_are_reported(tmp_path: Path) -> None:
    found = errors_of(tmp_path, SINGLE, ("duration: 1,", "duration: 1, foo: 2, bar: 3,"))
    assert starts(found) == ["11: simulation.foo", "11: simulation.bar"]


def test_a_misspelt_key_is_not_also_missing(tmp_path: Path) -> None:
    (only,) = errors_of(tmp_path, SINGLE, ("duration: 1,", "duraton: 1,"))
    assert "simulation.duraton: unknown key; did you mean 'duration'?" in only
    (only,) = errors_of(tmp_path, SINGLE, ("semi_major_axis", "semi_mayor_axis"))
    assert "did you mean 'semi_major_axis'?" in only
    (only,) = errors_of(tmp_path, SINGLE, ("orbit: {", "orbti: {"))
    assert "orbti: unknown key; did you mean 'orbit'?" in only, "the effects require the orbit"


def test_wrong_values_do_not_hide_the_errors_of_the_robot(tmp_path: Path) -> None:
    more = ("duration: 1,", "duration: -1,")
    found = errors_of(tmp_path, SINGLE, ("humanoid_torso", "humanoid_torsoo"), more)
    assert starts(found) == ["1: robot", "11: simulation.duration"]
    assert "did you mean 'humanoid_torso'?" in found[0]
    found = errors_of(tmp_path, SINGLE, ("tool: tool", "tool: toool"), ("{arm_joint_1: 0.1}", "[1, 2]"), more)
    assert starts(found) == ["2: tool", "10: initial", "11: simulation.duration"]


def test_the_robot_does_not_hide_the_errors_of_other_parts(tmp_path: Path) -> None:
    found = errors_of(
        tmp_path, SINGLE,
        ("humanoid_torso", "nowhere.urdf"), ("model: zonal", "model: nowhere.gfc"),
        ("time_step: 1 ms", "time_step: 1 ms, record_every: 2000"),
    )  # fmt: skip
    assert starts(found) == ["1: robot", "6: environment[1]", "11: simulation.record_every"]


def test_parts_of_the_robot_do_not_hide_each_other(tmp_path: Path) -> None:
    found = errors_of(
        tmp_path, SINGLE,
        ("tool: tool", "tool: tool\nactuators: [{brake: one, joint: nowhere, slip_torque: 1}]"),
        ("{arm_joint_1: 0.1}", "{nowhere: 0.1}"),
        ("[arm_joint_1]", "[nowhere]"), ("[arm_joint_2]", "[there]"),
    )  # fmt: skip
    assert starts(found) == ["3: actuators[0]", "11: initial"]
    found = errors_of(
        tmp_path, SINGLE,
        ("{arm_joint_1: 0.1}", "{nowhere: 0.1}"),
        ("[arm_joint_1]", "[nowhere]"), ("[arm_joint_2]", "[there]"),
    )  # fmt: skip
    assert starts(found) == ["8: controllers[0]", "9: controllers[1]", "10: initial"]


def test_an_unknown_tool_is_one_error(tmp_path: Path) -> None:
    text = SINGLE[: SINGLE.index("controllers:")] + "simulation: {duration: 1, time_step: 1 ms}\n"
    text += "controller: {kind: computed_torque, kp: 1, kd: 1}\n"
    (only,) = errors_of(tmp_path, text, ("tool: tool", "tool: toool"))
    assert starts([only]) == ["2: tool"]


def test_a_single_error_keeps_its_class(tmp_path: Path) -> None:
    for (before, after), kind in (
        (("humanoid_torso", "humanoid_torsoo"), NotFoundError),
        (("tool: tool", "tool: toool"), FrameError),
    ):
        file = tmp_path / "one.yaml"
        file.write_text(SINGLE.replace(before, after))
        with pytest.raises(kind):
            oo.run(file, quiet=True)


def test_systems_do_not_hide_each_other(tmp_path: Path) -> None:
    found = errors_of(
        tmp_path, WORLD,
        ("robot: servicer", "robot: servicerr"), ("tool: handle", "tool: handel"),
        ("duration: 1,", "duration: x,"),
    )  # fmt: skip
    assert starts(found) == ["2: systems.chaser.robot", "3: systems.target.tool", "5: simulation.duration"]
    found = errors_of(tmp_path, WORLD, ("joint_1: 0.1", "nowhere: 0.1"), ("tool: handle", "tool: handel"))
    assert starts(found) == ["3: systems.target.tool"]
    found = errors_of(
        tmp_path, WORLD,
        ("joint_1: 0.1", "nowhere: 0.1"), ("tool: handle", "tool: handle, initial: {joints: [1]}"),
    )  # fmt: skip
    assert starts(found) == ["2: systems.chaser.initial", "3: systems.target.initial"]


def test_entries_of_wrong_types_do_not_hide_the_others(tmp_path: Path) -> None:
    found = errors_of(tmp_path, SINGLE, ("initial: {joints: {arm_joint_1: 0.1}}", "initial: 3"),
                      ("tool: tool", "tool: toool"))  # fmt: skip
    assert starts(found) == ["2: tool", "10: initial"]
    found = errors_of(tmp_path, "systems: [1]\nsimulation: {duration: x}\n")
    assert starts(found) == ["1: systems", "2: simulation.duration"]


def test_no_python_code_runs_to_find_errors(tmp_path: Path) -> None:
    (tmp_path / "law.py").write_text("raise SystemExit('executed')")
    law = f"controller: {{kind: python, file: {tmp_path / 'law.py'}, class: Law}}\n"
    text = SINGLE[: SINGLE.index("controllers:")] + law + "simulation: {duration: -1}\n"
    found = errors_of(tmp_path, text, ("tool: tool", "tool: toool"))
    assert starts(found) == ["2: tool", "8: simulation.duration"]


def test_an_unknown_key_does_not_hide_a_wrong_type_of_a_path(tmp_path: Path) -> None:
    """Regression: pydantic does not know the type of this error by its name."""
    found = errors_of(tmp_path, SINGLE, ("robot: humanoid_torso", "robot: {urdf: 3, foo: 1}"))
    assert starts(found) == ["1: robot.foo", "1: robot.urdf"]


def test_keys_of_another_kind_do_not_hide_keys_of_no_kind(tmp_path: Path) -> None:
    found = errors_of(tmp_path, SINGLE, ("7000 km", "7000 km, line1: 1, foo: 2"))
    assert starts(found) == ["3: orbit.line1", "3: orbit.foo"]
    assert "it is a key of sgp4" in found[0] and "known keys" in found[1]


def test_other_errors_do_not_cause_errors_of_references(tmp_path: Path) -> None:
    """Regression: the reference was built at another position than that of the joints."""
    homing = "reference: {kind: joint_waypoints, points: [{arm_joint_1: 0.0}], speed: 0.1, acceleration: 0.1}"
    law = "[arm_joint_1], p: 1, d: 1, "
    home = (law + "reference: {kind: joint_hold}", law + homing)
    (tmp_path / "valid.yaml").write_text(SINGLE.replace(*home))
    oo.run(tmp_path / "valid.yaml", quiet=True, changes={"simulation.duration": "2 ms"})
    (only,) = errors_of(tmp_path, SINGLE, home, ("time_step: 1 ms", "time_step: 1 ms, record_every: 2000"))
    assert starts([only]) == ["11: simulation.record_every"]


def test_several_errors_have_the_location_of_the_first(tmp_path: Path) -> None:
    file = tmp_path / "wrong.yaml"
    file.write_text(SINGLE.replace("tool: tool", "tool: toool").replace("0.1}", "0.1, nowhere: 1}"))
    with pytest.raises(ScenarioError) as caught:
        oo.run(file, quiet=True)
    error = caught.value
    assert (error.file, error.path, error.line) == (str(file), "tool", 2)
    file.write_text(SINGLE.replace("humanoid_torso", "nowhere.urdf").replace("duration: 1,", "duration: -1,"))
    with pytest.raises(ScenarioError) as caught:
        oo.scenario.load(file)
    assert (caught.value.file, caught.value.path, caught.value.line) == (str(file), "robot", 1)


def test_the_unknown_tool_of_a_control_is_located_there(tmp_path: Path) -> None:
    text = SINGLE.replace("tool: tool\n", "")
    hand = "{kind: computed_torque, name: hand, tool: toool, kp: 1, kd: 1, reference: {kind: hold}}"
    (only,) = errors_of(tmp_path, text, ("initial:", f"  - {hand}\ninitial:"))
    assert starts([only]) == ["9: controllers[2].tool"]
