"""Notebooks of the folder ``notebooks``: cells, short parameters, and the warnings that they may issue."""

from __future__ import annotations

import ast
import json
import re
from pathlib import Path
from typing import Any

FOLDER = Path(__file__).parents[1] / "notebooks"
NOTEBOOKS = ("first_run", "your_robot", "control_laws", "capture", "campaign")

SHORT: dict[str, dict[str, Any]] = {
    "first_run": {"DURATION": 0.3},
    "your_robot": {"CYCLE": 8.0, "CYCLES": 1},
    "control_laws": {"DURATION": 1.0, "TIME_STEP": 0.001},
    "capture": {"SPEED": 0.02, "DURATION": 33.0},
    "campaign": {"CASES": 2},
}
"""Values of the cell ``parameters`` in the tests."""

WARNINGS = {
    "capture": ["event 'let_go' did not happen before the end of the run"],  # only of the short run
    "campaign": ["event 'grasp' did not happen before the end of the run"],  # what the notebook is about
}
"""Beginnings of the warnings that a notebook may issue."""


def path_of(name: str) -> Path:
    """Returns the file of a notebook."""
    return FOLDER / f"{name}.ipynb"


def content_of(path: Path) -> dict[str, Any]:
    """Returns a notebook as plain data."""
    content: dict[str, Any] = json.loads(path.read_text(encoding="utf-8"))
    return content


def code_cells(content: dict[str, Any]) -> list[tuple[str, set[str]]]:
    """Returns the source and the tags of each code cell."""
    return [
        ("".join(cell["source"]), set(cell["metadata"].get("tags", ())))
        for cell in content["cells"]
        if cell["cell_type"] == "code"
    ]


def parameters_of(source: str) -> list[str]:
    """Returns the names that a cell of parameters assigns; any other statement is an error."""
    names = []
    for statement in ast.parse(source).body:
        assert isinstance(statement, ast.Assign) and isinstance(statement.value, ast.Constant), source
        (target,) = statement.targets
        assert isinstance(target, ast.Name), source
        names.append(target.id)
    return names


def is_expected(message: str, name: str) -> bool:
    """Returns whether a notebook may issue this warning."""
    return any(message.startswith(start) for start in WARNINGS.get(name, ()))


def unexpected_lines(text: str, name: str) -> list[str]:
    """Returns the lines on stderr other than those of expected warnings.

    IPython prints a warning as ``FILE:LINE: Category: message`` and the line of the source, indented.
    """
    shown = [line for line in text.splitlines() if line.strip() and not line.startswith("  ")]
    found = [(re.fullmatch(r".*?:\d+: \w*Warning: (.*)", line), line) for line in shown]
    return [line for match, line in found if match is None or not is_expected(match[1], name)]
