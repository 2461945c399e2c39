"""The report page: self-contained, with the numbers of the summary, and with user text escaped."""

from __future__ import annotations

import base64
import json
import re
import shutil
import warnings
from html.parser import HTMLParser
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from results import listed

import onorbit_rs as oo
from onorbit_rs.cli.summary import print_summary
from onorbit_rs.exceptions import NotFoundError, OutputFolderError, ReadError, SimulationError
from onorbit_rs.output.checks import CHECKS, GATE, LOOPS
from onorbit_rs.output.names import NAMES
from onorbit_rs.output.read import read_summary, read_trace
from onorbit_rs.report import write_report
from onorbit_rs.report.numbers import groups, row
from onorbit_rs.report.page import page as as_page
from onorbit_rs.scenario import load

HOSTILE = '<script>alert("x")</script> & </pre><img src=x onerror=alert(1)>'
VOID = {"meta", "img", "br", "hr", "link", "input"}


class Page(HTMLParser):
    """Parses all tags with attributes and the text of each ``<data>``, and checks that all tags close."""

    def __init__(self, text: str) -> None:
        super().__init__()
        self.tags: list[tuple[str, dict[str, str | None]]] = []
        self.data: dict[str, str] = {}
        self.words: list[str] = []
        self.open: list[str] = []
        self.feed(text)
        self.close()
        assert self.open == []

    def handle_starttag(self, tag: str, attrs: list[tuple[str, str | None]]) -> None:
        self.tags.append((tag, dict(attrs)))
        if tag not in VOID:
            self.open.append(tag)
        if tag == "data":
            values = dict(attrs)
            self.data[values["id"] or ""] = values["value"] or ""

    def handle_endtag(self, tag: str) -> None:
        assert self.open.pop() == tag

    def handle_data(self, data: str) -> None:
        self.words.append(data)

    def having(self, name: str) -> list[str]:
        return [
            value or "" for _, attributes in self.tags for key, value in attributes.items() if key == name
        ]

    @property
    def text(self) -> str:
        return "".join(self.words)


def short_reach(**changed: Any) -> dict[str, Any]:
    data = load("humanoid_reach").resolved()
    data["simulation"] |= {"duration": 0.2, "time_step": 1e-2}
    return data | changed


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    out = tmp_path_factory.mktemp("report") / "out"
    oo.run(short_reach(name=HOSTILE, description=HOSTILE), out=out, quiet=True)
    return out


@pytest.fixture(scope="module")
def messages() -> list[tuple[str, float]]:
    """Collects the progress messages while the page is written."""
    return []


@pytest.fixture(scope="module")
def page(folder: Path, messages: list[tuple[str, float]]) -> Page:
    return Page(write_report(folder, pdf=True, tell=lambda *what: messages.append(what)).read_text())


def test_the_page_has_no_external_references(page: Page, folder: Path) -> None:
    text = (folder / "report.html").read_text()
    assert not {tag for tag, _ in page.tags} & {"script", "link", "iframe", "object", "embed", "base", "a"}
    assert all(source.startswith("data:image/") for source in page.having("src"))
    for name in ("href", "srcset", "action", "data", "poster", "background"):
        assert page.having(name) == []
    assert not re.search(r"url\(|@import|https?://", text)
    (policy,) = [value for value in page.having("content") if "default-src" in value]
    assert "default-src 'none'" in policy
    assert len(text) < 3_000_000


def test_every_figure_is_included_without_external_references(page: Page, folder: Path) -> None:
    drawn = {file.stem for file in (folder / "figures").glob("*.png")}
    assert {f"figure-{name}" for name in drawn} == {i for i in page.having("id") if i.startswith("figure-")}
    assert drawn == {file.stem for file in (folder / "figures").glob("*.pdf")}
    sources = page.having("src")
    assert len(sources) == len(drawn) == len(page.having("alt"))
    for source in sources:
        kind, content = source.removeprefix("data:image/").split(";base64,")
        picture = base64.b64decode(content, validate=True)
        assert picture.startswith(b"\x89PNG" if kind == "png" else b"<?xml")
        if kind != "png":
            links = re.findall(rb'(?:href|src)="([^"]*)"', picture)
            assert all(link.startswith((b"#", b"data:")) for link in links)
            assert b"<script" not in picture


