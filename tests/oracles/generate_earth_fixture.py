"""Writes ``tests/fixtures/earth.json``: Earth orientation, Sun and Moon from independent packages.

    pip install de421 jplephem mpmath pyerfa skyfield
    python tests/oracles/generate_earth_fixture.py

Orientation from pyerfa (full IAU 2006/2000A), TEME from skyfield, Sun and Moon from JPL's DE421, geodetic
places and tides from closed forms by mpmath.
"""

from __future__ import annotations

import json
from datetime import UTC, datetime
from itertools import product
from pathlib import Path
from typing import Any

import de421  # type: ignore[import-untyped]
import erfa  # type: ignore[import-untyped]
import numpy as np
import skyfield  # type: ignore[import-untyped]
from jplephem.ephem import Ephemeris  # type: ignore[import-untyped]
from mpmath import cos, mp, mpf, sin, sqrt  # type: ignore[import-untyped]
from skyfield.api import load  # type: ignore[import-untyped]
from skyfield.sgp4lib import TEME  # type: ignore[import-untyped]

FILE = Path(__file__).parents[1] / "fixtures" / "earth.json"
DAY = 86_400.0
ARC_SECOND = np.pi / 648_000

# TAI, UT1 - TAI in s, pole in arc seconds: realistic magnitudes for these dates
ORIENTATIONS = [
    ("1972-02-29T06:00:00", -10.3, 0.05, 0.2),
    ("1990-01-01T00:00:25", -25.1, -0.11, 0.26),
    ("1995-07-14T17:31:12.5", -29.2, 0.21, 0.41),
    ("2000-01-01T12:00:00", -31.64, 0.043, 0.378),
    ("2004-04-06T07:52:00", -32.4, -0.14, 0.33),
    ("2007-11-20T00:00:32", -32.469, 0.0, 0.0),
    ("2012-10-03T23:59:59", -34.7, 0.18, 0.33),
    ("2017-05-05T03:14:15.926535", -36.5, 0.02, 0.45),
    ("2024-03-01T12:00:37", -37.01, 0.04, 0.31),
    ("2031-09-09T09:09:09", -37.2, -0.2, 0.5),
    ("2040-12-31T18:00:00", -38.0, 0.3, 0.1),
    ("2050-06-15T00:00:00", -39.5, -0.3, 0.6),
]


def julian(tai: str) -> tuple[float, float]:
    date, clock = tai.split("T")
    hour, minute, second = (float(x) for x in clock.split(":"))
    jd, mjd = erfa.cal2jd(*(int(x) for x in date.split("-")))
    return jd + mjd, (hour * 3600 + minute * 60 + second) / DAY


def orientation(tai: str, ut1_minus_tai: float, x: float, y: float) -> dict[str, Any]:
    day, part = julian(tai)
    tt, ut1 = (day, part + 32.184 / DAY), (day, part + ut1_minus_tai / DAY)
    xp, yp = x * ARC_SECOND, y * ARC_SECOND
    angle = erfa.gst06a(*ut1, *tt)
    wobble = erfa.pom00(xp, yp, 0.0)
    turned = lambda npb, angle: wobble @ erfa.rz(angle, np.eye(3)) @ npb  # noqa: E731
    wrong = {
        "nutation": turned(erfa.pmat06(*tt), erfa.gmst06(*ut1, *tt)),
        "precession": turned(np.eye(3), erfa.gmst06(*ut1, *tt)),
        "polar motion": erfa.c2t06a(*tt, *ut1, 0.0, 0.0),
        "frame bias": turned(erfa.pn06a(*tt)[6] @ erfa.pn06a(*tt)[4], angle),
    }
    time = load.timescale(builtin=True).tt_jd(*tt)
    time.delta_t = 32.184 - ut1_minus_tai  # skyfield takes UT1 from here
    return {
        "tai": tai, "ut1_minus_tai": ut1_minus_tai, "xp": xp, "yp": yp,
        "rot_fi": erfa.c2t06a(*tt, *ut1, xp, yp).tolist(),
        "rot_f_teme": turned(np.eye(3), erfa.gmst82(*ut1)).tolist(),
        "rot_teme_gcrf": np.asarray(TEME.rotation_at(time)).tolist(),
        "without": {name: rotation.tolist() for name, rotation in wrong.items()},
    }  # fmt: skip


