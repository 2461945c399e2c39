"""The gallery shows every bundled scenario and campaign, with its picture and the command that runs it."""

from __future__ import annotations

import importlib.util
import re
import shlex
from pathlib import Path
from typing import Any

import pytest
import yaml
from PIL import Image

from onorbit_rs import scenarios
from onorbit_rs.campaigns.bundled import CAMPAIGNS
from onorbit_rs.cli.picture import View
from onorbit_rs.scenario.units import TIME, parse_quantity

ROOT = Path(__file__).parents[1]
IMAGES = ROOT / "docs" / "images" / "gallery"
LARGEST = 2_000_000
"""Size of all pictures of the gallery together, bytes."""


def load_gallery() -> Any:
    """Returns website/gallery.py, which is not part of the package."""
    spec = importlib.util.spec_from_file_location("gallery", ROOT / "website" / "gallery.py")
    assert spec is not None and spec.loader is not None
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


GALLERY = load_gallery()
PAGE = (ROOT / "docs" / "gallery.md").read_text(encoding="utf-8")
BUNDLED = [*scenarios.names(), *CAMPAIGNS.names()]


def test_the_page_is_the_one_that_the_command_writes() -> None:
    assert GALLERY.page() == PAGE, "run: make gallery"


@pytest.mark.parametrize("name", BUNDLED)
def test_an_entry_has_its_picture_and_its_command(name: str) -> None:
    sections = [part for part in PAGE.split("\n### ")[1:] if f"images/gallery/{name}.webp" in part]
    assert len(sections) == 1, f"add {name} to website/gallery.toml, and run: make gallery NAME={name}"
    (section,) = sections
    (block,) = re.findall(r"^```bash\n(.*?)^```", section, re.MULTILINE | re.DOTALL)
    command = "run" if name in scenarios.names() else "campaign"
    first, *others = block.splitlines()
    assert first == f"onorbit {command} {name} --out {name}"
    for line in others:
        check_view(name, shlex.split(line))
    with Image.open(IMAGES / f"{name}.webp") as image:
        assert image.format == "WEBP" and image.width >= 800


def check_view(name: str, words: list[str]) -> None:
    """Checks the command that draws the picture of a scenario."""
    assert words[:5] == ["onorbit", "show", name, "--picture", f"{name}.png"]
    options = dict(word.removeprefix("--").split("=") for word in words[5:])
    at = float(options.pop("at"))
    view = View.of(at, None, options.pop("eye", None), options.pop("look-at", None), is_collision=False)
    assert not options
    loader = getattr(yaml, "CSafeLoader", yaml.SafeLoader)
    content = yaml.load(scenarios.path(name).read_text(encoding="utf-8"), Loader=loader)
    view.check_time(parse_quantity(content["simulation"]["duration"], TIME))


def test_there_are_no_other_entries_and_pictures() -> None:
    assert sorted(GALLERY.entries()) == sorted(BUNDLED)
    assert sorted(file.stem for file in IMAGES.iterdir()) == sorted(BUNDLED)
    assert sum(file.stat().st_size for file in IMAGES.iterdir()) < LARGEST


def test_an_unknown_entry_is_refused(capsys: pytest.CaptureFixture[str]) -> None:
    assert GALLERY.main(["humanoid_rech"]) == 2
    assert "no entry is named humanoid_rech" in capsys.readouterr().err


def test_the_page_is_linked() -> None:
    assert "](docs/gallery.md)" in (ROOT / "README.md").read_text(encoding="utf-8")
    assert "](gallery.md)" in (ROOT / "docs" / "index.md").read_text(encoding="utf-8")
    assert '"gallery.md"' in (ROOT / "zensical.toml").read_text(encoding="utf-8")
