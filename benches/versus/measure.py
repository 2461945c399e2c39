"""Measurement of the rows of the table, of captures and contacts, and of the processor's peak throughput."""

from __future__ import annotations

import statistics
import sys
import tempfile
from pathlib import Path
from typing import Any

import contact
from contestants import CORE, HERE, Contestants
from rows import Row
from timing import Contestant, Entry, alternate, difference, ratios

import onorbit_rs as oo

KERNELS = ("aba", "crba", "rnea", "jacobian", "reduced")
LANES = {"avx512": ("avx2+fma", "avx512"), "avx2+fma": ("avx2+fma",), "fma": ("fma",)}


def measure(row: Row, nv: int, contestants: Contestants, rounds: int, seconds: float) -> dict[str, Any] | str:
    """Measures a row for the robot with `nv` velocities, in `rounds` rounds of `seconds` s for each program.

    Returns the entry of the results, or the reason why the row cannot be measured.
    """
    who, job = row.ours
    if row.peer in contestants.missing:
        return contestants.missing[row.peer]
    level = contestants["ours"].about["ready"]
    if who == "ours_avx2" and level != "avx512":
        return f"the best instruction set of this processor is {level}, which the row above measures"
    if job not in contestants[who].about.get("jobs", [job]):
        return f"this package has no job {job}"
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
    """Returns the time and accuracy of a capture by this package and by two welds of MuJoCo."""
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


CONTACT = "two craft in contact, accuracy"
CONTACTS = {
    "ours": "onorbit_rs, RK4, every step recorded",
    "rk4": "MuJoCo, RK4",
    "implicitfast": "MuJoCo, implicitfast",
}


def contacts(contestants: Contestants, rounds: int, seconds: float) -> list[dict[str, Any]]:
    """Returns the time and accuracy of two craft in contact, with soft and with hard pads.

    The solution of each engine is compared with a solution of the same engine whose steps are shorter by the
    factor `contact.FINER`, because the contact forces of MuJoCo differ from those of this package by 1e-4.
    """
    model, found = oo.Model.from_urdf(contestants.folder / "pads.urdf"), []
    for pads, peer in ((contact.SOFT, "contact"), (contact.HARD, "hard_contact")):
        sides = {"ours": ("ours", peer), "rk4": (peer, "rk4"), "implicitfast": (peer, "implicitfast")}
        entries = [Entry(contestants[who], job) for who, job in sides.values()]
        times = dict(zip(sides, alternate(entries, rounds, seconds), strict=True))
        exact = {
            who: contestants.result(who, job)
            for who, job in (("ours", f"converged_{peer}"), (peer, "converged"))
        }
        for engine, (who, job) in sides.items():
            steps = contestants["ours"].about["steps"][peer] if engine == "ours" else pads.steps
            ns = statistics.median(times[engine])
            off = contact.errors(model, pads, contestants.result(who, job), exact[who])
            found.append(
                {
                    "engine": CONTACTS[engine],
                    "pads": f"{pads.stiffness:.0e} N/m",
                    "us_per_step": round(ns / 1e3, 2),
                    "steps": steps,
                    "ms_per_simulated_second": round(ns * steps / pads.duration / 1e6, 2),
                    "ratio": {key: round(x, 3) for key, x in ratios(times[engine], times["ours"]).items()},
                    **{key: float(f"{x:.2g}") for key, x in off.items()},
                }
            )
    return found


def ceiling(nv: int, contestants: Contestants) -> dict[str, Any]:
    """Returns the operations per state of each kernel, and the peak of a core in 1e9 operations per second.

    The kernels run on the robot with `nv` velocities. The peak is given for each instruction set.
    """
    rust, level = contestants["rust"], contestants["ours"].about["ready"]
    return {
        "nv": nv,
        "operations": {name: rust.ask("flops", name) for name in KERNELS},
        "peak_gflops": {
            name: round(rust.ask("peak", name, 0.3)["gflops"], 1) for name in LANES.get(level, ("baseline",))
        },
    }
