"""Converts numbers given by callers, such as numpy scalars or :class:`fractions.Fraction`, to floats."""

from __future__ import annotations

import math
from numbers import Real


def finite_float(value: object) -> float | None:
    """Return a real number as a finite float; None for non-numbers, non-finite values and booleans."""
    if isinstance(value, bool) or not isinstance(value, Real):
        return None
    try:
        number = float(value)
    except OverflowError:  # an integer with 400 digits
        return None
    return number if math.isfinite(number) else None
