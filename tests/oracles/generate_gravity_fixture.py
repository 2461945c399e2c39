"""Writes ``tests/fixtures/gravity.json``: EGM2008 36 x 36 from its definition, computed with 100 digits.

    python -m pip install mpmath
    python tests/oracles/generate_gravity_fixture.py

``U = (mu/r) sum (R/r)^n N_nm Q_nm(z/r) Re[(C - iS) ((x + iy)/r)^m]`` with ``Q_nm`` the m-th derivative of
Legendre's polynomial, written out by its binomials: no recursion, no pole. Derivatives are central
differences with a step of 1e-25 R.
"""

from __future__ import annotations

import json
import re
from pathlib import Path

import mpmath as mp  # type: ignore[import-untyped]

REPOSITORY = Path(__file__).parents[2]
MODEL = REPOSITORY / "crates" / "core" / "src" / "gravity" / "models" / "egm2008.gfc"
FILE = REPOSITORY / "tests" / "fixtures" / "gravity.json"
DEGREE = 36
MU, R = mp.mpf("3.986004415e14"), mp.mpf("6378136.3")

mp.mp.dps = 100


def coefficients() -> dict[tuple[int, int], tuple[mp.mpf, mp.mpf]]:
    rows = re.findall(r"^gfc (\d+) (\d+) (\S+) (\S+)$", MODEL.read_text(), re.MULTILINE)
    # as doubles, as in the engine
    return {
        (int(n), int(m)): (mp.mpf(float(c)), mp.mpf(float(s))) for n, m, c, s in rows if 2 <= int(n) <= DEGREE
    }


def polynomial(n: int, m: int) -> list[tuple[int, mp.mpf]]:
    """Returns powers and normalised coefficients of the m-th derivative of Legendre's polynomial."""
    norm = mp.sqrt((1 if m == 0 else 2) * (2 * n + 1) * mp.factorial(n - m) / mp.factorial(n + m))
    terms = []
    for k in range((n - m) // 2 + 1):
        power = n - 2 * k
        falling = mp.factorial(power) / mp.factorial(power - m)
        c = (-1) ** k * mp.binomial(n, k) * mp.binomial(2 * n - 2 * k, n) / mp.mpf(2) ** n
        terms.append((power - m, norm * c * falling))
    return terms


TERMS = [(n, m, c, s, polynomial(n, m)) for (n, m), (c, s) in coefficients().items()]


def potential(x: list[mp.mpf], centre: bool = False) -> mp.mpf:
    r = mp.sqrt(sum(i * i for i in x))
    t, ratio = x[2] / r, R / r
    powers = [mp.mpf(1)]
    turns = [mp.mpc(1)]
    for _ in range(DEGREE):
        powers.append(powers[-1] * t)
        turns.append(turns[-1] * mp.mpc(x[0], x[1]) / r)
    total = mp.mpf(1 if centre else 0)
    for n, m, c, s, terms in TERMS:
        q = mp.fsum(k * powers[p] for p, k in terms)
        total += ratio**n * q * (c * turns[m].real + s * turns[m].imag)
    return MU / r * total


STEP = R * mp.mpf(10) ** -25


def moved(x: list[mp.mpf], *steps: tuple[int, int]) -> list[mp.mpf]:
    out = list(x)
    for axis, count in steps:
        out[axis] += count * STEP
    return out


def acceleration(x: list[mp.mpf], centre: bool = False) -> list[mp.mpf]:
    at = lambda i, k: potential(moved(x, (i, k)), centre)  # noqa: E731
    return [(at(i, 1) - at(i, -1)) / (2 * STEP) for i in range(3)]


def gradient(x: list[mp.mpf]) -> list[list[mp.mpf]]:
    at = lambda i, a, j, b: potential(moved(x, (i, a), (j, b)))  # noqa: E731
    return [
        [
            (at(i, 1, j, 1) - at(i, 1, j, -1) - at(i, -1, j, 1) + at(i, -1, j, -1)) / (4 * STEP**2)
            for j in range(3)
        ]
        for i in range(3)
    ]


POINTS = [
    [4e6, -3e6, 5e6],
    [0.0, 0.0, 6.8e6],
    [0.0, 0.0, -6.8e6],
    [1e-3, 2e-3, 6.7e6],
    [-7e6, 0.0, 0.0],
    [2.5e7, 3e7, 1e7],
]
ORIGIN = [-4292653.41, 955168.47, 5139356.57]
DIRECTIONS = [[0.6, -0.48, 0.64], [-0.63, 0.14, 0.76]]
SIZES = [1e-3, 1.0, 5.0, 19.0, 21.0, 1e2, 1e3, 1e4]


def exact(x: list[float]) -> list[mp.mpf]:
    return [mp.mpf(i) for i in x]


def plain(value: object) -> object:
    return [plain(i) for i in value] if isinstance(value, list) else float(value)  # type: ignore[arg-type]


def main() -> None:
    values = [
        {"r": r, "acceleration": plain(acceleration(exact(r))), "gradient": plain(gradient(exact(r)))}
        for r in POINTS
    ]
    origin, differences = exact(ORIGIN), []
    there = acceleration(origin, centre=True)
    for direction in DIRECTIONS:
        for size in SIZES:
            offset = [size * i for i in direction]
            moved_to = [a + b for a, b in zip(origin, exact(offset), strict=True)]
            here = acceleration(moved_to, centre=True)
            tide = [a - b for a, b in zip(here, there, strict=True)]
            differences.append({"offset": offset, "tide": plain(tide)})
    table = {
        "generator": "tests/oracles/generate_gravity_fixture.py",
        "engine": f"mpmath {mp.__version__}, {mp.mp.dps} digits",
        "model": "EGM2008, 36 x 36, coefficients as doubles",
        "units": "m, m/s2, 1/s2; axes fixed in the planet; the point mass is in the tides alone",
        "values": values,
        "origin": ORIGIN,
        "tides": differences,
    }
    FILE.write_text(json.dumps(table, indent=1) + "\n")
    print(f"{FILE}: {FILE.stat().st_size} bytes")


if __name__ == "__main__":
    main()
