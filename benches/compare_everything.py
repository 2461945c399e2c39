"""Cost of the whole environment: times the paper's reach as bundled and with all effects, alternately.

Run it with ``make bench-everything``. The result is the ratio of the real-time factors.
"""

from __future__ import annotations

import statistics

import onorbit_rs as oo
from onorbit_rs.scenario import Scenario, load

ROUNDS = 15
EVERYTHING = [
    {"kind": "gravity_field", "model": "egm2008", "degree": 36},
    {"kind": "gravity_gradient"},
    {"kind": "third_body", "body": "sun"},
    {"kind": "third_body", "body": "moon"},
    {"kind": "drag", "atmosphere": {"kind": "nrlmsise00", "f107": 150, "f107a": 150, "ap": 15}},
    {"kind": "radiation_pressure"},
]


def main() -> None:
    """Prints the real-time factors of each round and the ratio with its spread."""
    plain = load("humanoid_reach")
    full = plain.resolved() | {"epoch": "2026-03-20 12:00:00 UTC", "environment": EVERYTHING}
    full["orbit"] |= {"kind": "numerical"}
    everything = Scenario(**full)
    ratios = []
    for _ in range(ROUNDS):
        alone, all_on = (
            oo.run(scenario, quiet=True).summary["real_time_factor"] for scenario in (plain, everything)
        )
        ratios.append(all_on / alone)
        print(f"as bundled {alone:6.1f} x real time, everything on {all_on:6.1f}: {ratios[-1]:.2f}")
    print(f"ratio {statistics.median(ratios):.2f} ({min(ratios):.2f} to {max(ratios):.2f})")


if __name__ == "__main__":
    main()
