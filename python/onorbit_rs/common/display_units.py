"""Rounded numbers and units with SI prefixes for display, and the units of joints by their kind."""

from __future__ import annotations

import math
from collections.abc import Iterable
from typing import NamedTuple

from onorbit_rs._core import COLUMNS

_PREFIXES = ((1e-12, "p"), (1e-9, "n"), (1e-6, "µ"), (1e-3, "m"), (1.0, ""), (1e3, "k"), (1e6, "M"))

ROUNDING = 1e-12
"""Magnitude, in SI units or relative to the operands, below which a number is rounding error."""
ROUNDING_DEG = 1e-9
"""Angle, degrees, below which a value is rounding error; these errors accumulate over a run."""
OR = " or "
"""Separator between the two units of a label such as ``rad or m``; such labels take no SI prefix."""


def with_prefix(peak: float, unit: str) -> tuple[float, str]:
    """Return the factor and the unit, such as ``(1e6, "µm")``, that scale ``peak`` to between 1 and 1000.

    Prefixes range from p to M, so peaks below 1e-12 or above 1e9 remain outside these limits. A peak that is
    not positive and finite gets no prefix.
    """
    scale, prefix = 1.0, ""
    if math.isfinite(peak) and peak > 0.0:
        fitting = [entry for entry in _PREFIXES if entry[0] <= peak * (1.0 + 1e-9)] or [_PREFIXES[0]]
        scale, prefix = fitting[-1]
    return 1.0 / scale, prefix + unit


def degrees_with_prefix(peak: float, unit: str = "deg") -> tuple[float, str]:
    """Return the factor and unit of an angle; only peaks of :data:`ROUNDING_DEG` to 0.01 deg get a prefix."""
    return with_prefix(peak, unit) if ROUNDING_DEG <= peak < 0.01 else (1.0, unit)


def digits(value: float) -> str:
    """Return a number as text with four significant digits; magnitudes from 1e4 to 1e7 become integers."""
    return f"{value:.0f}" if 1e4 <= abs(value) < 1e7 else f"{value:.4g}"


def amount(value: float, unit: str) -> str:
    """Return a number with an SI prefix and its unit: ``2 µN`` for ``2e-6`` and ``N``."""
    factor, scaled = with_prefix(value, unit)
    return f"{factor * value:.3g} {scaled}"


def round_up(value: float) -> float:
    """Return ``value`` rounded up to 1, 2 or 5 times a power of ten.

    Values that are not positive become 0; infinity and NaN are returned unchanged.
    """
    if not 0.0 < value < math.inf:
        return 0.0 if value <= 0.0 else value
    power = 10.0 ** math.floor(math.log10(value))
    steps = (step * power for step in (1.0, 2.0, 5.0, 10.0))
    return next((step for step in steps if value * (1.0 - 1e-12) <= step < math.inf), value)


class JointUnits(NamedTuple):
    """Units of joint positions and their errors, of rates and of efforts."""

    position: str
    rate: str
    effort: str


_ALL = (COLUMNS["q"].parts["joints"][1], COLUMNS["v"].parts["joints"][1], COLUMNS["tau"].unit)
_REVOLUTE, _PRISMATIC = (JointUnits(*units) for units in zip(*(unit.split(OR) for unit in _ALL), strict=True))


def joint_units(kinds: Iterable[str]) -> JointUnits:
    """Return the units of joints of these kinds; ``rad or m`` for mixed kinds or none."""
    found = {kind == "prismatic" for kind in kinds}
    return (_PRISMATIC if found.pop() else _REVOLUTE) if len(found) == 1 else JointUnits(*_ALL)
