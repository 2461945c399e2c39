"""Measures the cost of all environmental effects on the scenario ``humanoid_reach``.

Run it with ``make bench-everything``. The scenario is run alternately as bundled and with all effects. The
result is the real-time factor with all effects divided by that of the bundled scenario.
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
    """Prints the real-time factors of each round and the median of their ratios with its spread."""
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
        print(
            f"real-time factor: {alone:.1f} as bundled, {all_on:.1f} with all effects; ratio {ratios[-1]:.2f}"
        )
    print(f"median ratio {statistics.median(ratios):.2f} ({min(ratios):.2f} to {max(ratios):.2f})")


if __name__ == "__main__":
    main()
