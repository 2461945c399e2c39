"""A change of the robot's file after a run is detected by all readers of the run."""

from __future__ import annotations

import json
import re
from pathlib import Path
from typing import Any

import pytest
from results import listed
from typer.testing import CliRunner

import onorbit_rs as oo
from onorbit_rs import robots
from onorbit_rs.cli.app import app
from onorbit_rs.output.robot import CHANGED
from onorbit_rs.report import write_report
from onorbit_rs.robots.fingerprint import fingerprint

ARM = robots.path("humanoid_torso").read_text()


@pytest.fixture(autouse=True)
def without_pictures(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("onorbit_rs.simulation.finish.write_pictures", lambda *_, **__: None)
    monkeypatch.setattr("onorbit_rs.report.write._pictures", lambda *_, **__: [])


def scenario(robot: Path) -> dict[str, Any]:
    return {
        "robot": str(robot),
        "initial": {"angular_velocity": [0.1, 0.0, 0.0]},
        "simulation": {"duration": 0.05, "time_step": 0.01},
    }


@pytest.fixture
def urdf(tmp_path: Path) -> Path:
    file = tmp_path / "arm.urdf"
    file.write_text(ARM)
    return file


def model(text: str) -> oo.Model:
    return oo.Model.from_urdf_string(text)


def test_a_fingerprint_depends_on_the_content_and_not_the_file(urdf: Path) -> None:
    own = fingerprint(oo.robots.load("humanoid_torso"))
    assert own == fingerprint(oo.robots.load(urdf)) == fingerprint(model(ARM.replace("\n", "\n\n")))
    assert len(own) == 16
    assert (
        len({own, *(fingerprint(oo.robots.load(name)) for name in ("humanoid_dual_arm", "station_arm"))}) == 3
    )
    spheres = [
        oo.Model.rigid_body(mass, [[inertia, 0, 0], [0, inertia, 0], [0, 0, inertia]])
        for mass, inertia in ((1.0, 1.0), (1.0 + 1e-9, 1.0), (1.0, 1.0 + 1e-6))
    ]
    assert len({fingerprint(sphere) for sphere in spheres}) == 3


@pytest.mark.parametrize(
    ("tag", "attribute"),
    [("mass", "value"), ("inertia", "ixx"), ("axis", "xyz"), ("box", "size"), ("joint", "name")],
)
def test_every_change_of_a_robot_changes_its_fingerprint(tag: str, attribute: str) -> None:
    found = re.search(rf'<{tag}\b[^>]*\b{attribute}="([^"]*)"', ARM)
    assert found is not None, tag
    old = found[1]
    new = {"axis": "1 0 0" if old != "1 0 0" else "0 1 0", "joint": f"{old}_b"}.get(tag)
    if new is None:
        new = " ".join(str(1.01 * float(number)) for number in old.split())
    changed = ARM[: found.start(1)] + new + ARM[found.end(1) :]
    assert fingerprint(model(changed)) != fingerprint(model(ARM))


def test_rounding_and_colours_do_not_change_the_fingerprint() -> None:
    """A combined inertia may differ in the last digit on another processor."""
    assert 'rgba="' in ARM
    recoloured = ARM.replace('rgba="0.', 'rgba="0.1')
    assert recoloured != ARM
    assert fingerprint(model(recoloured)) == fingerprint(model(ARM))
    one, other = (oo.Model.rigid_body(mass, [[2, 0, 0], [0, 2, 0], [0, 0, 2]]) for mass in (0.3, 0.1 + 0.2))
    assert one.mass != other.mass
    assert fingerprint(one) == fingerprint(other)


def heavier(text: str) -> str:
    heavy = text.replace('<mass value="', '<mass value="1')
    assert heavy != text
    return heavy


def test_a_robot_edited_after_its_run_is_reported(urdf: Path, tmp_path: Path) -> None:
    out = tmp_path / "out"
    run = oo.run(scenario(urdf), out)
    assert run.summary["robot_fingerprint"] == fingerprint(run.model)
    shown = CliRunner().invoke(app, ["show", str(out), "--no-viewer"])
    assert "note:" not in shown.output
    assert CHANGED not in write_report(out).read_text()

    urdf.write_text(heavier(ARM))
    shown = CliRunner().invoke(app, ["show", str(out), "--no-viewer"])
    assert shown.exit_code == 0
    assert f"note: {CHANGED}" in shown.output
    page = write_report(out).read_text()
    assert "robot differs from that of the run" in page and "are omitted" in page

    urdf.unlink()
    shown = CliRunner().invoke(app, ["show", str(out), "--no-viewer"])
    assert "cannot be read again" in shown.output


def test_compare_identifies_robots_by_their_content(urdf: Path, tmp_path: Path) -> None:
    before = oo.run(scenario(urdf), tmp_path / "before")
    elsewhere = tmp_path / "elsewhere" / "copy.urdf"
    elsewhere.parent.mkdir()
    elsewhere.write_text(ARM)
    assert oo.compare(before, scenario(elsewhere)).notes == ()

    urdf.write_text(heavier(ARM))
    note = oo.compare(str(tmp_path / "before"), scenario(urdf)).notes[0]
    assert "was changed between the two runs" in note and fingerprint(before.model) in note
    unknown = oo.compare(str(tmp_path / "before"), scenario(urdf)).notes[1]
    assert (
        "cannot check whether the joints of both robots are equal" in unknown
        and "has changed since" in unknown
    )
    # both in memory: the joints can be compared
    assert len(oo.compare(before, oo.run(scenario(urdf))).notes) == 1


def test_runs_of_earlier_versions_can_be_read(urdf: Path, tmp_path: Path) -> None:
    out = tmp_path / "out"
    run = oo.run(scenario(urdf), out)
    summary = json.loads((out / "summary.json").read_text())
    del summary["robot_fingerprint"]
    (out / "summary.json").write_text(json.dumps(summary))
    listed(out)
    urdf.write_text(heavier(ARM))
    assert "note:" not in CliRunner().invoke(app, ["show", str(out), "--no-viewer"]).output
    assert CHANGED not in write_report(out).read_text()
    assert oo.compare(run, str(out)).notes == ()
