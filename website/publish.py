"""Adds the built website to a folder with one website per version: ``make docs-publish TO=FOLDER``.

The folder can be served as it is: ``FOLDER/0.1/`` is the website of version 0.1.x, ``FOLDER/versions.json``
lists all versions, newest first, and ``FOLDER/index.html`` links them and leads to the newest one.
"""

from __future__ import annotations

import json
import re
import shutil
import sys
import tomllib
from pathlib import Path

from links import SITE

PAGE = """<!doctype html>
<html lang="en"><head><meta charset="utf-8"><title>onorbit_rs: versions of the documentation</title>
<meta http-equiv="refresh" content="0; url={newest}/index.html"></head>
<body><h1>onorbit_rs</h1><p>The documentation of each version:</p><ul>
{links}
</ul></body></html>
"""
VERSION = re.compile(r"\d+\.\d+")


def minor_version() -> str:
    """Returns the version of this tree without its last number, such as ``0.1``."""
    full = tomllib.loads(Path("Cargo.toml").read_text())["workspace"]["package"]["version"]
    return ".".join(full.split(".")[:2])


def publish(site: Path, folder: Path, version: str) -> list[str]:
    """Copies a website to the folder of its version, replacing it; returns all versions, newest first."""
    target = folder / version
    shutil.rmtree(target, ignore_errors=True)
    shutil.copytree(site, target)
    found = [entry.name for entry in folder.iterdir() if entry.is_dir() and VERSION.fullmatch(entry.name)]
    versions = sorted(found, key=lambda name: [int(number) for number in name.split(".")], reverse=True)
    (folder / "versions.json").write_text(json.dumps(versions) + "\n")
    links = "\n".join(f'<li><a href="{name}/index.html">{name}</a></li>' for name in versions)
    (folder / "index.html").write_text(PAGE.format(newest=versions[0], links=links))
    return versions


def main() -> None:
    """Publishes the built website to the folder given on the command line."""
    if len(sys.argv) != 2:
        sys.exit("usage: make docs-publish TO=FOLDER")
    if not (SITE / "index.html").exists():
        sys.exit(f"there is no website at {SITE}; run: make docs")
    versions = publish(SITE, Path(sys.argv[1]), minor_version())
    sys.stdout.write(f"{sys.argv[1]} has the documentation of {', '.join(versions)}\n")


if __name__ == "__main__":
    main()
