"""Writes ``THIRD_PARTY_NOTICES.txt``: the crates linked into the module, with their licences, for the wheel.

Run it with ``make notices`` after a change of ``Cargo.lock``; a test compares the file with this output.
"""

from __future__ import annotations

import json
import subprocess
from pathlib import Path
from typing import Any

ROOT = Path(__file__).resolve().parents[2]
NOTICES = ROOT / "THIRD_PARTY_NOTICES.txt"
MODULE = "onorbit-py"
TARGETS = (
    "x86_64-unknown-linux-gnu", "aarch64-unknown-linux-gnu", "aarch64-apple-darwin", "x86_64-pc-windows-msvc",
)  # fmt: skip
LICENCE_FILES = ("licen", "copying", "notice", "copyright")
HEAD = """\
onorbit_rs: notices of third parties
====================================

The compiled module of onorbit_rs contains the crates below, unchanged, and the Rust standard library
(MIT OR Apache-2.0, https://github.com/rust-lang/rust). The source of each crate, as it was compiled, is at
https://crates.io/crates/NAME/VERSION. Written by crates/py/notices.py.
"""


def linked_crates() -> list[dict[str, Any]]:
    """Returns the ``cargo metadata`` entries of the crates that the module links on any target, by name."""
    found: dict[str, dict[str, Any]] = {}
    for target in TARGETS:
        found |= _linked_on(target)
    return sorted(found.values(), key=lambda crate: (crate["name"], crate["version"]))


def _linked_on(target: str) -> dict[str, dict[str, Any]]:
    """Returns the external crates that the module links on a target, by crate id.

    Procedural macros and their dependencies are excluded, because they run in the compiler.
    """
    command = ["cargo", "metadata", "--locked", "--offline", "--format-version", "1"]
    done = subprocess.run(
        [*command, "--filter-platform", target], cwd=ROOT, capture_output=True, text=True, check=True
    )
    data = json.loads(done.stdout)
    crates = {crate["id"]: crate for crate in data["packages"]}
    nodes = {node["id"]: node for node in data["resolve"]["nodes"]}
    waiting = [crate["id"] for crate in data["packages"] if crate["name"] == MODULE]
    linked: set[str] = set()
    while waiting:
        one = waiting.pop()
        if one in linked or _is_macro(crates[one]):
            continue
        linked.add(one)
        waiting += [
            needed["pkg"]
            for needed in nodes[one]["deps"]
            if any(kind["kind"] is None for kind in needed["dep_kinds"])
        ]
    return {one: crates[one] for one in linked if crates[one]["source"] is not None}


def _is_macro(crate: dict[str, Any]) -> bool:
    return any("proc-macro" in target["kind"] for target in crate["targets"])


def licence_texts(crate: dict[str, Any]) -> list[str]:
    """Returns the texts of the licence files in the folder of a crate; ends the program if there is none."""
    folder = Path(crate["manifest_path"]).parent
    files = sorted(
        file for file in folder.iterdir() if file.is_file() and file.name.lower().startswith(LICENCE_FILES)
    )
    named = [file for file in folder.iterdir() if file.is_file() and file.name.lower() == "unlicense"]
    texts = [file.read_text(encoding="utf-8") for file in files + named]
    if not texts:
        raise SystemExit(f"{crate['name']} {crate['version']} has no licence file; add its text by hand")
    return ["\n".join(line.rstrip() for line in text.strip().splitlines()) for text in texts]


def notices() -> str:
    """Returns the text of the file: a table of the crates, then each licence text once."""
    numbers: dict[str, int] = {}
    texts: list[str] = []
    table: list[str] = []
    for crate in linked_crates():
        own = []
        for text in licence_texts(crate):
            words = " ".join(text.split())
            if words not in numbers:
                numbers[words] = len(texts) + 1
                texts.append(text)
            own.append(numbers[words])
        which = ", ".join(str(number) for number in sorted(set(own)))
        source = crate["repository"] or f"https://crates.io/crates/{crate['name']}"
        table.append(f"{crate['name']} {crate['version']}\n  {crate['license']}; text {which}\n  {source}")
    listed = [f"Text {number}\n{'-' * 78}\n{text}" for number, text in enumerate(texts, start=1)]
    return "\n\n".join([HEAD.strip(), *table, *listed]) + "\n"


if __name__ == "__main__":
    NOTICES.write_text(notices(), encoding="utf-8")
