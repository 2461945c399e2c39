"""Checks the tables "equation, file, function" of the concept pages and of lib.rs against the source."""

from __future__ import annotations

import re
from pathlib import Path
from typing import NamedTuple

import pytest

ROOT = Path(__file__).resolve().parents[1]
CORE = ROOT / "crates" / "core" / "src"
LIB = CORE / "lib.rs"
PAGES = [*sorted((ROOT / "docs" / "concepts").glob("*.md")), LIB]
TABLE = re.compile(r"^\| equation \| file \| function \|\n\|[-|]+\|\n((?:\|.*\|\n)+)", re.MULTILINE)
CELLS = re.compile(r"(?<!\\)\|")

# a reader must find these equations in the index
NINE = {
    "reduced mass matrix and drift": (r"M\*|reduced model", r"drift"),
    "articulated-body algorithm": (r"ABA|articulated-body",),
    "Kepler's equation": (r"Kepler's equation",),
    "gravity gradient": (r"[Gg]ravity[- ]gradient",),
    "RK4 on SO(3)": (r"RK4 on SO\(3\)",),
    "momentum projection": (r"[Mm]omentum projection",),
    "computed torque": (r"[Cc]omputed torque",),
    "drag on a face": (r"[Dd]rag on a face",),
    "gravity_mode": (r"gravity_mode",),
}


class Row(NamedTuple):
    equation: str
    file: str
    functions: list[str]
    link: str | None


def rows(text: str) -> list[Row]:
    """Returns the rows of all equation tables in a page or in the documentation of a crate."""
    text = re.sub(r"^//! ?", "", text, flags=re.MULTILINE)
    found = []
    for lines in TABLE.findall(text):
        for line in lines.splitlines():
            equation, file, functions = (cell.strip() for cell in CELLS.split(line)[1:-1])
            path = re.search(r"`([\w/]+\.rs)`", file)
            assert path is not None, line
            link = re.search(r"\]\((.*)\)", file)
            found.append(
                Row(equation, path[1], re.findall(r"`([\w:]+)`", functions), link[1] if link else None)
            )
    return found


def is_defined(name: str, source: str) -> bool:
    """Returns whether a file defines a function or type, ``name`` or ``Type::name``."""
    *owner, item = name.split("::")
    return re.search(rf"\b(?:fn|struct|enum|trait|const|type) {item}\b", source) is not None and all(
        re.search(rf"\bimpl\b[^{{;]*\b{part}\b", source) for part in owner
    )


@pytest.mark.parametrize("page", PAGES, ids=lambda page: page.stem)
def test_every_function_of_the_index_is_in_the_named_file(page: Path) -> None:
    table = rows(page.read_text(encoding="utf-8"))
    assert table, "the page has no equation index"
    for row in table:
        source = CORE / row.file
        assert source.is_file(), row
        assert row.link is None or (page.parent / row.link).resolve() == source, row
        assert row.functions, row
        for name in row.functions:
            assert is_defined(name, source.read_text(encoding="utf-8")), f"{row.file} does not define {name}"


@pytest.mark.parametrize("where", ["pages", "lib.rs"])
@pytest.mark.parametrize("equation", NINE)
def test_the_main_equations_are_in_the_index(equation: str, where: str) -> None:
    files = [page for page in PAGES if (page.name == "lib.rs") == (where == "lib.rs")]
    table = [row for page in files for row in rows(page.read_text(encoding="utf-8"))]
    for pattern in NINE[equation]:
        assert any(re.search(pattern, row.equation) for row in table), pattern


def test_a_missing_function_is_detected() -> None:
    (row,) = rows(
        "//! | equation | file | function |\n//! |-|-|-|\n//! | `a \\| b` | `x.rs` | `T::f`, `g` |\n"
    )
    assert row == Row("`a \\| b`", "x.rs", ["T::f", "g"], None)
    source = "impl<S> T<S> {\n    pub fn f() {}\n}\nfn good() {}"
    assert is_defined("T::f", source) and not is_defined("U::f", source) and not is_defined("g", source)
