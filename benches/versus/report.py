"""The table on the screen, and the history in ``benches/results.json``."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

RESULTS = Path(__file__).parents[1] / "results.json"
SLOWER = 0.9  # a ratio below this share of the last one is a regression

Run = dict[str, Any]


def history() -> list[Run]:
    return list(json.loads(RESULTS.read_text())["runs"]) if RESULTS.exists() else []


def append(run: Run) -> None:
    """One line per measured row, so that a change reads well in a diff."""
    texts = []
    for one in [*history(), run]:
        head = [f"   {json.dumps(key)}: {json.dumps(value)}" for key, value in one.items() if key != "rows"]
        rows = ",\n".join(f"    {json.dumps(row)}" for row in one["rows"])
        texts.append("  {\n" + ",\n".join(head) + ',\n   "rows": [\n' + rows + "\n   ]\n  }")
    RESULTS.write_text('{\n "runs": [\n' + ",\n".join(texts) + "\n ]\n}\n")


def last_like(run: Run) -> Run | None:
    """The newest run before on a machine of the same kind."""
    like = [one for one in history() if one["machine"] == run["machine"]]
    return like[-1] if like else None


def before_of(row: Run, before: Run | None) -> float | None:
    """What the ratio of this row was before."""
    rows = before["rows"] if before else []
    same = (one for one in rows if (one["what"], one["nv"]) == (row["what"], row["nv"]))
    return next((float(one["ratio"]["median"]) for one in same), None)


def head() -> str:
    return columns("what", "nv", "ours", "ratio", "(min to max)", "asked", "", "differ by", "last", "against")


def columns(*texts: str) -> str:
    widths = (-39, 3, 9, 6, 14, 6, -4, 9, 5, -1)
    return " ".join(
        f"{text:<{-w}}" if w < 0 else f"{text:>{w}}" for text, w in zip(texts, widths, strict=True)
    )


def line(row: Run, before: Run | None) -> str:
    ratio, asked, last = row["ratio"], row["asked"], before_of(row, before)
    return columns(
        row["what"],
        str(row["nv"]),
        f"{row['ours_ns'] / 1e3:.2f} µs",
        f"{ratio['median']:.2f}",
        f"({ratio['min']:.1f} to {ratio['max']:.1f})",
        "" if asked is None else f"{asked:.1f}",
        "" if asked is None else "yes" if ratio["median"] >= asked else "no",
        f"{row['difference']:.0e}",
        "" if last is None else f"{ratio['median'] / last - 1:+.0%}",
        row["against"],
    )


def regressions(run: Run, before: Run | None) -> list[str]:
    """Rows that lost more than 10 %, and not by the chance of some rounds: in every one of them."""
    lost = []
    for row in run["rows"]:
        last, ratio = before_of(row, before), row["ratio"]
        if last is not None and ratio["median"] < SLOWER * last and ratio["max"] < last:
            share = ratio["median"] / last
            lost.append(f"SLOWER: {row['what']}, nv = {row['nv']}: {share:.0%} of the last ratio")
    return lost
