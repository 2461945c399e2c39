"""Columns of numbers from a CSV with a header."""

from __future__ import annotations

import csv
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from onorbit_rs.exceptions import NotFoundError, ReadError
from onorbit_rs.names import did_you_mean

if TYPE_CHECKING:
    from numpy.typing import NDArray


def read_columns(
    path: Path, needed: tuple[str, ...], optional: tuple[str, ...], *, all_or_none: bool = True
) -> tuple[list[str], NDArray[np.float64]]:
    """Names and numbers (K, columns): the needed columns first, then the optional ones that are there.

    Raises
    ------
    NotFoundError
        No such file.
    ReadError
        A column that is missing or unknown, or a cell that is no number; says where.
    """
    try:
        text = path.read_text(encoding="utf-8-sig")
    except FileNotFoundError:
        raise NotFoundError(f"no such file: {path}", path=str(path), kind="table") from None
    except (OSError, UnicodeDecodeError) as error:
        raise ReadError(f"{path} cannot be read: {error}", path=str(path)) from None
    rows = [row for row in csv.reader(text.splitlines()) if row and not row[0].lstrip().startswith("#")]
    header = [name.strip() for name in rows[0]] if rows else []
    for name in header:
        if name not in (*needed, *optional):
            hint = did_you_mean(name, [*needed, *optional])
            raise ReadError(f"{path}: unknown column {name!r}{hint}", path=str(path))
    wanted = [*needed, *(name for name in optional if name in header)]
    short = [name for name in needed if name not in header]
    if all_or_none and len(wanted) > len(needed):
        short += [name for name in optional if name not in header]
    if short or len(set(header)) < len(header):
        what = f"has no column {', '.join(map(repr, short))}" if short else "names a column twice"
        raise ReadError(f"{path}: the header {what}; it is {','.join(header)}", path=str(path))
    return wanted, np.array(
        [_numbers(path, line, row, header, wanted) for line, row in enumerate(rows[1:], 2)]
    )


def _numbers(path: Path, line: int, row: list[str], header: list[str], wanted: list[str]) -> list[float]:
    if len(row) != len(header):
        raise ReadError(f"{path}: row {line} has {len(row)} cells, the header {len(header)}", path=str(path))
    try:
        return [float(row[header.index(name)]) for name in wanted]
    except ValueError as error:
        raise ReadError(f"{path}: row {line}: {error}", path=str(path)) from None