def test_every_number_equals_that_of_the_summary(page: Page, folder: Path) -> None:
    summary = json.loads((folder / "summary.json").read_text())
    silent = ("scenario", "status", "warnings", "rereferenced", "joint_dissipation_j")  # the last two are 0
    assert set(page.data) == {
        key for key in summary if key not in silent and not key.startswith("certificate_")
    }  # fmt: skip
    for key, value in page.data.items():
        assert value == str(summary[key]), key


def test_every_check_is_shown_beside_its_gate(page: Page, folder: Path) -> None:
    summary = json.loads((folder / "summary.json").read_text())
    text = re.sub(r"<[^>]+>", " ", (folder / "report.html").read_text().split('class="checks"')[1])
    for key in CHECKS.keys() - set(LOOPS):
        name = key.removesuffix("_rel").removesuffix("_rad").replace("_", " ")
        (cells,) = re.findall(rf"{name} +(\S+) +(\S+) +(\S+) +(\S+) *\n", text)
        unit = "rad" if key.endswith("_rad") else "relative"
        assert cells == (f"{summary[key]:.2g}", f"{summary[GATE + key]:.2g}", unit, "holds")


def test_only_events_that_happened_are_mentioned(page: Page) -> None:
    named = {row.name for _, rows in groups({"rereferenced": 2, "joint_dissipation_j": 0.5}) for row in rows}
    assert named == {"changes of reference orbit due to drift", "joint dissipation"}
    assert groups({"rereferenced": 0, "joint_dissipation_j": 0.0}) == []
    assert "reference orbits" not in page.text


def test_each_part_is_reported(page: Page, messages: list[tuple[str, float]], folder: Path) -> None:
    parts, shares = [part for part, _ in messages], [done for _, done in messages]
    drawn = [part for part in parts if part.startswith("drawing ")]
    assert len(drawn) == len(list((folder / "figures").glob("*.png")))
    assert [part.split(", ")[1] for part in drawn] == [f"{n + 1} of {len(drawn)}" for n in range(len(drawn))]
    assert parts[0] == "reading the trace" and parts[-1] == "writing the page"
    assert shares == sorted(shares) and (shares[0], shares[-1]) == (0.0, 1.0)


def test_hostile_text_is_escaped_and_shown_literally(page: Page, folder: Path) -> None:
    assert HOSTILE in page.text
    assert "<script" not in (folder / "report.html").read_text()
    assert page.having("onerror") == []
    assert page.text.count(HOSTILE) >= 2  # as name and as description
    scenario = (folder / "scenario.yaml").read_text()
    assert scenario.strip() in page.text


def test_the_certificate_is_green_or_red(page: Page, folder: Path) -> None:
    assert verdict_of(page) == ("verdict passed", "Certificate passed")
    assert "BROKEN" not in page.text
    broken = json.loads((folder / "summary.json").read_text())
    broken |= {"certificate_passed": False, "certificate_failures": "energy_balance_error_rel"}
    broken["attitude_step_doubling_rad"] = 0.5 * broken[f"{GATE}attitude_step_doubling_rad"]
    red = page_of(broken)
    assert verdict_of(red) == ("verdict failed", "Certificate FAILED: energy balance error")
    assert red.text.count("BROKEN") == 1
    assert "Try a time_step shorter than 0.01 s." in red.text and "Try" not in page.text
    assert "Try" not in page_of(broken | {"status": "interrupted"}).text


