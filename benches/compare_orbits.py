"""Times orbit propagation by this package and by other packages on PyPI, alternately.

Run ``pip install scipy brahe``, then ``python benches/compare_orbits.py [ROUNDS] [JOB ...]``. Each round
times this package and the other one, each by the best of three runs. The output is the median ratio with its
spread, and the accuracy. The jobs are:

- ``sgp4``: 1000 satellites at 1440 epochs, compared with ``SatrecArray``;
- ``kepler``: a million pairs of elements and time, compared with the same equations vectorised in numpy;
- ``day``: one day of a low Earth orbit under J2, compared with SciPy's DOP853 at rtol 1e-12 and with brahe's
  RKN1210 without a stored trajectory and with simple Earth rotation. The errors are differences from an
  integration in x87 extended precision.
"""

from __future__ import annotations

import os
import statistics
import sys
import time
from collections.abc import Callable
from typing import Any

os.environ.setdefault("OMP_NUM_THREADS", "1")

import numpy as np

import onorbit_rs as oo

ROUNDS = 5
DAY = 86400.0
MU, RADIUS, J2 = 3.986004415e14, 6378136.3, 1.0826355e-3


def best(job: Callable[[], Any]) -> float:
    """Returns the shortest time of three calls of ``job``, s."""
    times = []
    for _ in range(3):
        start = time.perf_counter()
        job()
        times.append(time.perf_counter() - start)
    return min(times)


def compare(title: str, theirs: Callable[[], Any], ours: Callable[[], Any], rounds: int) -> None:
    """Times both jobs alternately and prints the median of the ratio ``theirs/ours``, with its spread."""
    pairs = [(best(theirs), best(ours)) for _ in range(rounds)]
    ratios = [a / b for a, b in pairs]
    a, b = (statistics.median(column) * 1e3 for column in zip(*pairs, strict=True))
    spread = f"{min(ratios):.1f} to {max(ratios):.1f}"
    print(f"{title}: theirs {a:.2f} ms, ours {b:.2f} ms, ratio {statistics.median(ratios):.1f} ({spread})")


def element_sets(count: int) -> list[tuple[str, str]]:
    """Returns random element sets, two lines each, of low orbits with inclinations from 20° to 95°."""
    draw = np.random.default_rng(3)

    def line(text: str) -> str:
        return text + str(sum(int(c) if c.isdigit() else c == "-" for c in text) % 10)

    sets = []
    for number in range(10000, 10000 + count):
        inclination, motion = 20 + 75 * draw.random(), 14.2 + 1.2 * draw.random()
        eccentricity = int(1e4 + 1e5 * draw.random())
        node, perigee, anomaly = 359 * draw.random(3)
        sets.append(
            (
                line(f"1 {number:05d}U 24001A   24001.50000000  .00001000  00000-0  50000-4 0  999"),
                line(
                    f"2 {number:05d} {inclination:8.4f} {node:8.4f} {eccentricity:07d} {perigee:8.4f} "
                    f"{anomaly:8.4f} {motion:11.8f}    1"
                ),
            )
        )
    return sets


def sgp4(rounds: int) -> None:
    from sgp4.api import Satrec, SatrecArray

    sets = element_sets(1000)
    theirs = [Satrec.twoline2rv(*lines) for lines in sets]
    ours = [oo.Sgp4(*lines) for lines in sets]
    minutes = np.arange(1440.0)
    jd = np.full(1440, theirs[0].jdsatepoch)
    fraction = theirs[0].jdsatepochF + minutes / 1440
    array = SatrecArray(theirs)
    shape = (1000, 1440, 3)
    out = (np.empty(shape), np.empty(shape))
    _, r, _ = array.sgp4(jd, fraction)
    far = np.abs(oo.propagate(ours, 60 * minutes)[0] / 1e3 - r).max()
    print(f"SGP4 positions differ by at most {far:.1e} km (rounding of the times causes 3e-7 km)")
    for threads, name in ((1, "one core"), (None, "all cores")):

        def many(threads: int | None = threads) -> None:
            oo.propagate(ours, 60 * minutes, threads=threads, out=out)

        compare(f"SGP4 1000 x 1440, {name}", lambda: array.sgp4(jd, fraction), many, rounds)


