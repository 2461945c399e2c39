"""Checks that ``docs/validation.md`` lists the cases of ``onorbit validate``; as a script, writes it."""

from __future__ import annotations

import itertools
import re
from collections.abc import Sequence
from pathlib import Path

from onorbit_rs.tools.validation import CASES, Gate, Verdict, nasa, run

PAGE = Path(__file__).resolve().parents[1] / "docs" / "validation.md"
TITLES = {
    "kepler": "Two bodies",
    "sgp4": "SGP4",
    "nasa": "NASA's orbital check-cases, 8 h at 1 s",
    "rotation": "Rotation of one body",
    "earth": "Orientation of the Earth",
    "gravity": "Gravity field, Sun and Moon",
    "light": "Radiation pressure",
    "air": "Drag",
    "relative": "Relative motion",
    "bodies": "Articulated bodies",
    "robots": "A controlled robot",
    "certificates": "Certificates of the bundled scenarios",
    "conservation": "Conservation",
    "capture": "Capture and release",
    "brakes": "Brakes",
    "joints": "Springs at joints",
    "loops": "Closed loops and mimic joints",
    "contact": "Contact",
    "grasp": "Grasps",
    "world": "Worlds of several craft",
    "order": "Orders of convergence",
    "engines": "Other engines, if installed",
}


def tables(verdicts: Sequence[Verdict]) -> str:
    """Returns a table for each family with a row for each gate; the last column holds the measured errors."""
    parts = []
    for family, members in itertools.groupby(verdicts, lambda verdict: verdict.family):
        rows = [f"## {TITLES[family]}", "", "| case | source | quantity | gate | measured |", "|-|-|-|-|-|"]
        for verdict in members:
            heads = itertools.chain([f"{verdict.case} | {verdict.source}"], itertools.repeat("| "))
            for head, check in zip(heads, verdict.checks, strict=False):
                gate = Gate(check.quantity, check.gate, check.unit)
                measured = "" if check.error is None else f"{check.error:.1e}"
                rows.append(f"| {head} | {check.quantity} | {gate} | {measured} |")
        parts.append("\n".join(rows))
    return "\n\n".join(parts) + "\n"


def split() -> tuple[str, str]:
    """Returns the text before the tables, and the tables."""
    text = PAGE.read_text(encoding="utf-8")
    start = text.index("## ")
    return text[:start], text[start:]


def without_measured(text: str) -> str:
    return re.sub(r"\| [^|]*\|$", "|", text, flags=re.MULTILINE)


def test_the_page_has_every_case_with_its_source_and_gates() -> None:
    listed = tables([case.not_run() for case in CASES])
    assert without_measured(split()[1]) == without_measured(listed), (
        "update the page: python tests/test_validation_page.py"
    )


def test_the_errors_on_the_page_are_within_their_gates() -> None:
    rows = re.findall(r"\| ≤ (\S+)[^|]*\| ([^|]*) \|$", split()[1], re.MULTILINE)
    assert len(rows) == sum(len(case.gates) for case in CASES)
    assert all(float(measured) <= float(gate) for gate, measured in rows)


def test_the_page_states_the_number_of_cases() -> None:
    counted = re.search(r"(\d+)\s+cases,\s+(\d+)\s+numbers", split()[0])
    assert counted is not None
    assert [int(number) for number in counted.groups()] == [
        len(CASES),
        sum(len(case.gates) for case in CASES),
    ]


def test_the_page_states_which_runs_are_compared_at_their_end_only() -> None:
    counted = re.search(r"(\d+)\s+runs,\s+(\d+)\s+are\s+compared\s+at\s+their\s+end\s+only", split()[0])
    assert counted is not None
    rows = [len(nasa.rows(run)) for run in nasa.RUNS]
    assert [int(number) for number in counted.groups()] == [len(rows), rows.count(1)]


if __name__ == "__main__":
    PAGE.write_text(split()[0] + tables(run()), encoding="utf-8")