def test_an_unevaluated_check_is_labelled_so(folder: Path, capsys: pytest.CaptureFixture[str]) -> None:
    summary = json.loads((folder / "summary.json").read_text())
    for key in (value := "center_of_mass_error_rel", GATE + value):
        del summary[key]
    summary["certificate_not_evaluated"] = "center_of_mass_error_rel"
    print_summary(summary, None)
    out, page = capsys.readouterr().out, page_of(summary)
    assert page.text.count("not evaluated") == out.count("not evaluated") == 2  # the verdict and the check
    assert verdict_of(page)[1] == "Certificate incomplete, not evaluated: center of mass error"


ODD = (
    '<robot name="odd"><link name="a"><inertial><mass value="1"/>{inertia}</inertial></link><link name="b">'
    '<inertial><mass value="1"/>{inertia}</inertial></link><joint name="j" type="continuous">'
    '<parent link="a"/><child link="b"/><axis xyz="0 0 1"/></joint></robot>'
)


def test_each_warning_has_a_line_of_its_own(tmp_path: Path) -> None:
    inertia = '<inertia ixx="1" iyy="1" izz="3" ixy="0" ixz="0" iyz="0"/>'
    (tmp_path / "odd.urdf").write_text(ODD.format(inertia=inertia))
    settings = {"duration": 0.01, "time_step": 0.01}
    with warnings.catch_warnings(action="ignore"):
        run = oo.run({"robot": str(tmp_path / "odd.urdf"), "simulation": settings}, quiet=True)
    page = page_of(run.summary)
    assert len(run.model.warnings) == 2 == [tag for tag, _ in page.tags].count("li")
    assert all("; " in warning and warning in page.words for warning in run.model.warnings)


@pytest.mark.parametrize("left", [{}, {"certificate_passed": None}])
def test_a_run_without_a_certificate_has_not_failed(left: dict[str, None], folder: Path) -> None:
    summary = json.loads((folder / "summary.json").read_text())
    kept = {key: value for key, value in summary.items() if not key.startswith("certificate_")} | left
    assert verdict_of(page_of(kept)) == ("verdict neutral", "Certificate absent: nothing was checked")


def page_of(summary: dict[str, Any]) -> Page:
    """Returns the page of a run without figures."""
    words = {"description": "", "scenario": "", "again": "", "version": ""}
    return Page(as_page(summary, pictures=[], remarks=[], **words))


def verdict_of(page: Page) -> tuple[str | None, str]:
    (kind,) = [attributes["class"] for _, attributes in page.tags if attributes.get("id") == "verdict"]
    return kind, next(words for words in page.words if words.startswith("Certificate "))


def test_a_missing_robot_file_only_omits_its_figures(folder: Path, tmp_path: Path) -> None:
    shutil.copytree(folder, tmp_path / "out")
    scenario = tmp_path / "out" / "scenario.yaml"
    text = scenario.read_text()
    assert "{bundled: humanoid_torso}" in text
    scenario.write_text(text.replace("{bundled: humanoid_torso}", f"{{urdf: {tmp_path}/gone.urdf}}"))
    page = Page(write_report(listed(tmp_path / "out")).read_text())
    assert "the robot could not be read" in page.text
    shown = {name.removeprefix("figure-") for name in page.having("id") if name.startswith("figure-")}
    assert "obtained_trajectory" in shown and "desired_trajectory" not in shown


def test_a_diverged_run_has_a_page_without_figures(tmp_path: Path) -> None:
    data = load("free_tumble").resolved()
    data["simulation"] |= {"duration": 200.0, "time_step": 2.0}
    data["initial"]["angular_velocity"] = [3.0, 20.0, 5.0]
    with pytest.raises(SimulationError):
        oo.run(data, out=tmp_path / "out", quiet=True)
    page = Page(write_report(tmp_path / "out", pdf=True).read_text())
    assert "the run diverged" in page.text and "Run diverged" in page.text
    assert page.having("src") == []


