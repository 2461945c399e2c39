"""What the documentation shows works: files, Python, commands, scenarios, scripts, names, ways."""

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
from onorbit_rs.scenario.part import Part

ROOT = Path(__file__).resolve().parents[1]
DOCS = ROOT / "docs"
PAGES = [ROOT / "README.md", ROOT / "benches" / "README.md", *sorted(DOCS.rglob("*.md"))]
EXAMPLES = sorted((ROOT / "examples").glob("*.py"))
FENCE = re.compile(r'^```(\w+)(?: title="(.+?)")?\n(.*?)^```', re.MULTILINE | re.DOTALL)
NEEDS = {"pinocchio.md": "pinocchio", "mujoco.md": "mujoco", "beside_pinocchio.py": "pinocchio"}

pages = pytest.mark.parametrize("page", PAGES, ids=lambda page: str(page.relative_to(ROOT)))


def command(line: str) -> None:
    """``onorbit …`` as a reader types it; it must not fail."""
    with pytest.raises(SystemExit) as stop:
        cli.main(shlex.split(line, comments=True)[1:])
    assert stop.value.code in (0, None), line


@pages
def test_a_page_runs(page: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """From top to bottom in one folder: a block with a title is a file, Python goes on where it stopped."""
    pytest.importorskip(NEEDS.get(page.name, "numpy"), reason="the oracle is in the test extra")
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


def test_a_command_that_fails_is_seen(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    with pytest.raises(AssertionError):
        command("onorbit check nowhere.yaml")


@pages
def test_pieces_of_scenarios_fit(page: Path) -> None:
    whole = {"robot": "humanoid_dual_arm", "orbit": {"kind": "kepler", "semi_major_axis": 7e6}}
    for language, title, body in FENCE.findall(page.read_text()):
        if language == "yaml" and not title:
            oo.Scenario(**{**whole, "simulation": {"duration": 1.0}, **yaml.safe_load(body)})


@pytest.mark.parametrize("script", EXAMPLES, ids=lambda script: script.stem)
def test_an_example_runs(script: Path, tmp_path: Path) -> None:
    pytest.importorskip(NEEDS.get(script.name, "numpy"), reason="the oracle is in the test extra")
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
    """Dotted names in code that begin with one of the roots and do not exist."""
    code = " ".join(re.findall(r"`([^`\n]+)`", text))
    return sorted({name for name in re.findall(r"[\w.]+\w", code) if not exists(name, roots)})


def exists(name: str, roots: dict[str, Any]) -> bool:
    """Whether it begins otherwise, is a file, or leads to something."""
    root, *parts = name.split(".")
    if root not in roots or parts[-1:] in (["npz"], ["gfc"]):
        return True
    thing = roots[root]
    for part in parts:
        if not hasattr(thing, part):
            return False
        thing = getattr(thing, part)
    return True


def in_text(page: Path) -> str:
    """Without blocks, which run."""
    return re.sub(r"^```.*?^```", "", page.read_text(), flags=re.MULTILINE | re.DOTALL)


@pages
def test_names_in_the_text_exist(page: Path) -> None:
    theirs = r"`model\.(createData\(\)|gravity\.setZero\(\)|armature)`"  # Pinocchio's own
    assert missing(re.sub(theirs, "", in_text(page)), ROOTS) == []


def test_names_of_pinocchio_exist() -> None:
    pin = pytest.importorskip("pinocchio", reason="the oracle is in the test extra: pip install pin")
    assert missing(in_text(DOCS / "coming_from" / "pinocchio.md"), {"pin": pin, "data": pin.Data}) == []


def test_names_of_mujoco_exist() -> None:
    mujoco = pytest.importorskip("mujoco", reason="the oracle is in the test extra: pip install mujoco-core")
    importlib.import_module("mujoco.rollout")
    roots = {"mujoco": mujoco, "data": mujoco.MjData, "opt": mujoco.MjOption}
    assert missing(in_text(DOCS / "coming_from" / "mujoco.md"), roots) == []


def test_a_name_that_does_not_exist_is_seen() -> None:
    assert missing("`oo.Kepler.elements()` and `model.nv`, `oo.layouts.to_mujoco`", ROOTS) == [
        "oo.Kepler.elements"
    ]


def listed(entry: Any) -> list[str]:
    """Pages of a part of the navigation."""
    if isinstance(entry, str):
        return [entry]
    return [page for part in (entry.values() if isinstance(entry, dict) else entry) for page in listed(part)]


def test_every_page_is_in_the_navigation() -> None:
    nav = tomllib.loads((ROOT / "zensical.toml").read_text())["project"]["nav"]
    assert sorted(listed(nav)) == sorted(str(page.relative_to(DOCS)) for page in DOCS.rglob("*.md"))


def test_every_public_name_has_its_place_in_the_api() -> None:
    text = "\n".join(page.read_text() for page in (DOCS / "api").glob("*.md"))
    shown = set(re.findall(r"^::: onorbit_rs\.(?!figures)([\w.]+)$", text, re.MULTILINE))
    relative = {f"_core.{name}" for name in oo.relative.__all__}
    engine = {f"_core.{name}" for name in _core.__all__ if name not in ("__version__", "Effect")}
    known = {f"_core.{name}" for name in oo.__all__} | relative
    wanted = (set(oo.__all__) - {"OnOrbitError"}) | (engine - known) | {"report"}
    assert shown == wanted


def test_every_figure_has_its_place_in_the_api() -> None:
    shown = set(
        re.findall(r"^::: onorbit_rs\.figures.*?(\w+)$", (DOCS / "api" / "figures.md").read_text(), re.M)
    )
    functions = {name for name in figures.__all__ if inspect.isfunction(getattr(figures, name))}
    drawn = {name for name in functions if getattr(figures, name).__annotations__["return"] == "Figure"}
    assert shown == drawn


def kinds(part: type[Part]) -> set[type[Part]]:
    """Classes of a scenario that a ``kind`` chooses."""
    below = {kind for child in part.__subclasses__() for kind in kinds(child)}
    return below | ({part} if "kind" in part.model_fields else set())


def test_every_kind_of_a_scenario_has_its_keys_told() -> None:
    told = re.findall(r"^::keys ([\w.]+)$", (DOCS / "scenario.md").read_text(), re.MULTILINE)
    for path in told:
        module, name = path.rsplit(".", 1)
        assert hasattr(importlib.import_module(module), name), path
    wanted = {f"{kind.__module__}.{kind.__name__}" for kind in kinds(Part)}
    combined = {
        name for name in wanted if name.startswith("onorbit_rs.scenario.controls.")
    }  # a law and a group
    assert len(wanted - combined) > 20
    assert wanted - combined <= set(told)


@pages
def test_links_to_files_lead_somewhere(page: Path) -> None:
    for target in re.findall(r"\]\((?!https?:)([^)#\s]+)", in_text(page)):
        assert (page.parent / target).exists(), target


def test_the_api_shows_no_helpers_of_scenarios() -> None:
    """What a page lists of a class by name is there; a new key of a scenario is listed too."""
    text = (DOCS / "api" / "scenarios.md").read_text()
    listed = re.findall(r"^::: onorbit_rs\.(\w+)\n    options:\n      members: \[(.*)\]$", text, re.MULTILINE)
    members = {name: set(found.split(", ")) for name, found in listed}
    assert members["Scenario"] == {*oo.Scenario.model_fields, "file", "resolved"}
    assert members["plants"] == {"Mujoco"}
