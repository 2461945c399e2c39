"""``docs/validation.md`` says what ``onorbit validate`` runs; run as a script this file writes it."""

from __future__ import annotations

import itertools
import re
from collections.abc import Sequence
from pathlib import Path

from onorbit_rs.validation import CASES, Gate, Verdict, nasa, run

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


def tables(verdicts: Sequence[Verdict]) -> str:
    """A table for each family, a row for each gate; the last column is what was seen."""
    parts = []
    for family, members in itertools.groupby(verdicts, lambda verdict: verdict.family):
        rows = [f"## {TITLES[family]}", "", "| case | source | quantity | gate | seen |", "|-|-|-|-|-|"]
        for verdict in members:
            heads = itertools.chain([f"{verdict.case} | {verdict.source}"], itertools.repeat("| "))
            for head, check in zip(heads, verdict.checks, strict=False):
                gate = Gate(check.quantity, check.gate, check.unit)
                seen = "" if check.error is None else f"{check.error:.1e}"
                rows.append(f"| {head} | {check.quantity} | {gate} | {seen} |")
        parts.append("\n".join(rows))
    return "\n\n".join(parts) + "\n"


def split() -> tuple[str, str]:
    """What is written by hand, and the tables."""
    text = PAGE.read_text(encoding="utf-8")
    start = text.index("## ")
    return text[:start], text[start:]


def without_seen(text: str) -> str:
    return re.sub(r"\| [^|]*\|$", "|", text, flags=re.MULTILINE)


def test_the_page_has_every_case_with_its_source_and_gates() -> None:
    listed = tables([case.not_run() for case in CASES])
    assert without_seen(split()[1]) == without_seen(listed), (
        "write it again: python tests/test_validation_page.py"
    )


def test_what_the_page_has_seen_is_within_the_gates() -> None:
    rows = re.findall(r"\| ≤ (\S+)[^|]*\| ([^|]*) \|$", split()[1], re.MULTILINE)
    assert len(rows) == sum(len(case.gates) for case in CASES)
    assert all(float(seen) <= float(gate) for gate, seen in rows)


def test_the_page_counts_them() -> None:
    counted = re.search(r"(\d+) cases, (\d+) numbers", split()[0])
    assert counted is not None
    assert [int(number) for number in counted.groups()] == [
        len(CASES),
        sum(len(case.gates) for case in CASES),
    ]


def test_the_page_says_what_is_compared_at_its_end_alone() -> None:
    counted = re.search(r"(\d+) runs (\d+) are compared at their end alone", split()[0])
    assert counted is not None
    rows = [len(nasa.rows(run)) for run in nasa.RUNS]
    assert [int(number) for number in counted.groups()] == [len(rows), rows.count(1)]


if __name__ == "__main__":
    PAGE.write_text(split()[0] + tables(run()), encoding="utf-8")