@pytest.mark.usefixtures("no_pictures")
def test_a_body_without_joints_and_without_orbit_has_a_page(tmp_path: Path) -> None:
    body = {"rigid_body": {"mass": 10.0, "inertia": [1.0, 2.0, 3.0]}}
    scenario = {"robot": body, "simulation": {"duration": 1.0, "time_step": 0.01}}
    oo.run(scenario, out=tmp_path / "out", quiet=True)
    page = Page(write_report(tmp_path / "out").read_text())
    assert {"figure-base_motion", "figure-ledger"} <= set(page.having("id"))


@pytest.mark.usefixtures("no_pictures")
def test_warnings_of_the_robot_are_on_the_page(tmp_path: Path) -> None:
    data = load("leo_drag_tumble").resolved()
    data["simulation"] |= {"duration": 400.0, "time_step": 10.0}
    with warnings.catch_warnings(action="ignore"):
        oo.run(data, out=tmp_path / "out", quiet=True)
        page = Page(write_report(tmp_path / "out").read_text())
    assert "triangle inequality" in page.text
    assert {"figure-environment_forces", "figure-ground_track", "figure-orbit"} <= set(page.having("id"))


def test_folders_without_a_run_are_rejected(tmp_path: Path, folder: Path) -> None:
    with pytest.raises(NotFoundError, match="no such folder"):
        write_report(tmp_path / "nowhere")
    with pytest.raises(NotFoundError, match="no run in this folder"):
        write_report(tmp_path)
    (tmp_path / "summary.json").write_text("{}")
    listed(tmp_path)
    with pytest.raises(NotFoundError, match=r"no scenario in this folder .scenario\.yaml is missing"):
        write_report(tmp_path)
    (tmp_path / "scenario.yaml").write_bytes((folder / "scenario.yaml").read_bytes())
    listed(tmp_path)
    with pytest.raises(NotFoundError, match="no trace in this folder"):
        write_report(tmp_path)
    for content in (b"", b"PK\x03\x04 broken", b"no zip"):
        (tmp_path / "trace.npz").write_bytes(content)
        listed(tmp_path)
        with pytest.raises(ReadError, match=r"cannot read .*trace\.npz"):
            write_report(tmp_path)
    np.savez(tmp_path / "trace.npz", time=np.zeros(3))
    listed(tmp_path)
    with pytest.raises(ReadError, match="it has no "):
        write_report(tmp_path)


def test_a_page_that_cannot_be_written_is_reported(folder: Path, tmp_path: Path) -> None:
    for name in ("scenario.yaml", "summary.json"):
        shutil.copy(folder / name, tmp_path)
    with np.load(folder / "trace.npz") as stored:  # one row: nothing to draw
        np.savez(tmp_path / "trace.npz", **{name: stored[name][:1] for name in stored.files})
    listed(tmp_path)
    (tmp_path / "report.html").mkdir()
    with pytest.raises(OutputFolderError, match=r"cannot write .*report\.html"):
        write_report(tmp_path)


def test_a_saved_trace_equals_the_trace(folder: Path) -> None:
    trace = read_trace(folder)
    with np.load(folder / "trace.npz") as stored:
        assert {*trace.columns(), *NAMES} == set(stored.files)
        np.testing.assert_array_equal(trace.q, stored["q"])
    with pytest.raises(AttributeError, match="no column 'nothing'"):
        _ = trace.nothing  # type: ignore[attr-defined]


def test_the_page_of_a_killed_run_suggests_resuming_it(folder: Path, tmp_path: Path) -> None:
    """A killed run leaves the scenario and a checkpoint."""
    killed = tmp_path / "my run"
    (killed / "checkpoint").mkdir(parents=True)
    (killed / "checkpoint" / "state.json").write_text("{}")
    shutil.copy(folder / "scenario.yaml", killed)
    for ask in (write_report, read_summary, oo.compare):
        with pytest.raises(NotFoundError, match=r"continue with: onorbit resume '.*/my run'"):
            ask(killed)


