"""Propagates a thousand satellites for a day and finds the closest approach of any two.

Run: python examples/many_satellites.py [COUNT]
"""

from __future__ import annotations

import sys
import time

import numpy as np

import onorbit_rs as oo


def main(count: int = 1000) -> None:
    rng = np.random.default_rng(1)
    orbits = [
        oo.Kepler(
            semi_major_axis=rng.uniform(6.9e6, 7.0e6),
            eccentricity=rng.uniform(0.0, 0.002),
            inclination=rng.normal(1.70, 0.02),
            raan=rng.uniform(0.0, 2 * np.pi),
            mean_anomaly=rng.uniform(0.0, 2 * np.pi),
            secular_j2=True,  # secular drift of node, periapsis and phase due to the Earth's oblateness
        )
        for _ in range(count)
    ]
    times = np.arange(0.0, 86_400.0, 60.0)
    began = time.perf_counter()
    r, v = oo.propagate(orbits, times)  # (count, T, 3) each: m, m/s, inertial
    took = time.perf_counter() - began
    each = 1e9 * took / (count * times.size)
    print(f"{count} satellites at {times.size} times in {took:.3f} s: {each:.0f} ns each")

    nearest, where = np.inf, (0, 0, 0)
    for k in range(0, times.size, 10):  # every ten minutes
        squares = np.einsum("ij,ij->i", r[:, k], r[:, k])
        apart = squares[:, None] + squares[None] - 2 * r[:, k] @ r[:, k].T  # |a - b|²
        np.fill_diagonal(apart, np.inf)
        i, j = divmod(int(apart.argmin()), count)
        if apart[i, j] < nearest:
            nearest, where = float(apart[i, j]), (i, j, k)
    i, j, k = where
    speed = np.linalg.norm(v[i, k] - v[j, k])
    print(
        f"after {times[k] / 3600:.1f} h satellites {i} and {j} are {np.sqrt(nearest) / 1e3:.1f} km apart",
        end=", ",
    )
    print(f"at {speed / 1e3:.1f} km/s")
    rho, _ = oo.relative.to_lvlh(orbits[i], float(times[k]), r[j, k], v[j, k])
    print("relative to the first, radial, along track, across:", np.round(rho / 1e3, 2), "km")


if __name__ == "__main__":
    main(*map(int, sys.argv[1:]))
