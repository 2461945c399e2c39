"""Processes long columns, which may be files mapped into memory, in blocks of rows."""

from __future__ import annotations

import mmap
from collections.abc import Callable, Iterator
from typing import TYPE_CHECKING, Any

import numpy as np

if TYPE_CHECKING:
    from numpy.typing import NDArray

    Floats = NDArray[np.float64]

ROWS = 1 << 15
"""Number of rows in a block."""


def blocks(*columns: Any) -> Iterator[tuple[Floats, ...]]:
    """Yield the rows of columns with the same number of rows, ``ROWS`` at a time.

    The memory of rows that come from a file is released after each block.
    """
    for start in range(0, len(columns[0]), ROWS):
        yield tuple(np.asarray(column[start : start + ROWS]) for column in columns)
        for column in columns:
            release(column)


def largest(function: Callable[..., Floats], *columns: Any) -> Any:
    """Return the largest value of ``function``, which maps rows to one value or several values per row.

    For several values per row, (T, n), the result is the largest value of each column, (n,). NaN counts as
    largest.
    """
    return np.max([np.max(function(*rows), axis=0) for rows in blocks(*columns)], axis=0)


def release(column: Any) -> None:
    """Release the memory of a column that is mapped from a file; its values are read again on access."""
    mapped = getattr(column, "_mmap", None)
    if mapped is not None and hasattr(mmap, "MADV_DONTNEED"):
        mapped.madvise(mmap.MADV_DONTNEED)
