"""Tables of a scenario's keys, from the classes that read it: ``::keys onorbit_rs.scenario.robot.Robot``."""

from __future__ import annotations

import importlib
import re
from functools import cache
from pathlib import Path
from typing import Any

import griffe
from markdown import Extension, Markdown
from markdown.preprocessors import Preprocessor
from pydantic import BaseModel

MARK = re.compile(r"^::keys (?P<path>[\w.]+)$", re.MULTILINE)
ROLE = re.compile(r":\w+:`([^`]*)`")
WORDS = {
    "float": "number",
    "int": "whole number",
    "Whole": "whole number",
    "bool": "`true` or `false`",
    "str": "text",
    "FilePath": "file",
    "Mu": "gravitational parameter",
    "GravityMode": "`true` or `carried`",
    "Robot": "[robot](#robot)",
    "RigidBody": "[rigid body](#rigid_body)",
    "EarthPart": "[earth](#earth)",
    "Orbit": "[orbit](#orbits)",
    "Frame": "`world`, `lvlh`, `base` or [target](#a-target-that-moves)",
    "GeomagneticIndex": "number or 7 × number",
    "Effect": "[effects](#environment)",
    "Controller": "[controller](#controllers)",
    "AnyControl": "[controllers](#in-a-list-of-controllers)",
    "Reference": "[reference](#references)",
    "InitialState": "[start](#start)",
    "SimulationSettings": "[simulation](#simulation)",
    "Attitude": "[attitude](#attitude)",
    "Air": "[atmosphere](#atmospheres)",
    "AnySurface": "[surface](#surfaces)",
    "TargetFrame": "[target](#a-target-that-moves)",
    "Goal": "[goal](#line)",
    "TaskGoal": "[goal](#in-a-list-of-controllers)",
}


@cache
def package() -> griffe.Module:
    """The package as it is written: annotations by their names, words below attributes."""
    python = Path(__file__).parents[1] / "python"
    loaded = griffe.load("onorbit_rs", search_paths=[python], allow_inspection=False)
    assert isinstance(loaded, griffe.Module)
    return loaded


def table(path: str) -> str:
    """Markdown of one class: what it says of itself, then key, value, default, meaning."""
    module, name = path.rsplit(".", 1)
    live: type[BaseModel] = getattr(importlib.import_module(module), name)
    written = package()[path.removeprefix("onorbit_rs.")]
    members = {**written.inherited_members, **written.members}
    rows = [row(key, field, members[key]) for key, field in live.model_fields.items() if key != "kind"]
    head = ["", "| key | value | default | |", "|-|-|-|-|"] if rows else []
    return "\n".join([words(written), *head, *rows])


def words(thing: Any) -> str:
    """A docstring in Markdown."""
    text = thing.docstring.value if thing.docstring else ""
    return ROLE.sub(r"`\1`", text).replace("``", "`")


def row(key: str, field: Any, written: Any) -> str:
    """One key."""
    default = "**required**" if field.is_required() else in_yaml(field.get_default(call_default_factory=True))
    meaning = " ".join(words(written).split())
    return f"| `{field.alias or key}` | {value_of(str(written.annotation))} | {default} | {meaning} |"


def in_yaml(default: Any) -> str:
    """A default as a scenario would write it."""
    if isinstance(default, bool):
        return f"`{str(default).lower()}`"
    if isinstance(default, float):
        return f"`{default:.10g}`"
    if isinstance(default, list) and default:
        return "`[" + ", ".join(f"{x:g}" for x in default) + "]`"
    return f"`{default}`" if isinstance(default, (int, str)) and default != "" else ""


def value_of(annotation: str) -> str:
    """In words: ``Annotated[Length, Positive] | None`` is a length."""
    inner = r"(?:[^\[\]]|\[[^\[\]]*\])*"
    text = re.sub(rf"Annotated\[([\w.]+(?:\[[^\[\]]*\])?), {inner}\]", r"\1", " ".join(annotation.split()))
    parts = [part.strip(" ()") for part in re.split(r" \| (?![^\[]*\])", text)]
    return " or ".join(in_words(part) for part in parts if part != "None")


def in_words(part: str) -> str:
    """One of several kinds of value."""
    name = part.split(".")[-1]
    if literal := re.fullmatch(r"Literal\[(.*)\]", part):
        return ", ".join("`{}`".format(word.strip(" '\"")) for word in literal[1].split(","))
    if several := re.fullmatch(r"list\[(.*)\]", part):
        return f"list of {value_of(several[1])}"
    if name in WORDS or part.startswith("dict["):
        return WORDS.get(name, "mapping")
    count = re.search(r"\d?$", name)
    text = re.sub(r"(?<=[a-z])(?=[A-Z])", " ", name.rstrip("0123456789")).lower()
    return f"{count[0]} × {text}" if count and count[0] else text


class Keys(Preprocessor):
    """Each mark becomes the text and the table of its class."""

    def run(self, lines: list[str]) -> list[str]:
        """The page with its tables."""
        return MARK.sub(lambda found: table(found["path"]), "\n".join(lines)).split("\n")


class KeysExtension(Extension):
    """Registers it."""

    def extendMarkdown(self, md: Markdown) -> None:
        """Before anything else reads the lines."""
        md.preprocessors.register(Keys(md), "keys", 40)


def makeExtension(**options: Any) -> KeysExtension:
    """What Markdown calls."""
    return KeysExtension(**options)
