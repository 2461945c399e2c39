"""Alternate timing, in short rounds, of processes that answer requests line by line."""

from __future__ import annotations

import json
import os
import statistics
import subprocess
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]


class Contestant:
    """Process that answers requests on its standard input, optionally bound to one core.

    ``about`` is the first line of its output, which describes the process.
    """

    def __init__(self, command: list[str], *, core: int | None = None, **environment: str) -> None:
        if core is not None and hasattr(os, "sched_setaffinity"):
            command = ["taskset", "-c", str(core), *command]
        pipes = {"stdin": subprocess.PIPE, "stdout": subprocess.PIPE, "text": True}
        self.process: Any = subprocess.Popen(command, env=os.environ | environment, **pipes)
        self.about = self._answer()

    def ask(self, *words: object) -> dict[str, Any]:
        self.process.stdin.write(" ".join(map(str, words)) + "\n")
        self.process.stdin.flush()
        return self._answer()

    def time(self, job: str, seconds: float) -> float:
        """Returns the time of a unit of work of `job`, ns, measured for at least `seconds` s."""
        return float(self.ask("time", job, seconds)["ns"])

    def result(self, job: str, folder: Path) -> Array:
        file = folder / f"{job}.result"
        self.ask("result", job, file)
        return np.fromfile(file)

    def _answer(self) -> dict[str, Any]:
        line = self.process.stdout.readline()
        if not line:
            raise RuntimeError(
                f"{' '.join(self.process.args)} ended with exit code {self.process.wait()}; see its output"
            )
        answer: dict[str, Any] = json.loads(line)
        return answer

    def close(self) -> None:
        self.process.communicate()  # closes its standard input, which ends the process


@dataclass(frozen=True)
class Entry:
    """Job of a process, to be timed."""

    who: Contestant
    job: str


def alternate(entries: list[Entry], rounds: int, seconds: float) -> list[list[float]]:
    """Returns the times per unit of work, ns, of every entry in every round.

    In each round, every entry is timed for `seconds` s. The entry that is timed first changes from round to
    round.
    """
    times: list[list[float]] = [[] for _ in entries]
    for entry in entries:
        entry.who.time(entry.job, 0.0)  # one pass to warm up
    for first in range(rounds):
        for turn in range(len(entries)):
            index = (first + turn) % len(entries)
            times[index].append(entries[index].who.time(entries[index].job, seconds))
    return times


def ratios(theirs: list[float], ours: list[float]) -> dict[str, float]:
    """Returns the minimum, median and maximum of `theirs / ours` over the rounds."""
    each = sorted(a / b for a, b in zip(theirs, ours, strict=True))
    return {"min": each[0], "median": statistics.median(each), "max": each[-1]}


def difference(ours: Array, theirs: Array, widths: list[int]) -> float:
    """Returns the largest difference of the results, relative to the largest number of a part of the results.

    The results of a state consist of parts with the given widths. Only states that both arrays contain are
    compared.
    """
    ours, theirs = (x.reshape(-1, sum(widths)) for x in (ours, theirs))
    count = min(len(ours), len(theirs))
    worst, at = 0.0, 0
    for width in widths:
        a, b = ours[:count, at : at + width], theirs[:count, at : at + width]
        relative = np.abs(a - b).max(axis=1) / np.abs(b).max(axis=1)
        worst, at = max(worst, float(relative.max())), at + width
    return worst
