"""Writes the tables of ``crates/core/src/earth``: nutation, Sun and Moon.

    pip install de421 jplephem pyerfa skyfield
    python tests/oracles/generate_earth_tables.py

The nutation terms are the larger terms of skyfield's table. The series of Sun and Moon are fitted here: sines
and cosines of multiples of the fundamental arguments, chosen one by one to explain JPL's DE421 over 1900-2050
(orthogonal matching pursuit), with amplitudes by least squares, in the mean ecliptic and equinox of date.
"""

from __future__ import annotations

import sys
from itertools import product
from pathlib import Path
from typing import Any

import de421  # type: ignore[import-untyped]
import erfa  # type: ignore[import-untyped]
import numpy as np
import skyfield  # type: ignore[import-untyped]
from jplephem.ephem import Ephemeris  # type: ignore[import-untyped]

HERE = Path(__file__).parents[2] / "crates" / "core" / "src" / "earth"
ARC_SECOND = np.pi / 648_000
SAMPLES = 9000
J2000 = 2_451_545.0
FROM, TO = 2_415_021.0, 2_469_800.0
SMALLEST_NUTATION = 1000.0  # 0.1 µas
NAMES = ("l", "l'", "F", "D", "Ω", "Venus", "Mars", "Jupiter")

Multiples = tuple[int, ...]


def arguments(t: Any) -> Any:
    """Returns ``l, l', F, D, Ω`` (IERS 2010, eq. 5.43), longitudes of Venus, Mars, Jupiter (5.44), rad."""
    return np.array([
        erfa.fal03(t), erfa.falp03(t), erfa.faf03(t), erfa.fad03(t), erfa.faom03(t),
        erfa.fave03(t), erfa.fama03(t), erfa.faju03(t),
    ])  # fmt: skip


def spherical(jd: Any, position: Any) -> tuple[Any, Any, Any]:
    """Converts GCRF positions to longitude, latitude (mean ecliptic and equinox of date) and distance."""
    gamma, phi, psi, _ = erfa.pfw06(jd, 0.0)
    for axis, angle in ((2, gamma), (0, phi), (2, -psi)):
        c, s = np.cos(angle), np.sin(angle)
        i, j = [(1, 2), (2, 0), (0, 1)][axis]
        position = position.copy()
        position[i], position[j] = c * position[i] + s * position[j], c * position[j] - s * position[i]
    distance = np.linalg.norm(position, axis=0)
    return np.arctan2(position[1], position[0]), np.arcsin(position[2] / distance), distance


def with_sun(multiples: list[int], k: int) -> Multiples:
    """Adds ``k`` times the Earth's longitude, which is the Sun's, ``F - D + Ω``, minus half a turn."""
    return tuple(np.add(multiples, [0, 0, k, -k, k, 0, 0, 0]).tolist())


def lunar(odd: int) -> list[Multiples]:
    main = [
        (i, j, f, d, 0, 0, 0, 0)
        for i, j, f, d in product(range(-6, 7), range(-3, 4), range(-4, 5), range(-6, 7))
        if f % 2 == odd and abs(i) + abs(j) + abs(f) + abs(d) <= 9
    ]
    flat = [
        (i, 0, f, d, o, 0, 0, 0)
        for i, d, f, o in product(range(-2, 3), (-2, 0, 2), range(-2, 3), (-2, -1, 1, 2))
    ]
    planets = [
        with_sun([i, 0, f, d, 0, *np.multiply(k, np.eye(3, dtype=int)[planet]).tolist()], e)
        for planet, k, e, i, d, f in product(
            range(3), range(-6, 7), range(-9, 10), range(-2, 3), (-2, 0, 2), (-odd, odd)
        )
        if k != 0 and (planet == 0 or abs(k) <= 4)
    ]
    return main + flat + planets


SLOW = tuple(-x for x in with_sun([-1, 0, 0, 0, 0, 18, 0, 0], -16))
"""Returns Venus' 273-year term in the Moon's longitude, 14", half a cycle of which looks like a trend."""


def solar() -> list[Multiples]:
    planets = [
        with_sun([0, 0, 0, 0, 0, *np.multiply(k, np.eye(3, dtype=int)[planet]).tolist()], e)
        for planet, k, e in product(range(3), range(-9, 10), range(-14, 15))
        if k != 0 and abs(k + e) <= 5 and (planet < 2 or abs(k) <= 4)
    ]
    ours = [
        (i, j, f, d, 0, 0, 0, 0)
        for i, j, d, f in product(range(-2, 3), range(-3, 4), range(-2, 4), range(-2, 3))
    ]
    return planets + ours


def distinct(multiples: list[Multiples]) -> Any:
    """Keeps one of each pair ``k, -k``."""
    first = lambda k: next((x for x in k if x), 0)  # noqa: E731
    return np.array(sorted({k if first(k) > 0 else tuple(-x for x in k) for k in multiples if first(k)}))


