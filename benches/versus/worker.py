"""Worker process that times jobs on request, with the protocol of ``benches/peers/contestant.hpp``."""

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
    """Job of a worker: `run` does `units` of work, and `result` returns arrays with one row per state.

    With one thread, the processor time of the process is measured; with several threads, the wall-clock time.
    """

    units: int
    run: Callable[[], Any]
    result: Callable[[], Any]
    threads: int = 1


def timed(job: Job, seconds: float) -> float:
    """Returns the time of a unit of work, ns: the median over calls of `run` during `seconds` s."""
    clock = time.process_time_ns if job.threads == 1 else time.perf_counter_ns
    passes, end = [], time.perf_counter() + seconds
    while not passes or time.perf_counter() < end:
        started = clock()
        job.run()
        passes.append((clock() - started) / job.units)
    return statistics.median(passes)


def serve(ready: str, jobs: dict[str, Job], **about: Any) -> None:
    """Sends `ready`, `about` and the names of the jobs, then answers requests until standard input ends."""
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