def numpy_kepler(
    a: Any, e: Any, i: Any, node: Any, periapsis: Any, anomaly: Any, t: Any, mu: float
) -> tuple[Any, Any]:
    """Returns positions, m, and velocities, m/s, (N, 3), on Kepler ellipses in inertial axes.

    The arguments are semi-major axis, m, eccentricity, four angles, rad, time since the mean anomaly, s, and
    the gravitational parameter, m³/s². Kepler's equation is solved with vectorised Newton steps.
    """
    n = np.sqrt(mu / a**3)
    m = np.remainder(anomaly + n * t + np.pi, 2 * np.pi) - np.pi
    eccentric = m + e * np.sin(m)
    for _ in range(50):
        s, c = np.sin(eccentric), np.cos(eccentric)
        step = (eccentric - e * s - m) / (1 - e * c)
        eccentric -= step
        if np.abs(step).max() < 1e-13:
            break
    s, c = np.sin(eccentric), np.cos(eccentric)
    b = np.sqrt(1 - e * e)
    x, y, rate = a * (c - e), a * b * s, n * a / (1 - e * c)
    vx, vy = -rate * s, rate * b * c
    (si, ci), (so, co), (sw, cw) = ((np.sin(x), np.cos(x)) for x in (i, node, periapsis))
    p = (co * cw - so * sw * ci, so * cw + co * sw * ci, sw * si)
    q = (-co * sw - so * cw * ci, -so * sw + co * cw * ci, cw * si)
    r = np.stack([p[k] * x + q[k] * y for k in range(3)], axis=1)
    v = np.stack([p[k] * vx + q[k] * vy for k in range(3)], axis=1)
    return r, v


def kepler(rounds: int) -> None:
    draw, count = np.random.default_rng(5), 1_000_000
    angles = draw.uniform(0, 2 * np.pi, (3, count))
    inclination, t = draw.uniform(0, np.pi, count), draw.uniform(-DAY, DAY, count)
    a = draw.uniform(6.7e6, 4.2e7, count)
    out = (np.empty((count, 3)), np.empty((count, 3)))
    for most in (0.05, 0.9):
        e = draw.uniform(0, most, count)
        elements = (a, e, inclination, *angles)
        names = (
            "semi_major_axis",
            "eccentricity",
            "inclination",
            "raan",
            "argument_of_periapsis",
            "mean_anomaly",
        )
        given = dict(zip(names, elements, strict=True))
        r, _ = numpy_kepler(*elements, t, MU)
        far = np.abs(oo.Kepler.states(t, **given, mu=MU)[0] - r).max()
        print(f"Kepler positions differ by at most {far:.1e} m for eccentricities below {most}")

        def peer(elements: Any = elements) -> None:
            numpy_kepler(*elements, t, MU)

        for threads, name in ((1, "one core"), (None, "all cores")):

            def many(given: Any = given, threads: int | None = threads) -> None:
                oo.Kepler.states(t, **given, mu=MU, threads=threads, out=out)

            compare(f"Kepler, a million pairs, e below {most}, {name}", peer, many, rounds)


def gravity(r: Any, mu: Any, radius: Any, j2: Any) -> Any:
    """Returns the gravity, m/s², of an oblate planet at ``r``, m, in the precision of the arguments."""
    r2 = r @ r
    z2, k = 5 * r[2] ** 2 / r2, 1.5 * j2 * radius**2 / r2
    factor = np.array([1 - k * (z2 - 1), 1 - k * (z2 - 1), 1 - k * (z2 - 3)])
    return -mu / (r2 * np.sqrt(r2)) * r * factor


