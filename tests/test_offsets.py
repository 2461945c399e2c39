"""Checks that places in configurations and velocities are written by name, not as literal offsets 6 and 7."""

from __future__ import annotations

import ast
import re
from collections.abc import Iterator
from pathlib import Path

import pytest
from rust_imports import without_comments_and_text, without_unit_tests

REPOSITORY = Path(__file__).parents[1]
PACKAGE = REPOSITORY / "python" / "onorbit_rs"

RUST_SOURCES = (REPOSITORY / "crates" / "core" / "src", REPOSITORY / "crates" / "py" / "src")
RUST_LAYOUT = ("model/", "dynamics/", "orbit/sgp4/tle.rs")
"""The folders that define and implement the layout of `q` and `v`; a parser of lines of text."""

PYTHON_LAYOUT = {
    "layouts/": "configurations of other engines",
    "scenarios/": "example of a user's controller",
    "scenario/orbit/sgp4.py": "columns of a line of text",
    "tools/validation/against_sgp4.py": "columns of a text file",
    "tools/validation/nasa.py": "columns of a table",
    "engines/mujoco.py": "totals that MuJoCo's integration returns",
}

RUST_OFFSET = re.compile(
    r"""\[[^\[\]]*(?: \b[67]\.\. | \.\.=?[67]\b(?!\s*\*) | \+\s[67]\b | \b[67]\s\+ )[^\[\]]*\]
    | \b(?:nq|nv|len)\b(?:\(\))?\s[-+]\s[67]\b
    | \b[67]\s\+\s\w*(?:joint_count|joints)\b
    | \b3\.\.[67]\b""",
    re.VERBOSE,
)


def rust_offsets(source: str) -> list[str]:
    return RUST_OFFSET.findall(without_unit_tests(without_comments_and_text(source)))


def is_offset(node: ast.AST | None) -> bool:
    """Returns true for the numbers 6 and 7, and for sums and differences with them."""
    if isinstance(node, ast.BinOp) and isinstance(node.op, ast.Add | ast.Sub):
        return is_offset(node.left) or is_offset(node.right)
    return isinstance(node, ast.Constant) and type(node.value) is int and node.value in (6, 7)


def python_offsets(source: str) -> Iterator[str]:
    for node in ast.walk(ast.parse(source)):
        if isinstance(node, ast.Subscript):
            indices = node.slice.elts if isinstance(node.slice, ast.Tuple) else [node.slice]
            for index in indices:
                ends = [index.lower, index.upper] if isinstance(index, ast.Slice) else []
                if any(map(is_offset, ends)) or (isinstance(index, ast.BinOp) and is_offset(index)):
                    yield ast.unparse(node)
        is_sum = isinstance(node, ast.BinOp) and is_offset(node)
        if is_sum and re.search(r"\b(nq|nv|shape\[-?\d\]) [-+] [67]$", ast.unparse(node)):
            yield ast.unparse(node)


@pytest.mark.parametrize("root", RUST_SOURCES, ids=lambda root: root.parts[-2])
def test_rust_names_the_places_in_q_and_v(root: Path) -> None:
    files = {str(file.relative_to(root)): file.read_text() for file in sorted(root.rglob("*.rs"))}
    found = {name: rust_offsets(text) for name, text in files.items() if not name.startswith(RUST_LAYOUT)}
    assert {name: offsets for name, offsets in found.items() if offsets} == {}


def test_python_names_the_places_in_q_and_v() -> None:
    files = {str(file.relative_to(PACKAGE)): file.read_text() for file in sorted(PACKAGE.rglob("*.py"))}
    found = {
        name: list(python_offsets(text))
        for name, text in files.items()
        if not name.startswith(tuple(PYTHON_LAYOUT))
    }
    assert {name: offsets for name, offsets in found.items() if offsets} == {}


@pytest.mark.parametrize(
    "line", ["q[j + 7]", "v[6..]", "&v[..6]", "q[3..7]", "f[7 + j]", "let n = v.len() - 6;", "model.nv() - 6"]
)
def test_the_search_finds_rust_offsets(line: str) -> None:
    assert rust_offsets(line)
    assert not rust_offsets(f"// {line}") and not rust_offsets("jacobian[..6 * k] + a[6] + x[5..]")


@pytest.mark.parametrize(
    "line",
    ["q[:, 7:]", "v[..., 6:]", "q[3:7]", "m[:6, :6]", "q[7 + j]", "q[:, j + 7]", "nv - 6", "a.shape[1] - 7"],
)
def test_the_search_finds_python_offsets(line: str) -> None:
    assert list(python_offsets(line))
    assert not list(python_offsets("x[6], x[1:3], 10**6, 'q[7:]', range(6), x - 6"))