def sky() -> list[dict[str, Any]]:
    ephemeris = Ephemeris(de421)
    rows = []
    for days in np.linspace(-3652.3, 18400.7, 60):
        jd = 2_451_545.0 + round(float(days), 4)
        moon = np.array(ephemeris.position("moon", jd)).ravel()
        earth = np.array(ephemeris.position("earthmoon", jd)).ravel() - moon * ephemeris.earth_share
        sun = np.array(ephemeris.position("sun", jd)).ravel() - earth
        rows.append({"tdb_days": jd - 2_451_545.0, "sun_km": sun.tolist(), "moon_km": moon.tolist()})
    return rows


def places() -> list[dict[str, float]]:
    """Returns geodetic places on and off WGS84 and their positions to fifty digits."""
    mp.dps = 50
    a, f = mpf(6_378_137), 1 / mpf("298.257223563")
    e2, rows = f * (2 - f), []
    for latitude, longitude, altitude in product(
        (-1.5707963267948966, -1.5707, -0.9, 0.0, 1e-9, 0.52, 1.2, 1.5707963267),
        (-3.0, 0.0, 1.7),
        (-6.2e6, -1000.0, 0.0, 4.1e5, 3.6e7, 3.8e8),
    ):
        if altitude < -1e6 and abs(latitude) > 1.4:
            continue  # below the centre, on the other side
        n = a / sqrt(1 - e2 * sin(mpf(latitude)) ** 2)
        p = (n + mpf(altitude)) * cos(mpf(latitude))
        x, y = p * cos(mpf(longitude)), p * sin(mpf(longitude))
        z = ((1 - e2) * n + mpf(altitude)) * sin(mpf(latitude))
        rows.append({
            "latitude": latitude, "longitude": longitude, "altitude": altitude,
            "position": [float(x), float(y), float(z)],
        })  # fmt: skip
    return rows


def tides() -> list[dict[str, Any]]:
    """Returns tidal accelerations of third bodies to fifty digits: ``μ [(s - r)/|s - r|³ - s/|s|³]``."""
    mp.dps = 50
    rows = []
    for mu, body in ((1.3271244e20, [-2.65e10, 1.327e11, 5.75e10]), (4.9028e12, [-2.9e8, -2.7e8, -9.3e7])):
        for r in ([6.7e6, 1.2e6, -9e5], [-1e3, 2e2, 7e6], [4.2e7, -1e6, 3e5], [1.0, 2.0, -0.5]):
            away = [mpf(s) - mpf(x) for s, x in zip(body, r, strict=True)]
            near, far = (sqrt(sum(mpf(x) ** 2 for x in v)) ** 3 for v in (away, body))
            tide = [float(mpf(mu) * (d / near - mpf(s) / far)) for d, s in zip(away, body, strict=True)]
            rows.append({"mu": mu, "body": body, "r": r, "tide": tide})
    return rows


def main() -> None:
    table = {
        "generator": "tests/oracles/generate_earth_fixture.py",
        "engines": f"pyerfa {erfa.__version__}, skyfield {skyfield.__version__}, jplephem with DE421",
        "date": datetime.now(UTC).date().isoformat(),
        "orientation": [orientation(*case) for case in ORIENTATIONS],
        "sky": sky(),
        "places": places(),
        "tides": tides(),
    }
    FILE.write_text(json.dumps(table, separators=(",", ":")) + "\n")
    print(f"{FILE}: {FILE.stat().st_size} bytes")


if __name__ == "__main__":
    main()
