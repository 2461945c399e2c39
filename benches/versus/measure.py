"""One row measured; and the ceiling above all of them."""

from __future__ import annotations

import statistics
from typing import Any

from field import Field
from race import Entry, alternate, difference, ratios
from rows import Row

KERNELS = ("aba", "crba", "rnea", "jacobian", "reduced")
LANES = {"avx512": ("avx2+fma", "avx512"), "avx2+fma": ("avx2+fma",), "fma": ("fma",)}


def measure(row: Row, nv: int, field: Field, rounds: int, seconds: float) -> dict[str, Any] | str:
    """What a row says; or why it says nothing."""
    who, job = row.ours
    if row.peer in field.missing:
        return field.missing[row.peer]
    level = field["ours"].about["ready"]
    if who == "ours_avx2" and level != "avx512":
        return f"this processor's best is {level}: the row above"
    if job not in field[who].about.get("jobs", [job]):
        return "ours does not have it"
    off = difference(field.result(who, job), field.result(row.peer, row.jobs[0]), row.widths(nv))
    entries = [Entry(field[who], job), *(Entry(field[row.peer], name) for name in row.jobs)]
    mine, *others = alternate(entries, rounds, seconds)
    fastest = min(others, key=statistics.median)
    return {
        "what": row.what,
        "nv": nv,
        "ratio": {name: round(x, 3) for name, x in ratios(fastest, mine).items()},
        "asked": row.minimum(nv, field[who].about["ready"]),
        "difference": float(f"{off:.2g}"),
        "ours_ns": round(statistics.median(mine), 1),
        "against": row.against,
        "variants": {
            name: round(ratios(other, mine)["median"], 3)
            for name, other in zip(row.jobs, others, strict=True)
        },
    }


def ceiling(nv: int, field: Field) -> dict[str, Any]:
    """Operations per state of each kernel; and the most that a core does, in 1e9 of them per second."""
    rust, level = field["rust"], field["ours"].about["ready"]
    return {
        "nv": nv,
        "operations": {name: rust.ask("flops", name) for name in KERNELS},
        "peak_gflops": {
            name: round(rust.ask("peak", name, 0.3)["gflops"], 1) for name in LANES.get(level, ("baseline",))
        },
    }
