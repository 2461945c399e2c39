"""Runs random exact cases, which must pass their certificates, and faulty cases, which must fail them.

``python tests/certificate_campaign.py --exact 10000 --wrong 1000`` (``make certificate-campaign``). A faulty
run counts if it differs by more than ``OFF`` from the same run with an eighth of the step, unless the motion
is chaotic (an initial difference of 1e-9 grows a thousandfold), which no check of a single run can detect.
"""

from __future__ import annotations

import argparse
import sys
import time
from collections import Counter
from collections.abc import Callable, Iterator
from dataclasses import dataclass, field
from typing import Any

import numpy as np
from certificate_cases import EXACT, FRACTION, OFF, WRONG, Run

import onorbit_rs as oo
from onorbit_rs.exceptions import SimulationError


@dataclass
class Tally:
    """Results of a campaign: runs by kind, cases judged wrongly, and the value nearest to its gate."""

    runs: Counter[str] = field(default_factory=Counter)
    mistaken: list[str] = field(default_factory=list)
    nearest: float = 0.0

    def __str__(self) -> str:
        kinds = ", ".join(f"{count} {kind}" for kind, count in sorted(self.runs.items()))
        return (
            f"{self.runs.total()} runs ({kinds}): {len(self.mistaken)} judged wrongly; "
            f"the value nearest to its gate is {self.nearest:.2g} times the gate"
        )


def failures(trace: oo.Trace) -> list[str]:
    """Returns the names of the checks that a run fails."""
    return [name for name, _, _, passed in trace.certificate() if not passed]


def nearest(trace: oo.Trace) -> float:
    """Returns the largest ratio of a certificate's value to its gate."""
    return max(value / gate for _, value, gate, _ in trace.certificate() if value is not None)


def exact(count: int, seed: int, most_rows: int, until: float = np.inf) -> Tally:
    """Runs up to ``count`` exact motions and collects those whose certificates fail by mistake."""
    tally = Tally()
    for kind, case, rng in _cases(EXACT, count, seed, until):
        run: Run = case(rng, most_rows)
        trace = run.start().run(run.duration)
        tally.runs[kind] += 1
        tally.nearest = max(tally.nearest, nearest(trace))
        if red := failures(trace):
            tally.mistaken.append(f"{kind}: {run} fails {', '.join(red)}")
    return tally


def wrong(count: int, seed: int, until: float = np.inf) -> Tally:
    """Runs up to ``count`` faulty motions and collects those whose certificates pass by mistake."""
    tally = Tally(nearest=np.inf)
    for kind, case, rng in _cases(WRONG, 1000 * count, seed, until):
        if tally.runs.total() >= count:
            break
        if tally.runs[kind] * len(WRONG) >= count:
            continue
        run: Run = case(rng)
        try:
            if run.is_wrong is not None and not run.is_wrong():
                continue
            trace = run.start().run(run.duration)
        except SimulationError:
            continue  # a diverged run raises an error and has no certificate
        else:
            tally.runs[kind] += 1
            tally.nearest = min(tally.nearest, nearest(trace))
            if not failures(trace):
                tally.mistaken.append(f"{kind}: {run} passes")
    return tally


def _cases(
    kinds: dict[str, Callable[..., Run]], count: int, seed: int, until: float
) -> Iterator[tuple[str, Callable[..., Run], np.random.Generator]]:
    """Yields cases of each kind in turn, each with a separate generator so that it can be repeated alone."""
    for i in range(count):
        if time.monotonic() > until:
            return
        kind = list(kinds)[i % len(kinds)]
        yield kind, kinds[kind], np.random.default_rng([seed, i])


def main(arguments: list[str] | None = None) -> int:
    """Runs the campaign; the exit code is 1 if a certificate was wrong."""
    parser = argparse.ArgumentParser(
        description="checks the certificates of random exact runs and of faulty runs"
    )
    parser.add_argument(
        "--exact", type=int, default=10_000, help="number of exact runs (default: %(default)s)"
    )
    parser.add_argument(
        "--wrong", type=int, default=1000, help="number of faulty runs (default: %(default)s)"
    )
    parser.add_argument(
        "--rows",
        type=int,
        default=20_000,
        help="largest number of steps of an exact run (default: %(default)s)",
    )
    parser.add_argument("--seed", type=int, default=0)
    parser.add_argument(
        "--minutes", type=float, default=np.inf, help="time limit of each half, min (default: no limit)"
    )
    given: Any = parser.parse_args(arguments)
    print(f"seed {given.seed}; faulty: error above {OFF:g} rad and {FRACTION:g} of the travel")
    mistaken = 0
    for name, job in (
        ("exact", lambda until: exact(given.exact, given.seed, given.rows, until)),
        ("faulty", lambda until: wrong(given.wrong, given.seed, until)),
    ):
        started = time.monotonic()
        tally = job(started + 60.0 * given.minutes)
        print(f"{name}: {tally}; {time.monotonic() - started:.0f} s", flush=True)
        print("\n".join(tally.mistaken))
        mistaken += len(tally.mistaken)
    return int(mistaken > 0)


if __name__ == "__main__":
    sys.exit(main())
