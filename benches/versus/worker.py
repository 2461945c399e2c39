"""A Python process that times jobs on request, with the protocol of ``benches/peers/contestant.hpp``."""

from __future__ import annotations

import json
import statistics
import sys
import time
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import numpy as np


@dataclass
class Job:
    """`run` does `units` of work; `result` returns the results (arrays with one row per state).

    Processor time is measured, which excludes other processes; with several threads, wall-clock time.
    """

    units: int
    run: Callable[[], Any]
    result: Callable[[], Any]
    threads: int = 1


def timed(job: Job, seconds: float) -> float:
    """Returns the nanoseconds per unit, the median over passes."""
    clock = time.process_time_ns if job.threads == 1 else time.perf_counter_ns
    passes, end = [], time.perf_counter() + seconds
    while not passes or time.perf_counter() < end:
        started = clock()
        job.run()
        passes.append((clock() - started) / job.units)
    return statistics.median(passes)


def serve(ready: str, jobs: dict[str, Job], **about: Any) -> None:
    """Sends `about` and the names of the jobs, then answers requests until standard input ends."""
    answer({"ready": ready, "jobs": list(jobs), **about})
    for line in sys.stdin:
        verb, name, last = line.split()
        if verb == "time":
            answer({"ns": timed(jobs[name], float(last))})
        else:
            arrays = [np.asarray(part, dtype=float) for part in jobs[name].result()]
            np.hstack([part.reshape(len(part), -1) for part in arrays]).tofile(last)
            answer({})


def answer(what: dict[str, Any]) -> None:
    sys.stdout.write(json.dumps(what) + "\n")
    sys.stdout.flush()
