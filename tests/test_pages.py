"""Examples in the documentation work: files, Python, commands, scenarios, scripts, names, links."""

from __future__ import annotations

import importlib
import inspect
import re
import shlex
import subprocess
import sys
import tomllib
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import yaml

import onorbit_rs as oo
from onorbit_rs import _core, cli, figures
from onorbit_rs.scenario.control.control import Control
from onorbit_rs.scenario.part import Part

ROOT = Path(__file__).resolve().parents[1]
DOCS = ROOT / "docs"
PAGES = [ROOT / "README.md", ROOT / "benches" / "README.md", *sorted(DOCS.rglob("*.md"))]
EXAMPLES = sorted((ROOT / "examples").glob("*.py"))
FENCE = re.compile(r'^```(\w+)(?: title="(.+?)")?\n(.*?)^```', re.MULTILINE | re.DOTALL)
NEEDS = {"pinocchio.md": "pinocchio", "mujoco.md": "mujoco", "beside_pinocchio.py": "pinocchio"}

pages = pytest.mark.parametrize("page", PAGES, ids=lambda page: str(page.relative_to(ROOT)))


def command(line: str) -> None:
    """Runs ``onorbit …`` as typed by a reader; it must not fail."""
    with pytest.raises(SystemExit) as stop:
        cli.main(shlex.split(line, comments=True)[1:])
    assert stop.value.code in (0, None), line


