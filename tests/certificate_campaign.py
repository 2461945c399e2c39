"""Random runs that are exact, which the certificate must pass, and runs made wrong, which it must fail.

``python tests/certificate_campaign.py --exact 10000 --wrong 1000`` (``make certificate-campaign``). A run
that is made wrong counts where it differs from the same run at an eighth of its step by more than ``OFF``,
and where a start that differs by 1e-9 does not end a thousand times further away: no check of one run can
see chaos.
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
from certificate_cases import EXACT, OFF, SHARE, WRONG, Run

import onorbit_rs as oo
from onorbit_rs.exceptions import SimulationError


@dataclass
class Tally:
    """What came of a campaign."""

    runs: Counter[str] = field(default_factory=Counter)
    mistaken: list[str] = field(default_factory=list)
    nearest: float = 0.0

    def __str__(self) -> str:
        kinds = ", ".join(f"{count} {kind}" for kind, count in sorted(self.runs.items()))
        return (
            f"{self.runs.total()} runs ({kinds}): {len(self.mistaken)} mistaken; nearest {self.nearest:.2g}"
        )


def failures(trace: oo.Trace) -> list[str]:
    """Names of the checks that a run fails."""
    return [name for name, _, _, passed in trace.certificate() if not passed]


def nearest(trace: oo.Trace) -> float:
    """The largest value of the certificate, as a share of its gate."""
    return max(value / gate for _, value, gate, _ in trace.certificate() if value is not None)


def exact(count: int, seed: int, most_rows: int, until: float = np.inf) -> Tally:
    """Run exact motions; those that fail are mistaken."""
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
    """Run ``count`` motions that came out wrong; those that the certificate passes are mistaken."""
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
            continue  # a run that diverges is refused by the engine: nothing is left to certify
        else:
            tally.runs[kind] += 1
            tally.nearest = min(tally.nearest, nearest(trace))
            if not failures(trace):
                tally.mistaken.append(f"{kind}: {run} passes")
    return tally


def _cases(
    kinds: dict[str, Callable[..., Run]], count: int, seed: int, until: float
) -> Iterator[tuple[str, Callable[..., Run], np.random.Generator]]:
    """Kinds in turn, each case with a generator of its own, so that any can be repeated alone."""
    for i in range(count):
        if time.monotonic() > until:
            return
        kind = list(kinds)[i % len(kinds)]
        yield kind, kinds[kind], np.random.default_rng([seed, i])


def main(arguments: list[str] | None = None) -> int:
    """Run the campaign; the exit code is 1 where the certificate was mistaken."""
    parser = argparse.ArgumentParser(
        description="random exact runs and runs made wrong against their certificates"
    )
    parser.add_argument("--exact", type=int, default=10_000, help="exact runs (default: %(default)s)")
    parser.add_argument("--wrong", type=int, default=1000, help="runs made wrong (default: %(default)s)")
    parser.add_argument(
        "--rows", type=int, default=20_000, help="most steps of an exact run (default: %(default)s)"
    )
    parser.add_argument("--seed", type=int, default=0)
    parser.add_argument(
        "--minutes", type=float, default=np.inf, help="longest time of each half (default: no limit)"
    )
    given: Any = parser.parse_args(arguments)
    print(f"seed {given.seed}; made wrong: off by more than {OFF:g} rad and {SHARE:g} of the travel")
    mistaken = 0
    for name, job in (
        ("exact", lambda until: exact(given.exact, given.seed, given.rows, until)),
        ("made wrong", lambda until: wrong(given.wrong, given.seed, until)),
    ):
        started = time.monotonic()
        tally = job(started + 60.0 * given.minutes)
        print(f"{name}: {tally} gates; {time.monotonic() - started:.0f} s", flush=True)
        print("\n".join(tally.mistaken))
        mistaken += len(tally.mistaken)
    return int(mistaken > 0)


if __name__ == "__main__":
    sys.exit(main())
