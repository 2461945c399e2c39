"""Numbers and units as labels tell them: round, with prefixes that fit, those of joints by their kind."""

from __future__ import annotations

import math
from collections.abc import Iterable
from typing import NamedTuple

_PREFIXES = ((1e-12, "p"), (1e-9, "n"), (1e-6, "µ"), (1e-3, "m"), (1.0, ""), (1e3, "k"), (1e6, "M"))

ROUNDING = 1e-12
"""Of SI units, and as a share of what a number was taken from: what is smaller says nothing."""
ROUNDING_DEG = 1e-9
"""Of angles, whose errors add up over a run."""
OR = " or "
"""Between two units of one label, which take no common prefix."""


def with_prefix(peak: float, unit: str) -> tuple[float, str]:
    """Factor and unit such that values up to ``peak`` read between 1 and 1000: ``(1e6, "µm")``."""
    scale, prefix = 1.0, ""
    if math.isfinite(peak) and peak > 0.0:
        fitting = [entry for entry in _PREFIXES if entry[0] <= peak * (1.0 + 1e-9)] or [_PREFIXES[0]]
        scale, prefix = fitting[-1]
    return 1.0 / scale, prefix + unit


def degrees_with_prefix(peak: float, unit: str = "deg") -> tuple[float, str]:
    """As :func:`with_prefix`, of degrees: plain from a hundredth on, and below :data:`ROUNDING_DEG`."""
    return with_prefix(peak, unit) if ROUNDING_DEG <= peak < 0.01 else (1.0, unit)


def digits(value: float) -> str:
    """Four digits, and the whole number from ten thousand to ten million."""
    return f"{value:.0f}" if 1e4 <= abs(value) < 1e7 else f"{value:.4g}"


def amount(value: float, unit: str) -> str:
    """``2e-6``, ``N`` as ``2 µN``."""
    factor, scaled = with_prefix(value, unit)
    return f"{factor * value:.3g} {scaled}"


def round_up(value: float) -> float:
    """To 1, 2 or 5 times a power of ten; what has no such number above it stays as it is."""
    if not 0.0 < value < math.inf:
        return 0.0 if value <= 0.0 else value
    power = 10.0 ** math.floor(math.log10(value))
    steps = (step * power for step in (1.0, 2.0, 5.0, 10.0))
    return next((step for step in steps if value * (1.0 - 1e-12) <= step < math.inf), value)


class JointUnits(NamedTuple):
    """Of joints: positions and their errors, rates, efforts."""

    position: str
    rate: str
    effort: str


_OF_KINDS = (JointUnits("rad", "rad/s", "N m"), JointUnits("m", "m/s", "N"))


def joint_units(kinds: Iterable[str]) -> JointUnits:
    """Of joints of these kinds: rad, m where they slide, ``rad or m`` where both or none is known."""
    slides = {kind == "prismatic" for kind in kinds} or {False, True}
    found = [_OF_KINDS[index] for index in sorted(slides)]
    return JointUnits(*(OR.join(parts) for parts in zip(*found, strict=True)))
