"""``--set``, ``--duration`` and ``changes``: new values of entries of a scenario; ``onorbit copy``."""

from __future__ import annotations

import json
from pathlib import Path

import pytest
from commands import onorbit

import onorbit_rs as oo
from onorbit_rs import scenarios
from onorbit_rs.campaigns.bundled import CAMPAIGNS
from onorbit_rs.campaigns.load import load_campaign
from onorbit_rs.campaigns.plan import digest_of, plan_of
from onorbit_rs.cli.copy import copy
from onorbit_rs.exceptions import InputError, NotFoundError, ScenarioError
from onorbit_rs.scenario import load
from onorbit_rs.scenario.changes import changed, location_of, parsed_changes


def test_changes_replace_and_add_entries() -> None:
    plain = load("humanoid_reach")
    changes = parsed_changes(["simulation.time_step=2 ms", "initial.position=[1, 0, 2 cm]"])
    scenario = load("humanoid_reach", changes=changes)
    assert scenario.simulation.time_step == 2e-3 != plain.simulation.time_step
    assert tuple(scenario.initial.position) == (1.0, 0.0, 0.02)
    again = load(plain, changes={"simulation.duration": "0.5 s"})
    assert again.simulation.duration == 0.5 and plain.simulation.duration == 6.0


def test_entries_of_lists_are_changed_by_index() -> None:
    data = {"environment": [{"kind": "drag"}, {"kind": "wrench", "force": [0, 0, 0]}]}
    given = {("environment", 1, "force"): 5, ("environment",): 1}
    new, lines = changed(data, given, {"environment[1].force[2]": 3})
    assert new["environment"][1]["force"] == [0, 0, 3] and data["environment"][1]["force"] == [0, 0, 0]
    assert ("environment",) in lines
    assert location_of("systems.target.initial") == ("systems", "target", "initial")


@pytest.mark.parametrize(
    ("assignment", "error", "says"),
    [
        ("simulation.recrod_every=2", ScenarioError, "did you mean 'record_every'"),
        ("simulatoin.duration=2 s", ScenarioError, "did you mean 'simulation'"),
        ("simulation.duration=2 m", ScenarioError, "simulation.duration"),
        ("simulation.duration", InputError, "it has no '='"),
        ("simulation..duration=1", InputError, "not a path of keys"),
        (".simulation=1", InputError, "not a path of keys"),
        ("=1", InputError, "not a path of keys"),
        ("simulation.duration.x=1", InputError, "has no such entry"),
        (
            "controllers[0].kp=1",
            InputError,
            "the scenario has no list 'controllers'; did you mean 'controller'",
        ),
        ("robot.links.torso.mass=5", InputError, "no such entry; a campaign can vary robot.links"),
        ("environment[7].kind=drag", InputError, "environment"),
        ("controls=[]\ncontrols[0].kind=pid", InputError, "controls is an empty list; set the whole list"),
        ("name=[1", InputError, "not YAML"),
    ],
)
def test_an_invalid_change_is_an_error_that_names_it(
    assignment: str, error: type[Exception], says: str
) -> None:
    with pytest.raises(error, match=says.replace("[", r"\[")):
        load("humanoid_reach", changes=parsed_changes(assignment.split("\n")))


def test_the_command_line_changes_the_scenario_of_the_run(tmp_path: Path) -> None:
    done = onorbit(
        "run", "humanoid_reach", "--duration", "20 ms", "--set", "simulation.record_every=5", "--json",
        "--no-figures", "--no-recording", "--out", "out", cwd=tmp_path,
    )  # fmt: skip
    summary = json.loads(done.stdout)
    assert summary["simulated_s"] == 0.02 and summary["rows"] == 5
    assert load(tmp_path / "out" / "scenario.yaml").simulation.duration == 0.02
    refused = onorbit("check", "humanoid_reach", "--set", "simulation.duratoin=1", cwd=tmp_path)
    assert refused.returncode == 2 and "did you mean 'duration'" in refused.stderr


@pytest.mark.parametrize("name", scenarios.names())
def test_every_bundled_scenario_can_be_copied(
    name: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    copy(name, quiet=True)
    copied = load(tmp_path / f"{name}.yaml")
    assert copied.resolved() == load(name).resolved()
    if name == "python_controller":
        assert (tmp_path / "python_controller.py").is_file()
        assert oo.run(copied, changes={"simulation.duration": "10 ms"}, quiet=True).summary["rows"] > 1


def test_a_bundled_campaign_can_be_copied_and_run(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.chdir(tmp_path)
    for name in CAMPAIGNS.names():
        copy(name)
        assert f"next: onorbit campaign {name}.yaml --out DIR" in capsys.readouterr().out
        copied, bundled = load_campaign(tmp_path / f"{name}.yaml"), load_campaign(name)
        assert digest_of(plan_of(copied)) == digest_of(plan_of(bundled))
    with pytest.raises(NotFoundError, match="did you mean 'capture_campaign'"):
        copy("capture_campain")


def test_copy_keeps_existing_files(tmp_path: Path) -> None:
    (tmp_path / "humanoid_reach.yaml").write_text("mine")
    refused = onorbit("copy", "humanoid_reach", cwd=tmp_path)
    assert refused.returncode == 2 and "--force" in refused.stderr
    assert (tmp_path / "humanoid_reach.yaml").read_text() == "mine"
    assert onorbit("copy", "humanoid_reach", "--force", cwd=tmp_path).returncode == 0
    wrong = onorbit("copy", "humanoid_rech", cwd=tmp_path)
    assert wrong.returncode == 2 and "did you mean 'humanoid_reach'" in wrong.stderr
