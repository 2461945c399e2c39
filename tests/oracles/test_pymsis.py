"""NRLMSISE-00 against pymsis, the Naval Research Laboratory's Fortran code.

The Fortran is in single precision: its densities differ by up to 9e-5 from the C translation in double
precision (PyPI's ``nrlmsise00``), with which this package agrees to 1e-12. The gates are therefore 9e-5 for
the largest and 2e-6 for the median deviation.
"""

from __future__ import annotations

import numpy as np
import pytest

import onorbit_rs as oo

msis = pytest.importorskip("pymsis.msis", reason="pymsis, which is in the test extra, is not installed")

EPOCHS = ["2001-03-20T05:40:10", "2009-12-31T23:50:00", "2014-06-21T12:00:00", "2020-02-29T18:20:30"]
INDICES = [(68.0, 70.0, 3.0), (150.0, 140.0, 15.0), (240.0, 190.0, 120.0)]


@pytest.mark.parametrize("history", [False, True])
def test_density_over_heights_places_times_and_space_weather(history: bool) -> None:
    rng = np.random.default_rng(11)
    altitude = np.array([100.5, 130.0, 180.0, 251.0, 310.0, 400.0, 520.0, 700.0, 999.0])
    count = 12
    latitude, longitude = np.arcsin(rng.uniform(-1, 1, count)), rng.uniform(-np.pi, np.pi, count)
    errors = []
    for text in EPOCHS:
        earth = oo.Earth(f"{text} UTC")
        for f107, f107a, ap in INDICES:
            # most of the storm lies before or after the day
            aps = (
                np.array([ap, 0.9 * ap, ap, 0.5 * ap, 0.4 * ap, 0.3 * ap, 0.2 * ap])
                if history
                else np.full(7, ap)
            )
            air = oo.Nrlmsise00(f107=f107, f107a=f107a, ap=aps if history else ap)
            ours = air.density(altitude[:, None] * 1e3, latitude, longitude, earth=earth)
            grid = [np.broadcast_to(x, ours.shape).ravel() for x in (altitude[:, None], latitude, longitude)]
            n = ours.size
            theirs = msis.calculate(
                np.full(n, np.datetime64(text)), np.degrees(grid[2]), np.degrees(grid[1]), grid[0],
                np.full(n, f107), np.full(n, f107a), np.tile(aps, (n, 1)),
                version=0, geomagnetic_activity=-1 if history else 1,
            )[:, 0]  # fmt: skip
            errors.append(np.abs(ours.ravel() / theirs - 1.0))
    worst, middle = np.max(errors), np.median(errors)
    print(f"{np.size(errors)} places: worst {worst:.1e}, median {middle:.1e}")
    assert worst < 1e-4
    assert middle < 2e-6
    # indices of the previous day would be detected
    wrong = oo.Nrlmsise00(f107=151.0, f107a=140.0, ap=15.0).density(400e3, earth=earth)
    right = oo.Nrlmsise00(f107=150.0, f107a=140.0, ap=15.0).density(400e3, earth=earth)
    assert abs(wrong / right - 1.0) > 1e-3
