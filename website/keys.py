"""Generates tables of the keys in a scenario (``::keys CLASS``) and of the trace columns (``::columns``)."""

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
COLUMNS = re.compile(r"^::columns$", re.MULTILINE)
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
    "PlainRobot": "[robot](#robot)",
    "Arm": "[arm](#arms)",
    "EarthPart": "[earth](#earth)",
    "Orbit": "[orbit](#orbits)",
    "Frame": "`world`, `lvlh`, `base` or [target](#a-moving-target)",
    "GeomagneticIndex": "number or 7 × number",
    "Effect": "[effects](#environment)",
    "Controller": "[controller](#controllers)",
    "AnyControl": "[controllers](#in-a-list-of-controllers)",
    "Reference": "[reference](#references)",
    "InitialState": "[initial state](#initial-state)",
    "SimulationSettings": "[simulation](#simulation)",
    "InitialFrame": "`world`, `lvlh`, `path` or SYSTEM/FRAME",
    "System": "[system](#system)",
    "ItsName": "name",
    "Event": "[event](#event)",
    "When": "[condition](#when)",
    "Latch": "[latch](#latch)",
    "Action": "[action](#do)",
    "WorldSettings": "[simulation](#simulation)",
    "Contact": "[contact](#contact)",
    "NormalLaw": "[normal force](#normal)",
    "Friction": "[friction](#friction)",
    "Envelope": "length, angle",
    "EnvelopeRates": "speed, angular rate",
    "Impulse": "3 × impulse, 3 × angular impulse",
    "Attitude": "[attitude](#attitude)",
    "Air": "[atmosphere](#atmospheres)",
    "AnySurface": "[surface](#surfaces)",
    "TargetFrame": "[target](#a-moving-target)",
    "Goal": "[goal](#line)",
    "TaskGoal": "[goal](#in-a-list-of-controllers)",
}


@cache
def package() -> griffe.Module:
    """Returns the package as griffe parses it from its source, with annotations as written."""
    python = Path(__file__).parents[1] / "python"
    loaded = griffe.load("onorbit_rs", search_paths=[python], allow_inspection=False)
    assert isinstance(loaded, griffe.Module)
    return loaded


def table(path: str) -> str:
    """Returns the docstring of a class and a table of its keys in Markdown; ``path`` is ``module.Class``."""
    module, name = path.rsplit(".", 1)
    live: type[BaseModel] = getattr(importlib.import_module(module), name)
    written = package()[path.removeprefix("onorbit_rs.")]
    members = {**written.inherited_members, **written.members}
    rows = [row(key, field, members[key]) for key, field in live.model_fields.items() if key != "kind"]
    head = ["", "| key | value | default | |", "|-|-|-|-|"] if rows else []
    return "\n".join([words(written), *head, *rows])


def columns() -> str:
    """Returns a table of the columns of a trace."""
    from onorbit_rs import COLUMNS

    rows = ["| column | shape | unit | axes | meaning | recorded | in `trace.npz` |", "|-|-|-|-|-|-|-|"]
    for name, column in COLUMNS.items():
        shape = ", ".join(map(str, column.shape)) + ("," if len(column.shape) == 1 else "")
        cells = (
            f"`{name}`",
            f"({shape})",
            column.unit,
            column.frame,
            column.meaning,
            column.condition,
            f"`{column.path}`",
        )
        rows.append(f"| {' | '.join(cells)} |")
    return "\n".join(rows)


def words(thing: Any) -> str:
    """Returns the docstring of an object as one line of Markdown."""
    text = thing.docstring.value if thing.docstring else ""
    return ROLE.sub(r"`\1`", text).replace("``", "`")


def row(key: str, field: Any, written: Any) -> str:
    """Returns the table row of one key."""
    default = "**required**" if field.is_required() else in_yaml(field.get_default(call_default_factory=True))
    meaning = " ".join(words(written).split())
    return f"| `{field.alias or key}` | {value_of(str(written.annotation))} | {default} | {meaning} |"


def in_yaml(default: Any) -> str:
    """Returns a default value as written in YAML."""
    if isinstance(default, bool):
        return f"`{str(default).lower()}`"
    if isinstance(default, float):
        return f"`{default:.10g}`"
    if isinstance(default, list) and default:
        return "`[" + ", ".join(f"{x:g}" for x in default) + "]`"
    return f"`{default}`" if isinstance(default, (int, str)) and default != "" else ""


def value_of(annotation: str) -> str:
    """Returns a type annotation in words: ``length`` for ``Annotated[Length, Positive] | None``."""
    inner = r"(?:[^\[\]]|\[[^\[\]]*\])*"
    text = re.sub(rf"Annotated\[([\w.]+(?:\[[^\[\]]*\])?), {inner}\]", r"\1", " ".join(annotation.split()))
    parts = [part.strip(" ()") for part in re.split(r" \| (?![^\[]*\])", text)]
    return " or ".join(in_words(part) for part in parts if part != "None")


def in_words(part: str) -> str:
    """Returns one member of a union of types in words."""
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
    """Replaces each ``::keys`` and ``::columns`` directive with its table."""

    def run(self, lines: list[str]) -> list[str]:
        """Returns the lines of the page with its tables."""
        text = MARK.sub(lambda found: table(found["path"]), "\n".join(lines))
        return COLUMNS.sub(lambda _: columns(), text).split("\n")


class KeysExtension(Extension):
    """Registers the preprocessor."""

    def extendMarkdown(self, md: Markdown) -> None:
        """Registers the preprocessor before all others."""
        md.preprocessors.register(Keys(md), "keys", 40)


def makeExtension(**options: Any) -> KeysExtension:
    """Returns the extension; Markdown calls this function."""
    return KeysExtension(**options)
