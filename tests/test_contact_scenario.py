"""Contacts in a scenario: keys, units, errors with their lines, output folder and bundled scenarios."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import pytest
import yaml
from contact_worlds import moving, run
from world_runs import built, data

import onorbit_rs as oo
from onorbit_rs.cli import main
from onorbit_rs.exceptions import OnOrbitError, ScenarioError
from onorbit_rs.output.read import SavedRun
from onorbit_rs.output.saved_world import systems_in
from onorbit_rs.scenario import load
from onorbit_rs.scenario.connections import connected_groups, touching

TEXT = """\
systems:
  a: {robot: ball, initial: {linear_velocity: [20 cm/s, 0, 0]}}
  b: {robot: ball, initial: {position: [22 cm, 0, 0]}}
contacts:
  - name: touch
    between: [a/body, b/*]
    normal: {kind: hunt_crossley, stiffness: 1e6, restitution: 0.8, speed: 20 cm/s}
    friction: {static: 0.5, kinetic: 0.4}
simulation: {duration: 0.2 s, time_step: 2 ms}
"""


HUNT: dict[str, Any] = {"kind": "hunt_crossley", "stiffness": 1e6}


def changed(contact: dict[str, Any]) -> dict[str, Any]:
    """Returns the scenario with other entries of its contact; None removes an entry."""
    values = data(TEXT)
    merged = values["contacts"][0] | contact
    values["contacts"][0] = {key: value for key, value in merged.items() if value is not None}
    return values


def test_the_run_equals_that_of_the_same_world_in_python() -> None:
    law = oo.HuntCrossley(1e6, restitution=0.8, speed=0.2)
    contact = oo.Contact("a/body", "b/*", normal=law, friction=oo.Friction(0.5, 0.4), name="touch")
    systems = [moving("a", [0, 0, 0], [0.2, 0, 0]), moving("b", [0.22, 0, 0], [0, 0, 0])]
    expected = run(oo.World(systems, contacts=[contact]))
    found: Any = oo.run(data(TEXT), quiet=True)
    assert found.summary["certificate_passed"]
    for name in "ab":
        np.testing.assert_array_equal(found.trace[name].q, expected[name].q)
    np.testing.assert_array_equal(found.trace.contacts["touch"].values, expected.contacts["touch"].values)


@pytest.mark.usefixtures("no_pictures")
def test_the_output_folder_holds_the_contacts(tmp_path: Path) -> None:
    values = changed({"name": None, "between": [["a/body"], "b/body"]})
    trace: Any = oo.run(values, tmp_path / "run", quiet=True).trace
    saved = SavedRun(tmp_path / "run").world_trace()
    assert list(saved.contacts) == ["a/body|b/body"] == list(trace.contacts)
    for part in ("gap", "force", "point", "normal", "slip", "power", "elastic", "dissipated"):
        own = getattr(saved.contacts["a/body|b/body"], part)
        np.testing.assert_array_equal(own, getattr(trace.contacts["a/body|b/body"], part))
    assert len(saved.contacts["a/body|b/body"]) == len(saved["a"].time)
    again = load(tmp_path / "run" / "scenario.yaml")
    np.testing.assert_array_equal(oo.run(again, quiet=True).trace["b"].q, trace["b"].q)
    oo.compare(tmp_path / "run", tmp_path / "run")
    for command in ("show", "report", "info"):
        arguments = ["--no-viewer"] if command == "show" else []
        target = str(tmp_path / "run" / "scenario.yaml") if command == "info" else str(tmp_path / "run")
        with pytest.raises(SystemExit) as done:
            main([command, target, *arguments])
        assert done.value.code == 0


def test_a_link_named_like_a_column_does_not_become_a_system() -> None:
    names = {"a/contact_x/q": 0, "a/q": 0, "b/q": 0, "b/contact_a|b/q": 0, "time": 0}
    assert systems_in(names) == ["a", "b"]


def test_units_and_short_forms() -> None:
    linear = {"kind": "hunt_crossley", "stiffness": "100 kN/m", "exponent": 1, "dissipation": "2 s/m"}
    contact = built(changed({"normal": linear, "friction": {"static": 0.3, "torsional": "1 cm"}}))
    made = contact.scenario.contacts[0].build()
    assert isinstance(made.normal, oo.HuntCrossley) and made.friction is not None
    assert (made.normal.stiffness, made.normal.exponent, made.normal.dissipation) == (1e5, 1.0, 2.0)
    assert (made.friction.kinetic, made.friction.torsional) == (0.3, 0.01)
    dashpot = {"kind": "spring_dashpot", "stiffness": "20 N/mm", "damping": "3 N s/m"}
    made = built(changed({"normal": dashpot, "friction": None})).scenario.contacts[0].build()
    assert isinstance(made.normal, oo.SpringDashpot)
    assert (made.normal.stiffness, made.normal.damping) == (2e4, 3.0)
    observed = built(changed({"normal": None, "friction": None})).scenario.contacts[0].build()
    assert observed.normal is None


@pytest.mark.parametrize(
    ("contact", "path", "words"),
    [
        ({"between": ["a/bod", "b/*"]}, "between", ["no link matches 'a/bod'", "did you mean 'a/body'"]),
        ({"between": ["c/body", "b/*"]}, "between[0]", ["no system is named 'c'"]),
        ({"between": ["a", "b/*"]}, "between[0]", ["'a' is not a link of a system", "SYSTEM/LINK"]),
        ({"between": ["a/body"]}, "between", ["list of two sides"]),
        ({"between": ["a/body", []]}, "between", ["a side is empty"]),
        ({"between": ["a/body", 3]}, "between", ["3 is not a link"]),
        ({"between": ["a/body", "a/*"]}, "between", ["same link"]),
        ({"normal": HUNT | {"stiffness": -1}}, "normal.stiffness", ["-1", "above zero"]),
        ({"normal": HUNT | {"stiffness": "1e6 N/m"}}, "normal.stiffness", ["exponent: 1"]),
        ({"normal": {**HUNT, "exponent": 0.5}}, "normal.exponent", ["0.5"]),
        ({"normal": {**HUNT, "restitution": 0.5}}, "normal.restitution",
         ["add 'speed'"]),
        ({"normal": {**HUNT, "restitution": 0, "speed": 1}},
         "normal.restitution", ["above 0 and at most 1"]),
        ({"normal": {**HUNT, "speed": 1}}, "normal.speed", ["restitution"]),
        ({"normal": {**HUNT, "damping": 1}}, "normal.damping",
         ["did you mean 'dissipation'"]),
        ({"normal": {"kind": "hertz", "stiffness": 1e6}}, "normal.kind", ["unknown kind 'hertz'"]),
        ({"normal": {"kind": "spring_dashpot", "stiffness": "1 N", "damping": 1}}, "normal.stiffness",
         ["N/m"]),
        ({"friction": {"static": -0.1}}, "friction.static", ["-0.1 is out of range; it must be zero"]),
        ({"friction": {"static": 0.1, "kinetic": 0.2}}, "friction.kinetic", ["exceeds the static"]),
        ({"normal": None}, "friction", ["add 'normal'"]),
        ({"friktion": {}, "friction": None}, "friktion", ["did you mean 'friction'"]),
    ],
)  # fmt: skip
def test_invalid_contacts_are_located(
    tmp_path: Path, contact: dict[str, Any], path: str, words: list[str]
) -> None:
    file = tmp_path / "mine.yaml"
    file.write_text(yaml.safe_dump(changed(contact)))
    with pytest.raises(OnOrbitError) as caught:
        built(file)
    message = str(caught.value)
    assert message.startswith(f"{file}:") and f": contacts[0].{path}: " in message, message
    for word in words:
        assert word in message, message


def test_an_overlap_at_the_start_is_located_and_may_be_accepted() -> None:
    values = changed({})
    values["systems"]["b"]["initial"]["position"] = ["15 cm", 0, 0]
    with pytest.raises(
        OnOrbitError,
        match=r"contacts\[0\].between: contact 'touch': at the start, "
        r"the links 'a/body' and 'b/body' overlap by 0.05 m",
    ):
        built(values)
    values["contacts"][0]["start_overlapping"] = True
    built(values)


def test_names_are_unique() -> None:
    twice = data(TEXT)
    twice["contacts"] *= 2
    with pytest.raises(ScenarioError, match=r"contacts\[1\].name: two contacts are named 'touch'"):
        load(twice)


def test_systems_that_may_touch_form_a_group_in_figures_and_viewer() -> None:
    values = data(TEXT)
    values["systems"]["far"] = {"robot": "ball", "initial": {"position": [0, "5 m", 0]}}
    world = built(values)
    models = {name: alone.model for name, alone in world.systems.items()}
    found = touching(world.scenario, models)
    assert found == (("a", "b"),)
    assert connected_groups(list(models), (), found) == [["a", "b"]]


def test_the_command_info_shows_contacts(capsys: pytest.CaptureFixture[str]) -> None:
    for arguments in ([], ["--json"]):
        with pytest.raises(SystemExit) as done:
            main(["info", "push_and_drift", *arguments])
        assert done.value.code == 0
    shown = capsys.readouterr().out
    rows = [line.split() for line in shown.splitlines()]
    assert "push_and_drift: 2 systems, 1 contact, 0 events" in shown and "moves alone" not in shown
    assert ["push", "pusher/pad", "box/body", "hunt_crossley", "0.6"] in rows
    assert '"between": [' in shown


def test_two_spheres_leave_with_the_spins_of_coulomb_friction() -> None:
    trace: Any = oo.run("two_spheres", quiet=True).trace
    a, b = trace["still"], trace["moving"]
    impulse = a.momentum[-1, :3]
    lines = trace.contacts["impact"]
    normal = lines.normal[int(np.argmax(np.linalg.norm(lines.force, axis=1)))]
    along = float(impulse @ -normal)
    assert along == pytest.approx(2.0 * 1.8 * 0.1 * np.cos(np.pi / 6), rel=2e-3)
    across = np.linalg.norm(impulse + along * normal)
    assert 0.0 < across <= 0.3 * along
    assert abs(a.v[-1, 5]) * 0.016 == pytest.approx(0.1 * across, rel=5e-3)
    assert a.v[-1, 5] == pytest.approx(b.v[-1, 5], rel=1e-6)


def test_a_pushed_box_drifts_away_and_the_pusher_recoils() -> None:
    trace: Any = oo.run("push_and_drift", quiet=True).trace
    push, time = trace.contacts["push"], trace["box"].time
    pressed = time[np.linalg.norm(push.force, axis=1) > 0.0]
    assert pressed[-1] - pressed[0] > 1.0 and pressed[-1] < 4.0
    momentum = trace["box"].momentum[-1, 0]
    assert momentum > 1.5 and trace["pusher"].momentum[-1, 0] == pytest.approx(-momentum, rel=1e-3)
    assert push.gap[-1] > 0.3 and abs(trace["box"].v[-1, 5]) > 0.01


def test_five_touches_brake_the_spin_of_debris_and_the_servicer_takes_it() -> None:
    result = oo.run("tumbling_debris_brake", quiet=True)
    assert result.summary["certificate_passed"]
    trace: Any = result.trace
    touch, time = trace.contacts["brake"], trace["debris"].time
    presses = np.linalg.norm(touch.force, axis=1) > 0.5  # N
    begins = time[1:][np.diff(presses.astype(int)) == 1]
    assert len(begins) == 5 and begins[0] < 2.0
    spin = np.abs(np.degrees(trace["debris"].v[:, 5]))
    assert spin[0] == pytest.approx(5.0) and spin[-1] < 2.0
    for begin in begins:  # each touch takes spin
        before, after = np.searchsorted(time, [begin - 0.5, begin + 1.5])
        assert spin[before] - spin[after] > 0.3, begin
    # what the debris loses, the servicer gains; gravity changes the sum by 1 %
    about = np.zeros((2, 2))
    for i, name in enumerate(("servicer", "debris")):
        system = trace[name]
        total = system.momentum[:, 3:] + np.cross(system.center_of_mass, system.momentum[:, :3])
        about[i] = total[[0, -1], 2]
    exchanged = about[0, 1] - about[0, 0]
    assert exchanged > 0.5 and abs(about.sum(axis=0) @ [-1.0, 1.0]) < 0.05 * exchanged
    servicer = trace["servicer"]
    assert np.linalg.norm(servicer.position_error, axis=1).max() < 0.06
    assert np.degrees(np.linalg.norm(servicer.v[-1, 3:6])) < 0.15
    assert (np.abs(trace["debris"].q[:, :3] - [2.3, 0.0, 0.6]) < 0.06).all()  # it stays in its place


def test_without_friction_the_touches_take_no_spin() -> None:
    values = load("tumbling_debris_brake").resolved(
        Path(str(oo.scenarios.path("tumbling_debris_brake"))).parent
    )
    del values["contacts"][0]["friction"]
    values["simulation"]["duration"] = 5.0
    trace: Any = oo.run(values, quiet=True).trace
    assert trace.contacts["brake"].force.any()
    assert np.degrees(trace["debris"].v[-1, 5]) == pytest.approx(5.0, abs=0.01)
