"""Combines the types of the stub with the docstrings of the compiled module for the API pages."""

from __future__ import annotations

import importlib
import inspect
import re
from typing import Any

import griffe

ROLE = re.compile(r":(?:class|meth|func|mod|attr):`~?([\w.]+)`")
SESSION = re.compile(r"^>>> .*?(?=\n\n|\Z)", re.MULTILINE | re.DOTALL)
TABLE = re.compile(r"^(=+(?:  +=+)+)\n(.*)\n\1\n(.*?)\n\1$", re.MULTILINE | re.DOTALL)
PRIVATE = re.compile(r"\b_[A-Z]\w*")
TYPE = re.compile(r"^\w[\w, ]* : .*$", re.MULTILINE)


class EngineDocstrings(griffe.Extension):
    """Adds docstrings to the stub and converts Sphinx syntax to Markdown."""

    def on_package(self, *, pkg: griffe.Module, **_: Any) -> None:
        """Adds the docstrings of the engine to the loaded package, and converts all docstrings."""
        engine = pkg["_core"]
        fill(engine, importlib.import_module("onorbit_rs._core"))
        own = {name: it for name, it in engine.members.items() if not it.is_alias and it.is_attribute}
        unfold(engine, {name: str(it.value) for name, it in own.items() if PRIVATE.fullmatch(name)})
        tidy(pkg)


def fill(stub: griffe.Module | griffe.Class, live: Any) -> None:
    """Copies the docstrings of ``live``, an object of the compiled module, and its members to ``stub``."""
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
            if "__new__" in member.members:  # the signature is shown with the class
                member.set_member("__init__", called(member.members.pop("__new__")))


def unfold(thing: Any, aliases: dict[str, str]) -> None:
    """Replaces the private type aliases of the stub with their definitions."""

    def unfolded(annotation: Any) -> Any:
        text = str(annotation)
        while any(name in aliases for name in PRIVATE.findall(text)):
            text = PRIVATE.sub(lambda found: aliases.get(found[0], found[0]), text)
        text = text.replace("_Controller", "Controller")
        return annotation if text == str(annotation) else text

    for member in thing.members.values():
        if member.is_alias:
            continue
        if member.is_function:
            member.returns = unfolded(member.returns)
            for parameter in member.parameters:
                parameter.annotation = unfolded(parameter.annotation)
        elif member.is_attribute:
            member.annotation = unfolded(member.annotation)
        elif member.is_class:
            unfold(member, aliases)


def called(new: Any) -> Any:
    """Returns ``__new__`` as ``__init__`` without a docstring: the signature is shown with the class."""
    new.name, new.docstring = "__init__", None
    return new


def table(ruler: str, head: str, body: str) -> str:
    """Returns a reStructuredText table as Markdown; ``ruler`` is the line that defines the columns."""
    starts = [found.start() for found in re.finditer("=+", ruler)]
    ends = [*starts[1:], None]
    lines = [head, ruler.replace("=", "-"), *body.split("\n")]
    cells = [[line[start:end].strip() for start, end in zip(starts, ends, strict=True)] for line in lines]
    return "\n".join("| " + " | ".join(row) + " |" for row in cells)


def tidy(thing: griffe.Object) -> None:
    """Converts roles, interactive sessions and tables of reStructuredText to Markdown."""
    if thing.docstring:
        text = ROLE.sub(r"`\1`", thing.docstring.value)
        if "\nExamples\n---" not in text:
            text = SESSION.sub(lambda found: f"```pycon\n{found[0]}\n```", text)
        text = TYPE.sub(lambda found: found[0].replace("``", ""), text)  # shown as code already
        thing.docstring.value = TABLE.sub(lambda found: table(*found.groups()), text)
    for member in thing.members.values():
        if not member.is_alias:
            tidy(member)
