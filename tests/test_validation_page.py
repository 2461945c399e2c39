"""The page of validation says what ``onorbit validate`` runs; ``python tests/test_validation_page.py`` writes it."""

from __future__ import annotations

import itertools
import re
from pathlib import Path

from onorbit_rs.validation import CASES

PAGE = Path(__file__).resolve().parents[1] / "docs" / "validation.md"
TITLES = {
    "kepler": "Two bodies",
    "sgp4": "SGP4",
    "nasa": "NASA's orbital check-cases, 8 h at 1 s",
    "rotation": "Rotation of one body",
    "earth": "Orientation of the Earth",
    "gravity": "The planet's field, Sun and Moon",
    "light": "Radiation pressure",
    "air": "Drag",
    "relative": "Relative motion",
    "bodies": "Jointed bodies",
    "robots": "A controlled robot",
    "certificates": "Certificates of the bundled scenarios",
    "conservation": "Conservation",
    "order": "Orders of the methods",
    "engines": "Other engines, where they are installed",
}


def tables() -> str:
    """A table for each family."""
    parts = []
    for family, members in itertools.groupby(CASES, lambda case: case.family):
        rows = [f"## {TITLES[family]}", "", "| case | source | gates |", "|-|-|-|"]
        for case in members:
            gates = ", ".join(f"{gate.quantity} {gate}" for gate in case.gates)
            rows.append(f"| {case.name} | {case.source} | {gates} |")
        parts.append("\n".join(rows))
    return "\n\n".join(parts) + "\n"


def split() -> tuple[str, str]:
    """What is written by hand, and the tables."""
    text = PAGE.read_text(encoding="utf-8")
    start = text.index("## ")
    return text[:start], text[start:]


def test_the_page_has_every_case_with_its_source_and_gates() -> None:
    assert split()[1] == tables(), "write it again: python tests/test_validation_page.py"


def test_the_page_counts_them() -> None:
    counted = re.search(r"(\d+) cases, (\d+) numbers", split()[0])
    assert counted is not None
    assert [int(number) for number in counted.groups()] == [
        len(CASES),
        sum(len(case.gates) for case in CASES),
    ]


if __name__ == "__main__":
    PAGE.write_text(split()[0] + tables(), encoding="utf-8")
