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


def change(row: Run, before: Run | None) -> float | None:
    """This ratio as a share of that before."""
    same = (
        one
        for one in (before or {"rows": []})["rows"]
        if (one["what"], one["nv"]) == (row["what"], row["nv"])
    )
    found = next(same, None)
    return row["ratio"]["median"] / found["ratio"]["median"] if found else None


def head() -> str:
    return (
        f"{'what':39} {'nv':>3} {'ours':>9} {'ratio':>6} {'(min to max)':>14} {'asked':>6} {'':4} {'differ by':>9}  "
        f"{'last':>5}  against"
    )


def line(row: Run, before: Run | None) -> str:
    ratio, asked = row["ratio"], row["asked"]
    spread = f"({ratio['min']:.1f} to {ratio['max']:.1f})"
    verdict = "" if asked is None else "yes" if ratio["median"] >= asked else "no"
    share = change(row, before)
    told = "" if share is None else f"{share - 1:+.0%}"
    return (
        f"{row['what']:39} {row['nv']:3d} {row['ours_ns'] / 1e3:6.2f} µs {ratio['median']:6.2f} {spread:>14} "
        f"{'' if asked is None else f'{asked:.1f}':>6} {verdict:4} {row['difference']:9.0e}  {told:>5}  {row['against']}"
    )


def regressions(run: Run, before: Run | None) -> list[str]:
    """Rows that lost more than 10 %."""
    lost = []
    for row in run["rows"]:
        share = change(row, before)
        if share is not None and share < SLOWER:
            lost.append(
                f"{row['what']}, nv = {row['nv']}: ratio down to {share:.0%} of that of {before['date']}"
            )  # type: ignore[index]
    return lost
