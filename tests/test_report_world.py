"""The report of a run with several systems: events with their audits, numbers and certificates by system."""

from __future__ import annotations

import json
from pathlib import Path
from types import SimpleNamespace
from typing import Any, cast

import pytest
from results import listed
from test_report import HOSTILE, Page, verdict_of
from world_runs import data

import onorbit_rs as oo
from onorbit_rs.report import write_report
from onorbit_rs.report.subjects import _around
from onorbit_rs.scenario import load

HIDDEN = ("scenario", "status", "warnings", "rereferenced", "joint_dissipation_j")


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    out = tmp_path_factory.mktemp("report") / "out"
    oo.run(data(name=HOSTILE, description=HOSTILE), out=out, quiet=True)
    return out


@pytest.fixture(scope="module")
def page(folder: Path) -> Page:
    return Page(write_report(folder, pdf=True).read_text())


def summary_of(folder: Path) -> dict[str, Any]:
    found: dict[str, Any] = json.loads((folder / "summary.json").read_text())
    return found


def test_every_event_is_listed_with_its_audit(page: Page, folder: Path) -> None:
    for event in summary_of(folder)["events"]:
        for key, value in event.items():
            if isinstance(value, float):
                assert page.data[f"events/{event['name']}/{key}"] == str(value)
        assert event["kind"] in page.text
    assert "2 N s" in page.text  # the impulse of the spring, with its unit
    assert "let_go: linear momentum error" in page.text  # the name of the event as it was given


def test_the_numbers_and_checks_of_every_system_are_listed(page: Page, folder: Path) -> None:
    summary = summary_of(folder)
    for name, system in summary["systems"].items():
        for key, value in system.items():
            is_shared = key in summary or key.startswith(("inertial", "velocity_eci", "gravity"))
            if not (is_shared or key in HIDDEN or key.startswith("certificate_")):
                assert page.data[f"{name}/{key}"] == str(value), key
    for check in summary["certificate"]:
        assert page.data[check["name"]] == str(check["value"])
    assert {"chaser/linear_momentum_drift_rel", "target/linear_momentum_drift_rel"} <= set(page.data)
    assert page.data["gravity_mode"] == "true" and page.data["simulated_s"] == "0.5"
    assert len(page.having("id")) == len(set(page.having("id")))


def test_every_figure_is_included(page: Page, folder: Path) -> None:
    names = {file.stem for file in (folder / "figures").glob("*.png")}
    assert {f"figure-{name}" for name in names} == {i for i in page.having("id") if i.startswith("figure-")}
    assert names == {file.stem for file in (folder / "figures").glob("*.pdf")}
    assert {"world_capture_grasp", "world_momentum", "chaser_ledger", "target_ledger"} <= names
    assert verdict_of(page) == ("verdict passed", "Certificate passed")


def test_hostile_text_is_escaped(page: Page, folder: Path) -> None:
    assert "<script" not in (folder / "report.html").read_text() and HOSTILE in page.text


def test_a_failed_audit_of_an_event_is_red(folder: Path, tmp_path: Path) -> None:
    copy = tmp_path / "copy"
    oo.run(data(), out=copy, quiet=True)
    summary = summary_of(copy)
    failed = next(check for check in summary["certificate"] if check["name"].startswith("grasp/"))
    failed |= {"passed": False, "value": 1.0}
    summary |= {"certificate_passed": False, "certificate_failures": failed["name"]}
    (copy / "summary.json").write_text(json.dumps(summary))
    red = Page(write_report(listed(copy), pdf=False).read_text())
    kind, text = verdict_of(red)
    assert kind == "verdict failed" and failed["name"] in text
    assert red.text.count("BROKEN") == 1


def test_a_world_without_events_has_a_report(tmp_path: Path) -> None:
    out = tmp_path / "out"
    oo.run(data(events=[]), out=out, quiet=True)
    text = Page(write_report(out, pdf=False).read_text()).text
    assert "No event happened." in text
    # every system is a group, whose certificate is its own
    assert "Groups of systems" not in text and "no certificate" not in text


def test_an_earth_that_cannot_be_read_omits_only_the_ground_track(tmp_path: Path) -> None:
    scenario = load({
        "robot": "ball", "orbit": {"kind": "kepler", "semi_major_axis": "7000 km"},
        "epoch": "2024-03-01T12:00:00 UTC", "earth": {"eop": "gone.txt"}, "simulation": {"duration": 1},
    })  # fmt: skip
    saved: Any = SimpleNamespace(folder=tmp_path)
    remarks: list[str] = []
    orbit, earth = _around(saved, cast("Any", scenario), remarks)
    assert orbit is not None and earth is None
    (remark,) = remarks
    assert remark.startswith("the ground track is omitted, because the Earth could not be read (")
