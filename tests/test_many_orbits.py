"""Batches of orbits: against PyPI's SGP4, against single orbits, and invalid input."""

from __future__ import annotations

import pickle

import numpy as np
import pytest

import onorbit_rs as oo
from onorbit_rs.exceptions import DtypeError, InputError, OrbitError, Sgp4Error, ShapeError

LOW = (
    "1 06251U 62025E   06176.82412014  .00008885  00000-0  12808-3 0  3985",
    "2 06251  58.0579  54.0425 0030035 139.1568 221.1854 15.56387291  6774",
)
DEEP = (
    "1 11801U          80230.29629788  .01431103  00000-0  14311-1      13",
    "2 11801  46.7916 230.4354 7318036  47.4722  10.4117  2.28537848    13",
)
SHORT_LIVED = (
    "1 28350U 04020A   06167.21788666  .16154492  76267-5  18678-3 0  8894",
    "2 28350  64.9977 345.6130 0024870 260.7578  99.9590 16.47856722116490",
)


def mixed() -> list[oo.Orbit]:
    path = oo.CustomPath([0.0, 5e4, 1e5], [[7e6, 0, 0], [0, 7e6, 0], [-7e6, 0, 0]])
    return [
        oo.Sgp4(*LOW),
        oo.Sgp4(*DEEP),
        oo.Kepler(semi_major_axis=7e6, eccentricity=0.2, inclination=1.0, mean_anomaly=0.4),
        oo.Kepler(semi_major_axis=7e6, eccentricity=0.2, inclination=1.0, secular_j2=True),
        oo.Numerical([7e6, 0, 0], [0, 7.5e3, 1e3]),
        path,
        oo.FixedFrame(position=[1.0, 2.0, 3.0]),
    ]


def test_agrees_with_pypis_sgp4() -> None:
    from sgp4.api import Satrec, SatrecArray

    peers = [Satrec.twoline2rv(*lines) for lines in (LOW, DEEP)]
    fraction = np.arange(0.0, 0.7, 0.01)
    for peer, ours in zip(peers, (oo.Sgp4(*LOW), oo.Sgp4(*DEEP)), strict=True):
        jd = np.full_like(fraction, peer.jdsatepoch)
        _, r, v = SatrecArray([peer]).sgp4(jd, peer.jdsatepochF + fraction)
        r_ours, v_ours = oo.propagate([ours], 86400 * fraction)
        # a Julian date is exact to 1e-11 s, times 10 km/s: far below the 2e-7 km of published rows
        assert np.abs(r_ours / 1e3 - r).max() < 2e-7
        assert np.abs(v_ours / 1e3 - v).max() < 2e-9


@pytest.mark.parametrize("threads", [None, 1, 2])
def test_a_mixed_batch_equals_single_states(threads: int | None) -> None:
    orbits, times = mixed(), np.linspace(0.0, 8e4, 37)
    r, v = oo.propagate(orbits, times, threads=threads)
    assert r.shape == v.shape == (len(orbits), 37, 3)
    for orbit, rows, speeds in zip(orbits, r, v, strict=True):
        singly = [orbit.state(t) for t in times]
        assert np.allclose(rows, [s[0] for s in singly], rtol=0, atol=3e-7)  # rounding of the phase
        assert np.allclose(speeds, [s[1] for s in singly], rtol=0, atol=3e-10)
    each = np.tile(times, (len(orbits), 1))
    assert np.array_equal(oo.propagate(orbits, each)[0], r)


def test_results_are_written_to_out() -> None:
    orbits, times = mixed(), np.linspace(0.0, 100.0, 5)
    out = (np.empty((len(orbits), 5, 3)), np.empty((len(orbits), 5, 3)))
    r, v = oo.propagate(orbits, times, out=out)
    assert r is out[0]
    assert v is out[1]
    assert np.array_equal(r, oo.propagate(orbits, times)[0])
    for wrong in (np.empty((len(orbits), 5, 2)), out[0][:, :, ::-1]):
        with pytest.raises(ShapeError, match="out"):
            oo.propagate(orbits, times, out=(wrong, out[1]))
    with pytest.raises(DtypeError, match="out"):
        oo.propagate(orbits, times, out=(np.empty((len(orbits), 5, 3), np.float32), out[1]))
    out[0].flags.writeable = False
    with pytest.raises(InputError, match="read-only"):
        oo.propagate(orbits, times, out=out)
    with pytest.raises(InputError, match="in use"):
        oo.propagate(orbits, times, out=(out[1], out[1]))


def test_an_orbit_with_an_error_is_named() -> None:
    orbits = [oo.Sgp4(*LOW), oo.Sgp4(*SHORT_LIVED), oo.Sgp4(*SHORT_LIVED)]
    with pytest.raises(Sgp4Error, match=r"^orbit 1: SGP4 error 1 at t = ") as caught:
        oo.propagate(orbits, np.arange(0.0, 1e5, 600.0))
    assert caught.value.index == 1
    assert caught.value.code == 1
    assert pickle.loads(pickle.dumps(caught.value)).index == 1
    with pytest.raises(OrbitError, match="orbit 0"):
        oo.propagate(mixed(), [np.nan])
    with pytest.raises(ShapeError, match="times"):
        oo.propagate(orbits, np.zeros((2, 5)))
    with pytest.raises(InputError, match="threads"):
        oo.propagate(orbits, [0.0], threads=0)
    assert oo.propagate([], [0.0])[0].shape == (0, 1, 3)


def test_ellipses_by_their_elements() -> None:
    draw = np.random.default_rng(1)
    given = {
        "semi_major_axis": draw.uniform(7e6, 4e7, 50),
        "eccentricity": draw.uniform(0, 0.9, 50),
        "inclination": draw.uniform(0, 3, 50),
        "raan": draw.uniform(0, 6, 50),
        "argument_of_periapsis": draw.uniform(0, 6, 50),
        "mean_anomaly": draw.uniform(-3, 3, 50),
    }
    t = draw.uniform(-1e5, 1e5, 50)
    r, v = oo.Kepler.states(t, **given)
    for k in range(50):
        one = oo.Kepler(**{name: values[k] for name, values in given.items()})
        position, velocity = one.state(t[k])
        assert np.allclose(r[k], position, rtol=0, atol=1e-6)  # 100 rad rounded
        assert np.allclose(v[k], velocity, rtol=0, atol=1e-8)
    alike = oo.Kepler.states(t, **{name: values[0] for name, values in given.items()})[0]
    assert np.allclose(alike[0], r[0], rtol=0, atol=1e-9)
    with pytest.raises(InputError, match=r"eccentricity is 1\.5; it must be in \[0, 1\)"):
        oo.Kepler.states(t, **(given | {"eccentricity": 1.5}))
    with pytest.raises(ShapeError, match="raan"):
        oo.Kepler.states(t, **(given | {"raan": np.zeros(3)}))
