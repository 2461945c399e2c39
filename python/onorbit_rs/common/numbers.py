"""Converts numbers given by callers, such as numpy scalars or :class:`fractions.Fraction`, to floats.

Also writes floats in messages without rounding them.
"""

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


def shortest(number: float) -> str:
    """Return the shortest text that converts back to the same float; whole numbers have no decimal point.

    >>> shortest(0.1), shortest(100), shortest(100.00001)
    ('0.1', '100', '100.00001')
    """
    return repr(float(number)).removesuffix(".0")
