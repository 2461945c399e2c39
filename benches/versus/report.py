"""Table of results as text, and the history of results in ``benches/results.json``."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

RESULTS = Path(__file__).parents[1] / "results.json"
SLOWER = 0.9  # a ratio below this fraction of the previous ratio is a regression

Run = dict[str, Any]


def history() -> list[Run]:
    return list(json.loads(RESULTS.read_text())["runs"]) if RESULTS.exists() else []


def append(run: Run) -> None:
    """Appends a run to the history, with one line per row, so that changes are readable in a diff."""
    texts = []
    for one in [*history(), run]:
        head = [f"   {json.dumps(key)}: {json.dumps(value)}" for key, value in one.items() if key != "rows"]
        rows = ",\n".join(f"    {json.dumps(row)}" for row in one["rows"])
        texts.append("  {\n" + ",\n".join(head) + ',\n   "rows": [\n' + rows + "\n   ]\n  }")
    RESULTS.write_text('{\n "runs": [\n' + ",\n".join(texts) + "\n ]\n}\n")


def last_like(run: Run) -> Run | None:
    """Returns the most recent run of the history on the same kind of machine, or None."""
    like = [one for one in history() if one["machine"] == run["machine"]]
    return like[-1] if like else None


def before_of(row: Run, before: Run | None) -> float | None:
    """Returns the median ratio of this row in the earlier run `before`, or None if it has no such row."""
    rows = before["rows"] if before else []
    same = (one for one in rows if (one["what"], one["nv"]) == (row["what"], row["nv"]))
    return next((float(one["ratio"]["median"]) for one in same), None)


def head() -> str:
    return columns("what", "nv", "ours", "ratio", "(min to max)", "goal", "", "differ by", "last", "against")


def columns(*texts: str) -> str:
    widths = (-39, 3, 9, 6, 14, 6, -4, 9, 5, -1)
    return " ".join(
        f"{text:<{-w}}" if w < 0 else f"{text:>{w}}" for text, w in zip(texts, widths, strict=True)
    )


def line(row: Run, before: Run | None) -> str:
    ratio, goal, last = row["ratio"], row["asked"], before_of(row, before)
    return columns(
        row["what"],
        str(row["nv"]),
        f"{row['ours_ns'] / 1e3:.2f} µs",
        f"{ratio['median']:.2f}",
        f"({ratio['min']:.1f} to {ratio['max']:.1f})",
        "" if goal is None else f"{goal:.1f}",
        "" if goal is None else "yes" if ratio["median"] >= goal else "no",
        f"{row['difference']:.0e}",
        "" if last is None else f"{ratio['median'] / last - 1:+.0%}",
        row["against"],
    )


def captures(entries: list[Run]) -> list[str]:
    """Returns a line with time and accuracy for each engine of the capture."""
    return [
        f"{entry['engine']:<48} {entry['us_per_simulated_second'] / 1e3:.2f} ms per simulated second "
        f"({entry['ratio']['median']:.2f} times), angular momentum lost {entry['momentum_lost']:.0e}, "
        f"gap {entry['gap_m']:.0e} m"
        for entry in entries
    ]


def contacts(entries: list[Run]) -> list[str]:
    """Returns a line with time and accuracy for each engine and stiffness of two craft in contact."""
    return [
        f"{entry['engine']:<38} {entry['pads']}: {entry['us_per_step']:6.2f} µs per step "
        f"({entry['ratio']['median']:.2f} times), {entry['steps']} steps, "
        f"{entry['ms_per_simulated_second']:.1f} ms per simulated s; errors: {entry['position_m']:.0e} m, "
        f"energy {entry['energy']:.0e}, momentum lost {entry['momentum_lost']:.0e}"
        for entry in entries
    ]


def regressions(run: Run, before: Run | None) -> list[str]:
    """Returns a line for each row whose median ratio fell by more than 10 % since the run `before`.

    The ratio must also be below the previous median in every round.
    """
    lost = []
    for row in run["rows"]:
        last, ratio = before_of(row, before), row["ratio"]
        if last is not None and ratio["median"] < SLOWER * last and ratio["max"] < last:
            fraction = ratio["median"] / last
            lost.append(
                f"SLOWER: {row['what']}, nv = {row['nv']}: {fraction:.0%} of the ratio of the last run"
            )
    return lost
