"""Reads the positions of Sun and Moon from SPICE kernels (``.bsp``) with PyPI's ``jplephem``."""

from __future__ import annotations

import struct
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from onorbit_rs.common.input_files import check_regular
from onorbit_rs.exceptions import EarthError, ReadError

if TYPE_CHECKING:
    from numpy.typing import NDArray

BODIES = {"sun": 10, "moon": 301, "earth": 399}
_NUMBERS = (2, 6)
"""Number of doubles and number of integers in the summary of a segment of positions."""

SOLAR_SYSTEM = 0
"""NAIF ID of the solar system's barycentre, at which the chains of segments end."""

_DOWNLOAD = "download it again, or give another kernel, such as de440s.bsp"

Segment = tuple[float, float, float, "NDArray[np.float64]"]
"""Series of positions: sign, start (s of TDB from J2000.0), interval (s), and Chebyshev coefficients, km.

The coefficients have the shape (3, intervals, count).
"""


def segments(path: str | Path) -> tuple[list[Segment], list[Segment]]:
    """Return the segments whose signed sum is the vector from the Earth to the Sun, and to the Moon.

    Raises
    ------
    NotFoundError, ReadError
        If there is no such file, or it is damaged or not a kernel of positions.
    EarthError
        If ``jplephem`` is not installed, or the kernel lacks Sun, Moon or Earth, does not connect them, or
        has segments of another type.
    """
    try:
        from jplephem.spk import SPK
    except ImportError:
        message = "SPICE kernels require jplephem, which is not installed: pip install 'onorbit-rs[spice]'"
        raise EarthError(message, name="ephemeris", got=str(path)) from None
    check_regular(path, "SPICE kernel")
    try:
        _check_records(path)
        kernel = SPK.open(path)
    except Exception as error:  # jplephem raises many kinds of errors for a damaged file
        raise ReadError(
            f"{path} cannot be read as a SPICE kernel of positions (SPK, .bsp): {error}; {_DOWNLOAD}",
            path=str(path),
            kind="SPICE kernel",
        ) from None
    try:
        sun, moon, earth = (_chain(kernel, name, path) for name in ("sun", "moon", "earth"))
        return _between(kernel, sun, earth, path), _between(kernel, moon, earth, path)
    finally:
        kernel.close()


def _check_records(path: str | Path) -> None:
    """Raise ValueError if a file has no positions, or if jplephem would follow a cycle of records forever."""
    from jplephem.daf import DAF

    with Path(path).open("rb") as stream:
        numbers = stream.read(16)[8:]
        if len(numbers) < 8 or _NUMBERS not in (struct.unpack(order, numbers) for order in ("<2I", ">2I")):
            raise ValueError("it contains no segments of positions")
        seen: set[int] = set()
        for number, _, _ in DAF(stream).summary_records():
            if number in seen:
                raise ValueError(f"its summary records form a cycle at record {number}")
            seen.add(number)


def _chain(kernel: Any, name: str, path: str | Path) -> list[tuple[int, int]]:
    """Return the pairs of centre and target from a body to the barycentre of the solar system.

    They end at an earlier centre if the kernel has no segment from there. Raises EarthError if the kernel
    does not contain the body.
    """
    centres = {target: center for center, target in kernel.pairs}
    body = BODIES[name]
    chain: list[tuple[int, int]] = []
    while body in centres and body != SOLAR_SYSTEM and len(chain) < len(centres):
        chain.append((centres[body], body))
        body = centres[body]
    if not chain:
        known = ", ".join(str(target) for target in sorted(centres))
        message = (
            f"{path} does not contain the {name.title()} (body {BODIES[name]}; bodies in the kernel: "
            f"{known or 'none'}); give a kernel of the Sun, the Moon and the Earth, such as de440s.bsp"
        )
        raise EarthError(message, name="ephemeris", got=str(path), expected=name)
    return chain


def _between(
    kernel: Any, there: list[tuple[int, int]], earth: list[tuple[int, int]], path: str | Path
) -> list[Segment]:
    """Return the segments of the body minus those of the Earth, without common segments.

    Raises EarthError if the kernel does not connect the body with the Earth.
    """
    ends = {(there or earth)[-1][0], earth[-1][0]}
    if len(ends) > 1:
        message = (
            f"the segments of {path} do not connect the Earth with the body {there[0][1]}; give a kernel of "
            "the Sun, the Moon and the Earth, such as de440s.bsp"
        )
        raise EarthError(message, name="ephemeris", got=str(path))
    wanted = [(pair, 1.0) for pair in there if pair not in earth]
    wanted += [(pair, -1.0) for pair in earth if pair not in there]
    return [(sign, *_series(kernel.pairs[pair], path)) for pair, sign in wanted]


def _series(segment: Any, path: str | Path) -> tuple[float, float, NDArray[np.float64]]:
    try:
        start, length, coefficients = segment.load_array()  # days, lowest degree first
    except Exception as error:  # damaged data, or an AttributeError for another type of segment
        kind = getattr(segment, "data_type", "?")
        if kind in (2, 3):
            message = (
                f"{path}: the positions of body {segment.target} cannot be read ({error}), so the file may "
                f"be damaged; {_DOWNLOAD}"
            )
            raise ReadError(message, path=str(path), kind="SPICE kernel") from None
        message = (
            f"{path}: the segment of body {segment.target} is of SPK type {kind}; it must be of type 2 or 3 "
            "(Chebyshev polynomials); give another kernel, such as de440s.bsp"
        )
        raise EarthError(message, name="ephemeris", got=kind, expected=(2, 3)) from None
    return (
        (start - 2_451_545.0) * 86_400.0,
        length * 86_400.0,
        np.array(coefficients[:3], dtype=float, order="C"),
    )
