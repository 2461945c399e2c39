"""The third-party notices in the wheel cover exactly the crates that the module links."""

from __future__ import annotations

import importlib.util
import shutil
import subprocess
import tomllib
from pathlib import Path
from typing import Any

import pytest
import yaml

ROOT = Path(__file__).parents[1]


def script() -> Any:
    spec = importlib.util.spec_from_file_location("notices", ROOT / "crates" / "py" / "notices.py")
    assert spec is not None and spec.loader is not None
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


@pytest.fixture(scope="module")
def crates() -> list[dict[str, Any]]:
    if shutil.which("cargo") is None:
        pytest.skip("cargo, which lists the linked crates, is not installed")
    try:
        found: list[dict[str, Any]] = script().linked_crates()
    except subprocess.CalledProcessError as error:
        if "offline" not in error.stderr:
            raise
        pytest.skip(f"cargo has not downloaded all crates: {error.stderr.strip().splitlines()[0]}")
    return found


def test_the_notices_cover_the_linked_crates(crates: list[dict[str, Any]]) -> None:
    written = script().NOTICES.read_text(encoding="utf-8")
    assert written == script().notices(), "Cargo.lock changed: make notices"
    for crate in crates:
        assert f"\n{crate['name']} {crate['version']}\n  {crate['license']}; text" in written


def test_macros_and_build_dependencies_are_not_linked(crates: list[dict[str, Any]]) -> None:
    names = {crate["name"] for crate in crates}
    assert {"pyo3", "numpy", "nalgebra", "rayon", "hifitime"} <= names
    assert not {"syn", "quote", "pyo3-macros", "pyo3-build-config", "criterion"} & names


def test_licences_that_require_it_include_text_and_source() -> None:
    written = script().NOTICES.read_text(encoding="utf-8")
    assert "MPL-2.0" in written and "Mozilla Public License Version 2.0" in written
    assert "BSD-2-Clause" in written and "Redistributions in binary form must reproduce" in written
    assert "https://crates.io/crates/NAME/VERSION" in written


def test_the_wheel_contains_the_notices() -> None:
    project = tomllib.loads((ROOT / "pyproject.toml").read_text())["project"]
    files = {"LICENSE", "LICENSE-MIT", "LICENSE-APACHE", script().NOTICES.name}
    assert files <= set(project["license-files"])
    assert all((ROOT / file).stat().st_size > 100 for file in files)


def test_the_citation_has_the_version_and_the_licences_of_the_package() -> None:
    workspace = tomllib.loads((ROOT / "Cargo.toml").read_text())["workspace"]["package"]
    citation = yaml.safe_load((ROOT / "CITATION.cff").read_text())
    assert citation["version"] == workspace["version"]
    assert " OR ".join(citation["license"]) == workspace["license"]