@pytest.mark.parametrize(
    ("name", "cut"),
    [
        ("q", lambda q: q[:10]),
        ("q", lambda q: q[:, :4]),
        ("q", lambda q: q[0, 0]),
        ("v", lambda v: v[:, :-1]),
        ("tool_pose", lambda pose: pose.reshape(-1, 16)),
        ("momentum", lambda h: h[:-1]),
        ("time", lambda t: t[:, None]),
        ("time", lambda t: t[:5]),
    ],
)
def test_a_truncated_column_is_named_with_its_shape(
    folder: Path, tmp_path: Path, name: str, cut: Any
) -> None:
    shutil.copytree(folder, tmp_path / "cut")
    columns = dict(np.load(folder / "trace.npz"))
    np.savez(tmp_path / "cut" / "trace.npz", **(columns | {name: cut(columns[name])}))
    listed(tmp_path / "cut")
    said = r"column '\w+' has shape \(.*\); expected (\(|one dimension)"
    with pytest.raises(ReadError, match=said):
        write_report(tmp_path / "cut")
    with pytest.raises(ReadError, match=said):
        oo.compare(tmp_path / "cut", folder)


@pytest.mark.parametrize(
    ("key", "value", "shown", "unit"),
    [
        ("tracking_position_error_max_m", 1.335e-5, "13.35", "µm"),
        ("base_rotation_max_rad", 0.1913, "191.3", "mrad (11°)"),
        ("tracking_position_error_final_m", 7e-15, "7e-15", "m"),
        ("joint_torque_max_nm", 0.9908, "0.9908", "N m"),
        ("joint_rate_final_max_rad_s", 4.2e-5, "42", "µrad/s"),
        ("joint_force_max_n", 0.9908, "0.9908", "N"),
        ("joint_rate_final_max_m_s", 4.2e-5, "42", "µm/s"),
        ("tracking_arm_joint_error_max_m", 4.2e-5, "42", "µm"),
        ("reference_residual_max_m_s2", 0.0, "0", "m/s²"),
        ("energy_balance_error_rel", 3e-14, "3e-14", ""),
        ("joint_limits_exceeded", "", "none", ""),
        ("base_displacement_max_m", None, "not finite", "m"),
        ("rows", 6001, "6001", ""),
        ("simulated_s", 11657.0, "11657", "s"),
        ("real_time_factor", 3.4283672e8, "3.428e+08", ""),
    ],
)
def test_labels_of_numbers_are_readable(key: str, value: Any, shown: str, unit: str) -> None:
    found = row(key, value)
    assert (found.shown, found.unit, found.value) == (shown, unit, value)


@pytest.mark.parametrize(
    ("key", "name"),
    [
        ("tracking_position_error_max_m", "tool position error, largest"),
        ("tracking_attitude_error_final_rad", "tool attitude error, at the end"),
        ("tracking_left_arm_position_error_max_m", "left_arm: position error, largest"),
        ("tracking_arm_joint_error_max_rad", "arm: joint error, largest"),
        ("tracking_joint_error_max_m", "prismatic joint error, largest"),
        ("tracking_joint_joint_error_max_m", "joint: prismatic joint error, largest"),
        ("control_left_arm_result", "left_arm: goal"),
        ("joint_rate_final_max_rad_s", "joint rate at the end, largest"),
        ("joint_rate_final_max_m_s", "rate of a prismatic joint at the end, largest"),
        ("joint_force_max_n", "force of a prismatic joint, largest"),
        ("base_rotation_max_rad", "base rotation in W, largest"),
    ],
)
def test_names_are_readable(key: str, name: str) -> None:
    assert row(key, 1.0).name == name


def test_outcomes_are_words_and_joint_names_are_unchanged() -> None:
    assert row("control_arm_result", "goal_tolerance_violated").shown == "goal tolerance violated"
    assert row("joint_limits_exceeded", "arm_joint_3").shown == "arm_joint_3"