def fit(
    name: str, y: Any, t: Any, library: Any, terms: int, degree: int, given: Multiples | None = None
) -> tuple[Any, Any, Any]:
    """Fits a polynomial and periodic terms to ``y``; returns them with their amplitudes."""
    library = library if given is None else np.vstack([given, library])
    # terms with l' decrease with the eccentricity of the Earth's orbit
    fading = (1 - 0.002516 * t) ** np.abs(library[:, 1:2])
    angles = library @ arguments(t)
    waves = (fading * np.exp(1j * angles)).astype(np.complex64)
    columns = [t**i for i in range(degree + 1)]
    chosen: list[int] = []
    solve = lambda: np.linalg.lstsq(np.array(columns).T, y, rcond=None)[0]  # noqa: E731
    for _ in range(terms):
        rest = y - np.array(columns).T @ solve()
        explained = np.abs(waves.conj() @ rest.astype(np.complex64))
        for k in np.argsort(-explained) if chosen or given is None else [0]:
            # over these years, terms with nearly equal frequencies cannot be separated
            if not chosen or np.abs(waves[chosen].conj() @ waves[k]).max() < 0.6 * t.size:
                break
        chosen.append(int(k))
        columns += [fading[k] * np.sin(angles[k]), fading[k] * np.cos(angles[k])]
    c = solve()
    rest = y - np.array(columns).T @ c
    print(f"{name}: {terms} terms leave {rest.std():.3f} rms, {np.abs(rest).max():.3f} at most")
    return c[: degree + 1], library[chosen], c[degree + 1 :].reshape(-1, 2)


def written(number: float) -> str:
    """Writes a number with underscores between groups of three digits, as clippy requires."""
    text = f"{number:.3f}".rstrip("0")
    whole, _, part = text.partition(".")
    return (
        f"{int(whole):_}"
        if not part
        else (("-" if whole.startswith("-") else "") + f"{abs(int(whole)):_}.{part}")
    )


def rust_number(number: float) -> str:
    text = written(number)
    return text if "." in text else text + ".0"


def rust_series(name: str, about: str, found: tuple[Any, Any, Any]) -> str:
    polynomial, multiples, amplitudes = found
    rows = "".join(
        f"        ({k.tolist()}, [{rust_number(a[0])}, {rust_number(a[1])}]),\n"
        for k, a in zip(multiples, amplitudes, strict=True)
    )
    start = ", ".join(rust_number(c) for c in polynomial)
    return (
        f"/// {about}\npub(super) const {name}: Series = Series {{\n    polynomial: &[{start}],\n"
        f"    terms: &[\n{rows}    ],\n}};\n"
    )


def write(file: str, head: str, tables: list[str]) -> None:
    (HERE / file).write_text(head + "\n" + "\n".join(tables))


def write_nutation() -> None:
    data = np.load(Path(skyfield.__file__).parent / "data" / "nutation.npz")
    amplitudes = np.hstack(
        [data["lunisolar_longitude_coefficients"], data["lunisolar_obliquity_coefficients"]]
    )
    kept = np.abs(amplitudes).max(axis=1) >= SMALLEST_NUTATION
    rows = "".join(
        f"    ({k.tolist()}, [{', '.join(rust_number(x / 10) for x in a)}]),\n"
        for k, a in zip(data["nals_t"][kept], amplitudes[kept], strict=True)
    )
    head = """//! Terms of the nutation of IAU 2000A; written by `tests/oracles/generate_earth_tables.py`.

/// Lunisolar terms of at least 0.1 mas: multiples of `l, l', F, D, Ω`; amplitudes in µas of `Δψ` by sine,
/// sine × T and cosine, and of `Δε` by cosine, cosine × T and sine.
///
/// Source: Mathews, Herring and Buffett, J. Geophysical Research 107(B4), 2002; IERS Conventions (2010),
/// tables 5.3a and 5.3b, from the Python package skyfield.
"""
    (HERE / "nutation_table.rs").write_text(
        f"{head}pub(super) const NUTATION: [([i8; 5], [f64; 6]); {kept.sum()}] = [\n{rows}];\n"
    )


HEAD = """//! Series of the {body}; written by `tests/oracles/generate_earth_tables.py`.
//!
//! Fitted to JPL's DE421 over 1900-2050, in the mean ecliptic and equinox of date. Terms are in the order of
//! their contribution.

use super::series::Series;
"""


def main() -> None:
    write_nutation()
    ephemeris = Ephemeris(de421)
    jd = np.sort(np.random.default_rng(7).uniform(FROM, TO, SAMPLES))
    moon = np.array(ephemeris.position("moon", jd)) * 1e3
    earth = np.array(ephemeris.position("earthmoon", jd)) * 1e3 - moon * ephemeris.earth_share
    sun = np.array(ephemeris.position("sun", jd)) * 1e3 - earth
    t = (jd - J2000) / 36_525
    _, _, f, d, omega = arguments(t)[:5]
    for body, position, mean, sizes, libraries, slow in (
        ("Sun", sun, f - d + omega, (30, 8, 30), (solar(), solar()), None),
        ("Moon", moon, f + omega, (90, 60, 50), (lunar(0), lunar(1)), SLOW),
    ):
        longitude, latitude, distance = spherical(jd, position)
        even, odd = (distinct(library) for library in libraries)
        offset = (longitude - mean + np.pi) % (2 * np.pi) - np.pi
        of = "F - D + Ω" if body == "Sun" else "F + Ω"
        write(f"{body.lower()}_table.rs", HEAD.format(body=body), [
            rust_series("LONGITUDE", f"Longitude minus `{of}`, arc seconds.",
                        fit(f"{body}: longitude, arcsec", offset / ARC_SECOND, t, even, sizes[0], 1, slow)),
            rust_series("LATITUDE", "Latitude, arc seconds.",
                        fit(f"{body}: latitude, arcsec", latitude / ARC_SECOND, t, odd, sizes[1], 0)),
            rust_series("DISTANCE", "Distance, km.",
                        fit(f"{body}: distance, km", distance / 1e3, t, even, sizes[2], 0)),
        ])  # fmt: skip


if __name__ == "__main__":
    sys.exit(main())
