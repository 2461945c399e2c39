"""``make soak``: kills, disk faults, leaks and long runs for an hour, or for ``--seconds``.

Prints a line of JSON for each part; the exit code is 1 if a part failed.
"""

from __future__ import annotations

import argparse
import json
import sys
import tempfile
import time
from collections.abc import Callable
from dataclasses import asdict
from pathlib import Path
from typing import Any

from exact_motions import earth_pointing, spins, station
from faults import fault_campaign
from leaks import leak_campaign
from long_runs import arm, grasp, spin

# fractions of the time; the long runs come first and are not limited
KILLS, FAULTS, LEAKS = 0.5, 0.2, 0.3
SPIN_STEPS, ARM_S, ORBITS_A_DAY, HELD_S = 10_000_000, 3600.0, 15.56, 60.0


def arguments() -> argparse.Namespace:
    parser = argparse.ArgumentParser(prog="python tests/soak", description=__doc__)
    parser.add_argument("--seconds", type=float, default=3600.0)
    parser.add_argument("--seed", type=int, default=int(time.time()))
    parser.add_argument("--only", default="", help="run only the parts whose name contains this text")
    return parser.parse_args()


def kills(folder: Path, seed: int, seconds: float) -> dict[str, Any]:
    from kills import kill_campaign

    return asdict(kill_campaign(folder, kills=10**9, seed=seed, most_seconds=seconds))


def main() -> int:
    given = arguments()
    began = time.monotonic()

    def left() -> float:
        return max(0.0, given.seconds - (time.monotonic() - began))

    parts: dict[str, Callable[[Path], dict[str, Any]]] = {
        "spin of 1e7 steps": lambda folder: spin(SPIN_STEPS),
        "an hour of an unactuated arm": lambda folder: arm(ARM_S),
        "spins of 1e6 rows": lambda folder: spins(given.seed, count=6, rows=1_000_000),
        "an orbit at 1 ms, Earth-pointing": lambda folder: earth_pointing(1.0, 1e-3),
        "a day at 10 ms, Earth-pointing": lambda folder: earth_pointing(ORBITS_A_DAY, 1e-2),
        "a station in the gradient, an orbit at 5 ms": lambda folder: station(1.0, 5e-3),
        "a capsule held for a minute with 12 N": lambda folder: grasp(HELD_S, 12.0),
        "a capsule held for a minute with 60 N": lambda folder: grasp(HELD_S, 60.0),
        "kills": lambda folder: kills(folder, given.seed, KILLS * left()),
        "disk faults": lambda folder: fault_campaign(
            folder, seed=given.seed, seconds=FAULTS / (FAULTS + LEAKS) * left()
        ),
        "leaks": lambda folder: leak_campaign(folder, seconds=left()),
    }
    is_wrong = False
    for name, part in parts.items():
        if given.only not in name:
            continue
        with tempfile.TemporaryDirectory() as folder:
            found = part(Path(folder))
        is_wrong |= bool(found["wrong"])
        print(json.dumps({"part": name} | found), flush=True)
    return 1 if is_wrong else 0


if __name__ == "__main__":
    sys.exit(main())
