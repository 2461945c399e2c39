"""Measures a row of the table, and the peak throughput of the processor."""

from __future__ import annotations

import statistics
import sys
import tempfile
from pathlib import Path
from typing import Any

from contestants import CORE, HERE, Contestants
from rows import Row
from timing import Contestant, Entry, alternate, difference, ratios

KERNELS = ("aba", "crba", "rnea", "jacobian", "reduced")
LANES = {"avx512": ("avx2+fma", "avx512"), "avx2+fma": ("avx2+fma",), "fma": ("fma",)}


def measure(row: Row, nv: int, contestants: Contestants, rounds: int, seconds: float) -> dict[str, Any] | str:
    """Measures a row; returns its entry in the results, or the reason why it cannot be measured."""
    who, job = row.ours
    if row.peer in contestants.missing:
        return contestants.missing[row.peer]
    level = contestants["ours"].about["ready"]
    if who == "ours_avx2" and level != "avx512":
        return f"this processor's best instruction set is {level}: see the row above"
    if job not in contestants[who].about.get("jobs", [job]):
        return "this package does not have it"
    off = difference(contestants.result(who, job), contestants.result(row.peer, row.jobs[0]), row.widths(nv))
    entries = [Entry(contestants[who], job), *(Entry(contestants[row.peer], name) for name in row.jobs)]
    ours, *others = alternate(entries, rounds, seconds)
    fastest = min(others, key=statistics.median)
    return {
        "what": row.what,
        "nv": nv,
        "ratio": {name: round(x, 3) for name, x in ratios(fastest, ours).items()},
        "asked": row.minimum(nv, contestants[who].about["ready"]),
        "difference": float(f"{off:.2g}"),
        "ours_ns": round(statistics.median(ours), 1),
        "against": row.against,
        "variants": {
            name: round(ratios(other, ours)["median"], 3)
            for name, other in zip(row.jobs, others, strict=True)
        },
    }


CAPTURE = "capture of a rigid craft"
CAPTURES = {
    "ours": "onorbit_rs, RK4, every step recorded",
    "weld": "MuJoCo, default weld",
    "stiffer_weld": "MuJoCo, weld with a fifth of the time constant",
}


def captures(rounds: int, seconds: float) -> list[dict[str, Any]]:
    """Returns time and accuracy of a capture by this package and by welds of MuJoCo."""
    who = Contestant([sys.executable, str(HERE / "capture.py")], core=CORE)
    times = dict(
        zip(CAPTURES, alternate([Entry(who, job) for job in CAPTURES], rounds, seconds), strict=True)
    )
    with tempfile.TemporaryDirectory() as folder:
        errors = {job: who.result(job, Path(folder)) for job in CAPTURES}
    step = who.about["time_step"]
    who.close()
    return [
        {
            "engine": name,
            "us_per_simulated_second": round(statistics.median(times[job]) / step / 1e3, 1),
            "ratio": {key: round(x, 3) for key, x in ratios(times[job], times["ours"]).items()},
            "momentum_lost": float(f"{errors[job][0]:.2g}"),
            "gap_m": float(f"{errors[job][1]:.2g}"),
        }
        for job, name in CAPTURES.items()
    ]


def ceiling(nv: int, contestants: Contestants) -> dict[str, Any]:
    """Returns the operations per state of each kernel and the peak of a core in 1e9 operations per second."""
    rust, level = contestants["rust"], contestants["ours"].about["ready"]
    return {
        "nv": nv,
        "operations": {name: rust.ask("flops", name) for name in KERNELS},
        "peak_gflops": {
            name: round(rust.ask("peak", name, 0.3)["gflops"], 1) for name in LANES.get(level, ("baseline",))
        },
    }
