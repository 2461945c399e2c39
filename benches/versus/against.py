"""Compares the speed of this tree with that of another revision, row by row: ``make bench-against REV=…``.

Both revisions are built at the same path with the same flags, so that equal sources give equal machine code.
In every round, both are restarted and timed alternately in short blocks on one core. A ratio above 1 means
that this tree is faster.
"""

from __future__ import annotations

import argparse
import itertools
import statistics
import sys
from pathlib import Path

import inputs
import programs
import revisions
from build_comparison import BuildComparison, Row, interval, verdict
from report import columns
from rows import ROWS

HEAD = columns("what", "nv", "here", "ratio", "95 % interval", "", "", "differ by", "", "")


def arguments() -> argparse.Namespace:
    parser = argparse.ArgumentParser(prog="python benches/versus/against.py", description=__doc__)
    parser.add_argument(
        "revision", nargs="?", help="commit, branch or tag of this repository to compare with"
    )
    parser.add_argument(
        "--built",
        nargs=2,
        type=Path,
        metavar=("OTHER", "HERE"),
        help="compare two trees that are already built, each with target/release/examples/contestant",
    )
    parser.add_argument("--rounds", type=int, default=41)
    parser.add_argument("--seconds", type=float, default=0.01, help="shortest duration of a block, s")
    parser.add_argument("--rows", default="", help="measure only rows whose name contains this")
    parser.add_argument(
        "--nv", type=int, choices=(13, 20), help="measure only the robot with one arm (13) or with two (20)"
    )
    given = parser.parse_args()
    if (given.revision is None) == (given.built is None):
        parser.error("give either a revision, or --built with two trees")
    return given


def selected_rows(given: argparse.Namespace) -> list[Row]:
    """Returns the selected rows of ``make bench`` that run on one thread, for each robot that has them."""
    robots = (13, 20) if given.nv is None else (given.nv,)
    rows = [row for row in ROWS if given.rows in row.what and row.ours[0] != "ours_all"]
    rows = list({row.ours: row for row in reversed(rows)}.values())[::-1]  # each job once
    if not rows:
        sys.exit(f"no row contains {given.rows!r}; the rows are: {', '.join(row.what for row in ROWS)}")
    pairs = itertools.product(robots, rows)
    return [Row(row, nv) for nv, row in pairs if nv == 20 or row.ours[0] != "rust_loops"]


def has_row(build: revisions.Build, row: Row) -> bool:
    """Returns False if the row needs contacts or loops, but the build is older than this feature."""
    package = (build.python / "onorbit_rs" / "__init__.py").read_text()
    needed = {"contact": "Contact", "constrained": "Loop"}.get(row.row.ours[1])
    return needed is None or f'"{needed}"' in package


def main() -> int:
    given = arguments()
    other, here = revisions.built(*given.built) if given.built else revisions.compared(given.revision)
    same = other.machine_code() == here.machine_code()
    print(f"{here.name} against {other.name} on {programs.processor()}, {given.rounds} rounds")
    print(f"the machine code of both is {'identical' if same else 'different'}\n{HEAD}", flush=True)
    rows, slower = [row for row in selected_rows(given) if has_row(other, row) and has_row(here, row)], 0
    for nv in dict.fromkeys(row.nv for row in rows):
        folder = programs.BUILD / f"against{nv}"
        inputs.write(folder, 1 if nv == 13 else 2)
        comparison = BuildComparison(other, here, folder, [row for row in rows if row.nv == nv])
        for _ in range(given.rounds):
            comparison.round(given.seconds)
        for row, ratios in comparison.ratios.items():
            low, high = interval(ratios)
            result = verdict(low, high)
            slower += result == "SLOWER"
            middle, bounds = statistics.median(ratios), f"{low:.3f} to {high:.3f}"
            time = f"{statistics.median(comparison.times[row]) / 1e3:.2f} µs"
            print(
                columns(
                    row.what,
                    str(nv),
                    time,
                    f"{middle:.3f}",
                    bounds,
                    "",
                    "",
                    comparison.change(row),
                    "",
                    result,
                ),
                flush=True,
            )
    print(f"{slower} row(s) slower, with the whole interval below 0.98" if slower else "no row is slower")
    return 1 if slower else 0


if __name__ == "__main__":
    sys.exit(main())
