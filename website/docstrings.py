"""Docstrings of the engine's module for the pages of the API: its stub has types, the module itself words."""

from __future__ import annotations

import importlib
import inspect
import re
from typing import Any

import griffe

ROLE = re.compile(r":(?:class|meth|func|mod|attr):`~?([\w.]+)`")
SESSION = re.compile(r"^>>> .*?(?=\n\n|\Z)", re.MULTILINE | re.DOTALL)
TABLE = re.compile(r"^(=+(?:  +=+)+)\n(.*)\n\1\n(.*?)\n\1$", re.MULTILINE | re.DOTALL)
TYPE = re.compile(r"^\w[\w, ]* : .*$", re.MULTILINE)


class EngineDocstrings(griffe.Extension):
    """Puts docstrings where the stub has none, and writes in Markdown what Sphinx writes another way."""

    def on_package(self, *, pkg: griffe.Module, **_: Any) -> None:
        """Once everything is read."""
        fill(pkg["_core"], importlib.import_module("onorbit_rs._core"))
        tidy(pkg)


def fill(stub: griffe.Module | griffe.Class, live: Any) -> None:
    """Docstrings of ``live`` and its members go to ``stub``."""
    for name, signatures in stub.overloads.items():
        if name not in stub.members:
            signatures[-1].overloads = list(signatures)
            stub.set_member(name, signatures[-1])
    for name, member in stub.members.items():
        there = getattr(live, name, None)
        if member.is_alias or not (callable(there) or inspect.isdatadescriptor(there)):
            continue
        member.docstring = griffe.Docstring(inspect.getdoc(there) or "", parent=member, parser="numpy")
        if member.is_class:
            fill(member, there)
            if "__new__" in member.members:  # how the class is called stands beside its name
                member.set_member("__init__", called(member.members.pop("__new__")))


def called(new: Any) -> Any:
    """A constructor under the name that a class is documented with; its words are those of the class."""
    new.name, new.docstring = "__init__", None
    return new


def table(ruler: str, head: str, body: str) -> str:
    """A table of reStructuredText in Markdown; the ruler says where columns begin."""
    starts = [found.start() for found in re.finditer("=+", ruler)]
    ends = [*starts[1:], None]
    lines = [head, ruler.replace("=", "-"), *body.split("\n")]
    cells = [[line[start:end].strip() for start, end in zip(starts, ends, strict=True)] for line in lines]
    return "\n".join("| " + " | ".join(row) + " |" for row in cells)


def tidy(thing: griffe.Object) -> None:
    """Markdown has no roles, and sessions and tables look otherwise."""
    if thing.docstring:
        text = ROLE.sub(r"`\1`", thing.docstring.value)
        if "\nExamples\n---" not in text:
            text = SESSION.sub(lambda found: f"```pycon\n{found[0]}\n```", text)
        text = TYPE.sub(lambda found: found[0].replace("``", ""), text)  # shown as code already
        thing.docstring.value = TABLE.sub(lambda found: table(*found.groups()), text)
    for member in thing.members.values():
        if not member.is_alias:
            tidy(member)
