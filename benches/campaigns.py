"""Times campaigns: 1000 cases of humanoid_reach, and Dask against processes with cases of 0.2 s, alternated.

python benches/campaigns.py [--cases N] [--rounds N]
"""

from __future__ import annotations

import argparse
import os
import sys
import time
from typing import Any

import onorbit_rs as oo
from onorbit_rs.campaigns import run as campaign_run

JOINTS = {"initial.joints": {"add": {"normal": [0, "0.5 deg"]}}}
REACH = {
    "scenario": "humanoid_reach",
    "seed": 1,
    "vary": JOINTS
    | {
        "robot.links.torso.mass": {"set": {"uniform": [85, 101]}},
        "robot.links.*.inertia": {"scale": {"normal": [1, 0.02]}},
    },
}

LONG = REACH | {"vary": REACH["vary"] | {"simulation.duration": {"set": {"choice": [20.0]}}}}
"""Cases of 0.2 s instead of 0.06 s."""


def seconds(campaign: dict[str, Any], cases: int, **options: Any) -> float:
    """Returns the wall-clock time of a campaign, s."""
    began = time.perf_counter()
    table = oo.campaign({"campaign": campaign | {"cases": cases}}, quiet=True, **options)
    elapsed = time.perf_counter() - began
    assert set(table["status"].to_pylist()) == {"complete"}
    return elapsed


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--cases", type=int, default=1000)
    parser.add_argument("--rounds", type=int, default=1)
    given = parser.parse_args()
    print(f"cores: {os.cpu_count()}, load: {os.getloadavg()[0]:.1f}, {oo.build_info()['instruction_set']}")
    for _ in range(given.rounds):
        print(
            f"humanoid_reach, {given.cases} cases, threads: {seconds(REACH, given.cases):.1f} s", flush=True
        )
    campaign_run.on_threads = campaign_run.on_processes  # without the cost of controllers in Python
    for _ in range(given.rounds):
        processes = seconds(LONG, given.cases)
        dask = seconds(LONG, given.cases, cluster="local", workers=os.cpu_count())
        print(
            f"{given.cases} cases of {os.cpu_count() * processes / given.cases:.2f} s: processes "
            f"{processes:.1f} s, Dask {dask:.1f} s, {dask / processes - 1.0:+.1%}",
            flush=True,
        )


if __name__ == "__main__":
    sys.exit(main())
