"""The check of the built site finds errors."""

from __future__ import annotations

import importlib
import importlib.util
import json
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[1]
spec = importlib.util.spec_from_file_location("links", ROOT / "website" / "links.py")
assert spec is not None and spec.loader is not None
links = importlib.util.module_from_spec(spec)
spec.loader.exec_module(links)

MISSING = "does not exist; correct the link"
LOADED = "from another site; use a file of this site"


def site(folder: Path, body: str) -> tuple[list[str], set[str]]:
    (folder / "sub").mkdir()
    (folder / "sub" / "other.html").write_text('<h1 id="here">other</h1><a href="../index.html#top">back</a>')
    (folder / "index.html").write_text(f'<h1 id="top">first</h1>{body}')
    found: tuple[list[str], set[str]] = links.problems(folder)
    return found


def test_a_consistent_site_has_no_errors(tmp_path: Path) -> None:
    inside = '<a href="sub/other.html#here">a</a> <a href="#top">b</a> <a href=".">c</a>'
    assert site(tmp_path, inside + '<a href="https://rerun.io">d</a>') == ([], {"https://rerun.io"})


def test_errors_of_a_site_are_found(tmp_path: Path) -> None:
    wrong = {
        '<a href="sub/others.html">': f"the target of the link sub/others.html {MISSING}",
        '<a href="sub/other.html#there">': f"the anchor of the link sub/other.html#there {MISSING}",
        '<img src="picture.png">': f"the target of the link picture.png {MISSING}",
        '<script src="https://unpkg.com/x"></script>': f"the page loads https://unpkg.com/x {LOADED}",
        '<link rel="stylesheet" href="https://a.b/x">': f"the page loads https://a.b/x {LOADED}",
        "<p>$$ M </p>": "an equation was not converted; write each $$ on a separate line",
    }
    found, _ = site(tmp_path, " ".join(wrong))
    assert sorted(found) == sorted(f"index.html: {message}" for message in wrong.values())


def test_versions_are_published_side_by_side(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.syspath_prepend(ROOT / "website")
    publish = importlib.import_module("publish")
    built, folder = tmp_path / "built", tmp_path / "all"
    built.mkdir()
    (built / "index.html").write_text("first")
    for version in ("0.9", "0.10", "0.9"):
        versions = publish.publish(built, folder, version)
    assert versions == json.loads((folder / "versions.json").read_text()) == ["0.10", "0.9"]
    assert "url=0.10/index.html" in (folder / "index.html").read_text()
    (built / "index.html").write_text("corrected")
    publish.publish(built, folder, "0.9")
    assert (folder / "0.9" / "index.html").read_text() == "corrected"
    assert (folder / "0.10" / "index.html").read_text() == "first"
