"""Alternate timing of two builds of this project, and comparison of their times and results."""

from __future__ import annotations

import math
import sys
from dataclasses import dataclass
from pathlib import Path

import rows
from contestants import CORE, HERE
from inputs import STATES
from revisions import Build
from timing import Contestant, difference

BLOCKS = 3  # per build and round; the fastest counts, as the least disturbed by other processes
RUST = {"rust": ("robot.urdf", "states.bin"), "rust_loops": ("held.urdf", "held.bin")}
SAME = (0.98, 1.02)  # range of ratios that count as equal speed


@dataclass(frozen=True, eq=False)
class Row:
    """Row of ``make bench`` for the robot with ``nv`` velocities."""

    row: rows.Row
    nv: int

    @property
    def what(self) -> str:
        return self.row.what


class BuildComparison:
    """Times of two builds in each round, and their ratios ``other/here``, for each row of one robot.

    ``ratios`` and ``times`` hold one number per round; the times are those of ``here``, ns. ``changes`` holds
    the relative difference of the results of both builds.
    """

    def __init__(self, other: Build, here: Build, folder: Path, selected: list[Row]) -> None:
        self.builds, self.folder = (other, here), folder
        self.ratios: dict[Row, list[float]] = {row: [] for row in selected}
        self.times: dict[Row, list[float]] = {row: [] for row in selected}
        self.changes: dict[Row, float] = {}
        self.count = 0

    def round(self, seconds: float) -> None:
        """Restarts both builds and times every row in blocks of at least ``seconds``, s.

        The build that is timed first alternates from round to round.
        """
        running: dict[tuple[Build, str], Contestant] = {}
        order = self.builds if self.count % 2 else self.builds[::-1]
        self.count += 1
        for row in self.ratios:
            who, job = row.row.ours
            sides = {build: self._contestant(running, build, who) for build in order}
            if not all(job in side.about.get("jobs", [job]) for side in sides.values()):
                continue
            if row not in self.changes:
                found = [sides[build].result(job, self.folder) for build in self.builds]
                self.changes[row] = difference(*found, row.row.widths(row.nv))
            least = dict.fromkeys(self.builds, math.inf)
            for _ in range(1 + BLOCKS):  # the first block warms up; its time is not shorter, so it may count
                for build in order:
                    least[build] = min(least[build], sides[build].time(job, seconds))
            other, here = (least[build] for build in self.builds)
            self.ratios[row].append(other / here)
            self.times[row].append(here)
        for contestant in running.values():
            contestant.close()

    def _contestant(self, running: dict[tuple[Build, str], Contestant], build: Build, who: str) -> Contestant:
        if (build, who) not in running:
            running[build, who] = start(build, who, self.folder)
        return running[build, who]

    def change(self, row: Row) -> str:
        """Returns the relative difference of the results of both builds, or ``same bits`` if it is 0."""
        change = self.changes[row]
        return f"{change:.0e}" if change else "same bits"


def start(build: Build, who: str, folder: Path) -> Contestant:
    """Starts the program ``who`` of a build, which is the Rust program or a Python worker."""
    if who in RUST:
        robot, states = RUST[who]
        command = [build.contestant, folder / robot, folder / states, STATES]
        return Contestant([*map(str, command)], core=CORE)
    environment = {"PYTHONPATH": str(build.python)}
    if who == "ours_avx2":
        environment["ONORBIT_INSTRUCTION_SET"] = "avx2+fma"
    return Contestant([sys.executable, str(HERE / "ours.py"), str(folder)], core=CORE, **environment)


def interval(ratios: list[float]) -> tuple[float, float]:
    """Returns the bounds of a confidence interval of the median, of at least 95 % for any distribution.

    The bounds are the k-th smallest and the k-th largest of the n ratios. The median lies outside with the
    probability `2 P(B(n, 1/2) < k)`, where `B` is binomially distributed. Fewer than six ratios give no
    bounds.
    """
    each, n = sorted(ratios), len(ratios)
    below, k = 1, 0  # number of the 2^n outcomes with at most k successes
    while 2 * below <= 0.05 * 2**n:
        k += 1
        below += math.comb(n, k)
    if k == 0:
        return -math.inf, math.inf  # fewer than six rounds give no bounds
    return each[k - 1], each[n - k]


def verdict(low: float, high: float) -> str:
    if high < SAME[0]:
        return "SLOWER"
    return "faster" if low > SAME[1] else "same"
