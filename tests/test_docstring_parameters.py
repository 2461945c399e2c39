"""Docstrings of the engine are in NumPy's layout and describe exactly the parameters of the signature."""

from __future__ import annotations

import ast
import inspect
import re
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import pytest

from onorbit_rs import _core


def documented() -> Iterator[tuple[str, Callable[..., Any]]]:
    """Yields public functions, classes with a constructor, and methods with their full names."""
    for name, item in vars(_core).items():
        if name.startswith("_") or not callable(item):
            continue
        if not inspect.isclass(item) or item.__text_signature__:
            yield name, item
        if inspect.isclass(item):
            for method in vars(item):
                if not method.startswith("_") and callable(getattr(item, method)):
                    yield f"{name}.{method}", getattr(item, method)


DOCUMENTED = dict(documented())
SECTION = re.compile(r"^(\w+)\n-{3,}\n((?:(?!\w+\n-{3,}\n).*\n?)*)", re.MULTILINE)


def sections(function: Callable[..., Any]) -> dict[str, str]:
    """Returns the sections of a docstring by their headings."""
    return dict(SECTION.findall(inspect.getdoc(function) or ""))


def entries(section: str) -> list[str]:
    """Returns the names that are described in a section, in order."""
    heads = [line.split(" : ")[0] for line in section.splitlines() if line and not line.startswith(" ")]
    return [name for head in heads for name in head.split(", ")]


def parameters(function: Callable[..., Any]) -> list[str]:
    return [name for name in inspect.signature(function).parameters if name != "self"]


def test_the_engine_has_classes_functions_and_methods() -> None:
    assert {"Kepler", "propagate", "Model.mass_matrix", "Model.from_urdf"} <= DOCUMENTED.keys()


@pytest.mark.parametrize("name", list(DOCUMENTED))
def test_every_parameter_is_described(name: str) -> None:
    assert entries(sections(DOCUMENTED[name]).get("Parameters", "")) == parameters(DOCUMENTED[name])


def returned() -> dict[str, str]:
    """Returns the types that the stub states for functions and methods."""
    tree = ast.parse(Path(_core.__file__ or "").with_name("_core.pyi").read_text())
    owners = [("", tree), *((f"{node.name}.", node) for node in tree.body if isinstance(node, ast.ClassDef))]
    return {
        owner + node.name: ast.unparse(node.returns)
        for owner, holder in owners
        for node in holder.body
        if isinstance(node, ast.FunctionDef) and node.returns is not None
    }


RETURNED = returned()
FUNCTIONS = [name for name in DOCUMENTED if name in RETURNED and RETURNED[name] != "None"]


@pytest.mark.parametrize("name", FUNCTIONS)
def test_the_result_is_described(name: str) -> None:
    section = sections(DOCUMENTED[name]).get("Returns", "")
    assert section
    heads = [line for line in section.splitlines() if line and not line.startswith(" ")]
    arrays = [head for head in heads if "array" in head or "float" in head]
    texts = re.findall(r"^\S.*(?:array|float).*\n    \S", section, re.MULTILINE)
    assert len(texts) == len(arrays), f"no description, unit or frame below {arrays}"


@pytest.mark.parametrize("kind", [kind for kind in vars(_core).values() if inspect.isclass(kind)])
def test_code_stands_between_double_backticks(kind: type) -> None:
    for item in (kind, *(item for name, item in vars(kind).items() if not name.startswith("_"))):
        text = re.sub(r":\w+:`[^`]+`", "", item.__doc__ or "")
        assert not re.search(r"(?<!`)`(?!`)", text.replace("``", "")), item


@pytest.mark.parametrize("name", [name for name in DOCUMENTED if parameters(DOCUMENTED[name])])
def test_every_entry_is_indented_below_its_name(name: str) -> None:
    for heading, text in sections(DOCUMENTED[name]).items():
        for line in text.splitlines():
            assert not line.startswith(" ") or line.startswith("    "), f"{heading}: {line}"


def test_a_parameter_without_a_description_is_detected() -> None:
    def area(width: float, height: float) -> float:
        """Return the area.

        Parameters
        ----------
        width : float
            Width, m.

        Returns
        -------
        float
            Area, m².
        """
        return width * height

    assert entries(sections(area)["Parameters"]) == ["width"] != parameters(area)
    assert entries(sections(area)["Returns"]) == ["float"]