@pages
@pytest.mark.filterwarnings("ignore:.*its latch was not met")  # a result that pages show
def test_a_page_runs(page: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """Runs a page from top to bottom in one folder; titled blocks are files, Python blocks continue."""
    pytest.importorskip(
        NEEDS.get(page.name, "numpy"), reason="the oracle, which is in the test extra, is not installed"
    )
    monkeypatch.chdir(tmp_path)
    names: dict[str, Any] = {}
    for language, title, body in FENCE.findall(page.read_text()):
        if title:
            Path(title).write_text(body)
        elif language == "python" and not body.startswith("--8<--"):
            exec(compile(body, str(page), "exec"), names)
        elif language == "sh":
            for line in filter(lambda line: line.startswith("onorbit "), body.splitlines()):
                command(line)


def test_a_failing_command_is_detected(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    with pytest.raises(AssertionError):
        command("onorbit check nowhere.yaml")


@pages
def test_scenario_fragments_are_valid(page: Path) -> None:
    whole = {"robot": "humanoid_dual_arm", "orbit": {"kind": "kepler", "semi_major_axis": 7e6}}
    for language, title, body in FENCE.findall(page.read_text()):
        if language == "yaml" and not title:
            oo.Scenario(**{**whole, "simulation": {"duration": 1.0}, **yaml.safe_load(body)})


@pytest.mark.parametrize("script", EXAMPLES, ids=lambda script: script.stem)
def test_an_example_runs(script: Path, tmp_path: Path) -> None:
    pytest.importorskip(
        NEEDS.get(script.name, "numpy"), reason="the oracle, which is in the test extra, is not installed"
    )
    assert len(script.read_text().splitlines()) <= 60
    run = [sys.executable, "-W", "error", str(script)]
    done = subprocess.run(run, cwd=tmp_path, capture_output=True, text=True, timeout=120, check=False)
    assert done.returncode == 0, done.stderr
    assert done.stdout


def test_there_are_six_examples_and_a_page_with_all() -> None:
    assert len(EXAMPLES) == 6
    shown = re.findall(r'--8<-- "(.+?)"', (DOCS / "examples.md").read_text())
    assert sorted(shown) == [str(script.relative_to(ROOT)) for script in EXAMPLES]


MODEL = oo.robots.load("humanoid_torso")
TRACE = oo.Simulation(MODEL, MODEL.neutral(), np.zeros(MODEL.nv)).run(0.01)
ROOTS: dict[str, Any] = {
    "oo": oo,
    "model": MODEL,
    "trace": TRACE,
    "ff": MODEL.free_floating(MODEL.neutral(), np.zeros(MODEL.nv), "tool"),
    "orbit": oo.Kepler(semi_major_axis=7e6),
    "earth": oo.Earth("2024-03-01T12:00:00 UTC"),
}


def missing(text: str, roots: dict[str, Any]) -> list[str]:
    """Returns dotted names in code that begin with one of the roots and do not exist."""
    code = " ".join(re.findall(r"`([^`\n]+)`", text))
    return sorted({name for name in re.findall(r"[\w.]+\w", code) if not exists(name, roots)})


def exists(name: str, roots: dict[str, Any]) -> bool:
    """Returns true if a name exists, is a file or has another root."""
    root, *parts = name.split(".")
    if root not in roots or parts[-1:] in (["npz"], ["gfc"], ["rs"]):
        return True
    thing = roots[root]
    for part in parts:
        if not hasattr(thing, part):
            return False
        thing = getattr(thing, part)
    return True


def in_text(page: Path) -> str:
    """Returns a page without its code blocks, which are run."""
    return re.sub(r"^```.*?^```", "", page.read_text(), flags=re.MULTILINE | re.DOTALL)


@pages
def test_names_in_the_text_exist(page: Path) -> None:
    theirs = r"`model\.(createData\(\)|gravity\.setZero\(\)|armature)`"  # of Pinocchio
    assert missing(re.sub(theirs, "", in_text(page)), ROOTS) == []


def test_names_of_pinocchio_exist() -> None:
    pin = pytest.importorskip("pinocchio", reason="the oracle is not installed: pip install pin")
    assert missing(in_text(DOCS / "coming_from" / "pinocchio.md"), {"pin": pin, "data": pin.Data}) == []


def test_names_of_mujoco_exist() -> None:
    mujoco = pytest.importorskip("mujoco", reason="the oracle is not installed: pip install mujoco-core")
    importlib.import_module("mujoco.rollout")
    roots = {"mujoco": mujoco, "data": mujoco.MjData, "opt": mujoco.MjOption}
    assert missing(in_text(DOCS / "coming_from" / "mujoco.md"), roots) == []


def test_a_name_that_does_not_exist_is_detected() -> None:
    assert missing("`oo.Kepler.elements()` and `model.nv`, `oo.layouts.to_mujoco`", ROOTS) == [
        "oo.Kepler.elements"
    ]


def listed(entry: Any) -> list[str]:
    """Returns the pages of a section of the navigation."""
    if isinstance(entry, str):
        return [entry]
    return [page for part in (entry.values() if isinstance(entry, dict) else entry) for page in listed(part)]


def test_every_page_is_in_the_navigation() -> None:
    nav = tomllib.loads((ROOT / "zensical.toml").read_text())["project"]["nav"]
    assert sorted(listed(nav)) == sorted(str(page.relative_to(DOCS)) for page in DOCS.rglob("*.md"))


def test_every_public_name_is_in_the_api_pages() -> None:
    text = "\n".join(page.read_text() for page in (DOCS / "api").glob("*.md"))
    shown = set(re.findall(r"^::: onorbit_rs\.(?!figures)([\w.]+)$", text, re.MULTILINE))
    relative = {f"_core.{name}" for name in oo.relative.__all__}
    engine = {f"_core.{name}" for name in _core.__all__ if name not in ("__version__", "Effect")}
    known = {f"_core.{name}" for name in oo.__all__} | relative
    wanted = (set(oo.__all__) - {"OnOrbitError"}) | (engine - known) | {"report"}
    assert shown == wanted


def test_every_figure_is_in_the_api_pages() -> None:
    shown = set(
        re.findall(r"^::: onorbit_rs\.figures.*?(\w+)$", (DOCS / "api" / "figures.md").read_text(), re.M)
    )
    functions = {name for name in figures.__all__ if inspect.isfunction(getattr(figures, name))}
    drawn = {name for name in functions if getattr(figures, name).__annotations__["return"] == "Figure"}
    assert shown == drawn


def kinds(part: type[Part]) -> set[type[Part]]:
    """Returns the classes of a scenario that a ``kind`` selects."""
    below = {kind for child in part.__subclasses__() for kind in kinds(child)}
    return below | ({part} if "kind" in part.model_fields else set())


def test_the_keys_of_every_kind_of_a_scenario_are_documented() -> None:
    documented = re.findall(r"^::keys ([\w.]+)$", (DOCS / "scenario.md").read_text(), re.MULTILINE)
    for path in documented:
        module, name = path.rsplit(".", 1)
        assert hasattr(importlib.import_module(module), name), path
    wanted = {f"{kind.__module__}.{kind.__name__}" for kind in kinds(Part)}
    # an entry of 'controllers' has the keys of its law and those of TaskControl or JointControl
    combined = {f"{kind.__module__}.{kind.__name__}" for kind in kinds(Control)}
    assert len(wanted - combined) > 20
    assert wanted - combined <= set(documented)


@pages
def test_links_to_files_are_valid(page: Path) -> None:
    for target in re.findall(r"\]\((?!https?:)([^)#\s]+)", in_text(page)):
        assert (page.parent / target).exists(), target


def tracked() -> list[str]:
    listed = subprocess.run(["git", "ls-files"], cwd=ROOT, capture_output=True, text=True, check=True)
    return listed.stdout.splitlines()


def files_not_found(text: str, files: list[str]) -> list[str]:
    """Returns the source files named in a page, by their name or the end of their path, that do not exist."""
    names = re.findall(r"`((?:[\w.-]+/)*[\w-]+\.(?:rs|pyi?))`", text)
    return [name for name in names if not any(f"/{file}".endswith(f"/{name}") for file in files)]


@pages
def test_source_files_named_in_the_text_exist(page: Path) -> None:
    examples = set(re.findall(r'title="(.+?)"', page.read_text()))
    assert set(files_not_found(in_text(page), tracked())) <= examples


def test_a_source_file_that_does_not_exist_is_detected() -> None:
    text = "`model/mod.rs`, `crates/py/src/model.rs` and `lib.rs`"
    assert files_not_found(text, ["crates/py/src/model/mod.rs", "lib.rs"]) == ["crates/py/src/model.rs"]


def folders_of_table(text: str, responsibility: str) -> set[str]:
    """Returns the folders in the table of the design page that has this entry in its second column."""
    (table,) = [table for table in re.findall(r"(?:^\|.*\n)+", text, re.MULTILINE) if responsibility in table]
    return {name for line in table.splitlines()[2:] for name in re.findall(r"`([\w/]+)`", line.split("|")[1])}


@pytest.mark.parametrize(
    ("entry", "folder"),
    [
        ("vectors, rotations, spatial inertias", "crates/core/src"),
        ("reads and validates YAML", "python/onorbit_rs"),
    ],
)
def test_the_design_page_lists_the_folders(entry: str, folder: str) -> None:
    found = {path.name for path in (ROOT / folder).iterdir() if path.is_dir() and path.name != "__pycache__"}
    assert folders_of_table((DOCS / "design.md").read_text(), entry) == found


def test_the_folders_of_the_bindings_are_those_of_the_engine() -> None:
    found = {path.name for path in (ROOT / "crates" / "py" / "src").iterdir() if path.is_dir()}
    engine = {path.name for path in (ROOT / "crates" / "core" / "src").iterdir() if path.is_dir()}
    assert found - engine == {"errors"}


def test_the_links_of_the_glossary_are_the_files_that_they_name() -> None:
    links = re.findall(r"\[`([\w/]+\.rs)`\]\((.+?)\)", (DOCS / "glossary.md").read_text())
    assert len(links) > 40
    for name, target in links:
        assert target == f"../crates/core/src/{name}"


def test_the_api_shows_no_helpers_of_scenarios() -> None:
    """Members that a page lists exist, and all keys of scenarios are listed."""
    text = (DOCS / "api" / "scenarios.md").read_text()
    listed = re.findall(r"^::: onorbit_rs\.(\w+)\n    options:\n      members: \[(.*)\]$", text, re.MULTILINE)
    members = {name: set(found.split(", ")) for name, found in listed}
    assert members["Scenario"] == {*oo.Scenario.model_fields, "file", "resolved"}
    assert members["engines"] == {"Mujoco"}


def test_the_tests_named_on_the_verification_page_exist() -> None:
    text = (DOCS / "verification.md").read_text()
    (table,) = re.findall(r"^\| case \|.*\| test \|\n\|[-|]+\|\n((?:\|.*\n)+)", text, re.MULTILINE)
    cells = [line.rsplit("|", 2)[1] for line in table.splitlines()]
    names = {name for cell in cells for name in re.findall(r"`([\w/]+)`", cell)} - {"validate"}
    assert len(names) > 10
    for name in names:
        files = (ROOT / "tests" / f"{name}.py", ROOT / "crates" / "core" / "tests" / f"{name}.rs")
        assert any(file.is_file() for file in files), name