def extended_day(r: Any, v: Any, mu: float, radius: float, j2: float) -> Any:
    """Returns the position after a day, m, in numpy's longdouble.

    The method is extrapolation of Stoermer's rule with steps of 1 min. ``r`` and ``v`` are the initial state.
    """
    wide = np.longdouble
    mu, radius, j2 = wide(mu), wide(radius), wide(j2)

    def field(r: Any) -> Any:
        return gravity(r, mu, radius, j2)

    r, v = np.array(r, wide), np.array(v, wide)
    big = wide(DAY) / 1440
    for _ in range(1440):
        table: list[list[Any]] = []
        for k in range(1, 9):  # Stoermer's rule with 1 to 8 steps, Aitken-Neville in h²
            h = big / k
            delta = h * (v + h / 2 * field(r))
            x = r + delta
            for _ in range(k - 1):
                delta = delta + h * h * field(x)
                x = x + delta
            row = [np.concatenate([x, delta / h + h / 2 * field(x)])]
            for j, before in enumerate(table[-1] if table else []):
                ratio = wide(k) / (k - j - 1)
                row.append(row[j] + (row[j] - before) / (ratio**2 - 1))
            table.append(row)
        r, v = table[-1][-1][:3], table[-1][-1][3:]
    return r


def day(rounds: int) -> None:
    r0, v0 = np.array([7.0e6, 0, 0]), 7.546e3 * np.array([0, np.cos(0.9), np.sin(0.9)])

    def integral(mu: float, radius: float, j2: float) -> Callable[[], Any]:
        field = oo.GravityField.zonal(j=[j2], mu=mu, radius=radius)
        return lambda: oo.Numerical(r0, v0, environment=[field]).state(DAY)[0]

    def error(end: Any, constants: tuple[float, float, float]) -> float:
        return float(np.linalg.norm(end - extended_day(r0, v0, *constants).astype(float)))

    ours = integral(MU, RADIUS, J2)
    print(f"error of this package after a day: {error(ours(), (MU, RADIUS, J2)):.1e} m")

    from scipy.integrate import solve_ivp

    def slope(_: float, y: Any) -> Any:
        return np.concatenate([y[3:], gravity(y[:3], MU, RADIUS, J2)])

    start = np.concatenate([r0, v0])

    def dop853() -> Any:
        return solve_ivp(slope, (0, DAY), start, method="DOP853", rtol=1e-12, atol=1e-9).y[:3, -1]

    print(f"error of SciPy's DOP853 after a day: {error(dop853(), (MU, RADIUS, J2)):.1e} m")
    compare("LEO day, SciPy DOP853 at rtol 1e-12", dop853, ours, rounds)

    import brahe as bh

    bh.set_global_eop_provider_from_static_provider(bh.StaticEOPProvider.from_zero())
    epoch = bh.Epoch.from_datetime(2024, 1, 1, 12, 0, 0.0, 0.0, bh.TimeSystem.UTC)
    force = bh.ForceModelConfig(
        gravity=bh.GravityConfiguration.earth_zonal(bh.ZonalHarmonicsDegree.J2),
        frame_transform=bh.FrameTransformationModel.EARTH_ROTATION_ONLY,
    )
    settings = bh.NumericalPropagationConfig.high_precision()

    def rkn1210() -> Any:
        orbit = bh.NumericalOrbitPropagator(epoch, start, settings, force, None)
        orbit.set_trajectory_mode(bh.TrajectoryMode.DISABLED)
        orbit.propagate_to(epoch + DAY)
        return np.array(orbit.current_state())[:3]

    constants = (bh.GM_EARTH, bh.R_EARTH, bh.J2_EARTH)
    print(f"error of brahe's RKN1210 after a day: {error(rkn1210(), constants):.1e} m; of this package with "
          f"brahe's constants: {error(integral(*constants)(), constants):.1e} m")  # fmt: skip
    compare("LEO day, brahe RKN1210", rkn1210, integral(*constants), rounds)


def main() -> None:
    """Runs the jobs named on the command line, or all jobs if none is named."""
    given = sys.argv[1:]
    rounds = int(given.pop(0)) if given and given[0].isdigit() else ROUNDS
    print(f"{oo.build_info()['instruction_set']}, {os.cpu_count()} cores, {rounds} rounds")
    jobs: dict[str, Callable[[int], None]] = {"sgp4": sgp4, "kepler": kepler, "day": day}
    for name in given or jobs:
        jobs[name](rounds)


if __name__ == "__main__":
    main()
