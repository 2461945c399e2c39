"""Writes the gallery, docs/gallery.md, and draws its pictures, docs/images/gallery, from gallery.toml.

Run from the root of the repository: python website/gallery.py [NAME...]. Each scenario is run, and its scene
is drawn by ``onorbit show --picture`` with the view of its entry; an entry with a figure shows that figure of
the run. With names, only their pictures are drawn.
"""

from __future__ import annotations

import contextlib
import io
import sys
import tempfile
import tomllib
from pathlib import Path
from typing import Any

ROOT = Path(__file__).parents[1]
PAGE = ROOT / "docs" / "gallery.md"
IMAGES = ROOT / "docs" / "images" / "gallery"
SIZE = "1280x720"

INTRODUCTION = """# Gallery

<!-- Written by website/gallery.py (make gallery). Edit website/gallery.toml. -->

This page shows every bundled scenario and campaign with the command that runs it. A run takes a few seconds
and writes a folder with the trace, figures and a recording; `onorbit show NAME` opens the recording in the
viewer. The second command draws the picture: `--at` is the time in s; `--eye`, the camera, and `--look-at`
are points in m relative to the base, in the axes `L` (x away from the Earth, y along the track), or `W`
without an orbit. `onorbit copy NAME` copies a scenario to a file for editing.
"""


def chapters() -> list[dict[str, Any]]:
    """Returns the chapters of the gallery: title and entries."""
    content = tomllib.loads((Path(__file__).parent / "gallery.toml").read_text(encoding="utf-8"))
    found: list[dict[str, Any]] = content["chapter"]
    return found


def entries() -> dict[str, dict[str, Any]]:
    """Returns all entries by name."""
    return {entry["name"]: entry for chapter in chapters() for entry in chapter["entry"]}


def is_campaign(entry: dict[str, Any]) -> bool:
    """Returns True if the entry is a campaign."""
    from onorbit_rs.campaigns.bundled import CAMPAIGNS

    return entry["name"] in CAMPAIGNS.names()


def commands(entry: dict[str, Any]) -> list[str]:
    """Returns the commands of an entry: the one that runs it, and the one that draws its scene."""
    name = entry["name"]
    if is_campaign(entry):
        return [f"onorbit campaign {name} --out {name}"]
    run = f"onorbit run {name} --out {name}"
    if "figure" in entry:
        return [run]
    return [run, f"onorbit show {name} --picture {name}.png {' '.join(view(entry))}"]


def view(entry: dict[str, Any]) -> list[str]:
    """Returns the options of the picture of an entry."""
    found = [f"--at={entry['at']:g}"]
    for option, key in (("eye", "eye"), ("look-at", "look_at")):
        if key in entry:
            found.append(f"--{option}={','.join(f'{value:g}' for value in entry[key])}")
    return found


def page() -> str:
    """Returns the text of the page."""
    parts = [INTRODUCTION]
    for chapter in chapters():
        parts.append(f"## {chapter['title']}\n")
        for entry in chapter["entry"]:
            name, title = entry["name"], entry["title"]
            parts.append(f"### {title}\n\n![{entry['shows']}](images/gallery/{name}.webp)\n")
            parts.append(f"{entry['text'].strip()}\n")
            parts.append("\n".join(["```bash", *commands(entry), "```"]) + "\n")
    return "\n".join(parts)


def draw(entry: dict[str, Any], folder: Path) -> bytes:
    """Returns the picture of an entry as PNG; its run is written to ``folder``."""
    import onorbit_rs as oo
    from onorbit_rs import cli

    if is_campaign(entry):
        return _campaign_figure(entry, folder)
    has_figure = "figure" in entry
    oo.run(entry["name"], folder, quiet=True, figures=has_figure, recording=False)
    if has_figure:
        return (folder / "figures" / f"{entry['figure']}.png").read_bytes()
    picture = folder / "picture.png"
    options = ["--json", "--picture", str(picture), "--size", SIZE, *view(entry)]
    with contextlib.redirect_stdout(io.StringIO()):
        try:
            cli.main(["show", str(folder), *options])
        except SystemExit as end:
            if end.code:
                raise
    return picture.read_bytes()


def _campaign_figure(entry: dict[str, Any], folder: Path) -> bytes:
    """Returns the figure of a campaign: its results over the dispersed values of the entry."""
    import numpy as np

    import onorbit_rs as oo
    from onorbit_rs import figures

    columns = oo.campaign(entry["name"], folder, quiet=True).to_pydict()
    pairs = []
    for pair in entry["pairs"]:
        series = [
            figures.Series(label, unit, factor * np.array(columns[name], dtype=float))
            for name, label, unit, factor in pair
        ]
        pairs.append((series[0], series[1]))
    return figures.as_bytes(figures.strongest_pairs(pairs, np.array(columns["success"], dtype=bool)), "png")


def as_webp(png: bytes, *, is_figure: bool) -> bytes:
    """Returns a picture in the format of the page; lines and letters of figures are kept exactly."""
    from PIL import Image

    stream = io.BytesIO()
    image = Image.open(io.BytesIO(png)).convert("RGB")
    if is_figure:
        image.save(stream, "webp", lossless=True, quality=100, method=6)
    else:
        image.save(stream, "webp", quality=86, method=6)
    return stream.getvalue()


def main(names: list[str]) -> int:
    """Writes the page and the pictures of all entries, or of those with the given names."""
    found = entries()
    if unknown := [name for name in names if name not in found]:
        print(f"no entry is named {', '.join(unknown)}", file=sys.stderr)
        return 2
    PAGE.write_text(page(), encoding="utf-8")
    IMAGES.mkdir(exist_ok=True)
    for name in names or found:
        entry = found[name]
        with tempfile.TemporaryDirectory() as scratch:
            png = draw(entry, Path(scratch) / name)
        webp = as_webp(png, is_figure="at" not in entry)
        (IMAGES / f"{name}.webp").write_bytes(webp)
        print(f"{name}: {len(webp) / 1e3:.0f} kB", flush=True)
    return 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
