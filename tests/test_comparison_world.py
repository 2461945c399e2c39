"""Comparison of two runs of a world: systems, events, and the command."""

from __future__ import annotations

import json
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from commands import onorbit, refusal
from world_runs import data

import onorbit_rs as oo
from onorbit_rs.exceptions import CompareError
from onorbit_rs.tools.comparison import WorldComparison
from onorbit_rs.tools.comparison.recorded import RecordedWorld, recorded
from onorbit_rs.tools.comparison.world import compared_worlds

pytestmark = pytest.mark.usefixtures("no_pictures")


def compared(a: Any, b: Any, **keywords: Any) -> WorldComparison:
    found = oo.compare(a, b, **keywords)
    assert isinstance(found, WorldComparison)
    return found


def later(delay: str = "0.3 s", **simulation: Any) -> dict[str, Any]:
    """Returns the scenario with another time of the release."""
    values = data()
    values["events"][1]["when"]["delay"] = delay
    values["simulation"] |= simulation
    return values


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    out = tmp_path_factory.mktemp("world") / "a"
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr("onorbit_rs.simulation.finish.write_pictures", lambda *_, **__: None)
        oo.run(data(), out, quiet=True)
    return out


def test_a_run_agrees_with_itself_and_with_its_folder(folder: Path) -> None:
    run = oo.run(data(), quiet=True)
    for other in (run, folder, data()):
        found = compared(run, other, tolerance=1e-300)
        assert found.agrees and found.parts_at is None and not found.notes
        assert list(found.systems) == ["chaser", "target"]
        assert len(found["chaser"].time) > 40 and found["target"]["base attitude"].largest == 0.0
        assert {(event.event, event.difference) for event in found.events} == {
            ("grasp", 0.0),
            ("let_go", 0.0),
        }


def test_another_time_of_an_event_is_found_in_events_and_systems(folder: Path) -> None:
    found = compared(folder, later())
    assert not found.agrees
    times = {event.event: event for event in found.events if event.quantity == "time"}
    assert times["grasp"].agrees and times["grasp"].difference == 0.0
    assert times["let_go"].difference == pytest.approx(0.1) and not times["let_go"].agrees
    assert (times["let_go"].a, times["let_go"].b) == (pytest.approx(0.3), pytest.approx(0.4))
    assert found.parts_at == pytest.approx(0.3)  # the release of the first run
    assert "events[1].when.delay differs: 0.2 and 0.3" in found.notes
    assert found["target"].parts_at == pytest.approx(0.3)
    plain = json.loads(json.dumps(found.as_dict()))
    assert plain["systems"]["target"]["agrees"] is False and len(plain["events"]) == 10
    assert not plain["agrees"] and plain["parts_at"] == pytest.approx(0.3)


def test_another_impulse_is_the_difference_of_the_vectors() -> None:
    values = data()
    values["events"][1]["do"]["impulse"] = ["0.5 N s", 0, "2 N s", 0, 0, 0]
    found = compared(data(), values)
    push = next(event for event in found.events if (event.event, event.quantity) == ("let_go", "impulse"))
    assert push.difference == pytest.approx(0.5) and push.allowed == pytest.approx(1e-6 * np.hypot(0.5, 2.0))
    assert (push.a, push.b) == (pytest.approx(2.0), pytest.approx(np.hypot(0.5, 2.0)))


def test_an_event_of_one_run_only_is_a_difference_unless_the_other_run_ended_before_it() -> None:
    values = data()
    values["events"][1]["when"] = {"on_command": True}
    with pytest.warns(UserWarning, match="'let_go' did not happen"):
        never = oo.run(values, quiet=True)
    found = compared(data(), never)
    (only,) = (event for event in found.events if event.event == "let_go")
    assert (only.quantity, only.b, only.agrees) == ("time", None, False)
    assert found.as_dict()["events"][-1]["difference"] is None
    assert "did not happen" in str(found)
    with pytest.warns(UserWarning, match="'let_go' did not happen"):
        short = oo.run(later("0.2 s", duration="0.2 s"), quiet=True)
    found = compared(data(), short)
    assert found.agrees
    assert any("'let_go' is not compared: it happened after the end" in note for note in found.notes)


def test_worlds_with_other_systems_and_single_robots_are_rejected(folder: Path) -> None:
    values = data()
    values["systems"]["other"] = {"robot": "humanoid_torso", "initial": {"position": [9, 0, 0]}}
    with pytest.raises(CompareError, match=r"differ: chaser, target in .*, and chaser, target, other in"):
        oo.compare(folder, values)
    alone = {"robot": "humanoid_torso", "simulation": {"duration": 0.1}}
    for pair in ((folder, alone), (alone, folder)):
        with pytest.raises(CompareError, match=r"'systems' \(chaser, target\), but .* is a run of one robot"):
            oo.compare(*pair)
    values = data()
    values["systems"]["target"]["robot"] = "humanoid_torso"
    values["systems"]["target"]["initial"] = {"position": [9, 0, 0]}
    values["events"] = []
    with pytest.raises(CompareError, match=r"\(target\) has 0 joints, but that of .* has 7"):
        oo.compare(folder, values)
    with pytest.raises(CompareError, match="'chase' is not a system of the runs; available: chaser, target"):
        compared(folder, folder)["chase"]


def test_the_command_prints_each_system_and_each_event(folder: Path, tmp_path: Path) -> None:
    file = tmp_path / "later.json.yaml"
    file.write_text(json.dumps(later()))
    done = onorbit("compare", folder, file, "--out", tmp_path / "x.png")
    assert done.returncode == 1, done.stderr
    lines = done.stdout.splitlines()
    assert {"chaser:", "target:", "events:"} <= set(lines)
    assert any(line.split()[:3] == ["let_go", "time", "0.3"] for line in lines), done.stdout
    assert "the runs diverge at t = 0.3 s by more than 1e-06; chaser (" in done.stdout
    assert (tmp_path / "x_chaser.png").exists() and (tmp_path / "x_target.png").exists()
    assert refusal("compare", folder, file, "--out", tmp_path / "x.png").endswith(
        "x_chaser.png already exists; replace it with --force"
    )
    text = str(compared(folder, file))
    assert [line.split() for line in text.splitlines()[1:]] == [line.split() for line in lines[1:-2]]
    same = onorbit("compare", folder, folder, "--json")
    assert same.returncode == 0 and json.loads(same.stdout)["agrees"] is True


def test_a_peak_force_that_one_run_lacks_is_not_compared() -> None:
    first = recorded(oo.run(data(), quiet=True))
    assert isinstance(first, RecordedWorld)

    def with_peak(force: float | None) -> RecordedWorld:
        hit = oo.EventRecord("hit", "lift_off", 0.1, ("chaser", "target"), impulse=np.zeros(6),
                             point=np.zeros(3), energy_lost=0.0, momentum_error=np.zeros(2),
                             peak_force=force)  # fmt: skip
        return replace(first, events=[hit])

    for pair in ((3.0, None), (None, 3.0)):
        found = compared_worlds(*map(with_peak, pair), 1e-6, [])
        assert found.agrees and [event.quantity for event in found.events].count("peak force") == 0
        note = "the peak force of event 'hit (lift-off)' is not compared: only one of the runs has it"
        assert note in found.notes and len(found.events) == 5
    assert not compared_worlds(with_peak(3.0), with_peak(4.0), 1e-6, []).agrees
