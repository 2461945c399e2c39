"""Numbers that callers give: Python's, numpy's, fractions."""

from __future__ import annotations

import math
from numbers import Real


def real(value: object) -> float | None:
    """A finite number as a float; None where it is none, and for a truth, which is one to Python alone."""
    if isinstance(value, bool) or not isinstance(value, Real):
        return None
    try:
        number = float(value)
    except OverflowError:  # a whole one of 400 digits
        return None
    return number if math.isfinite(number) else None
