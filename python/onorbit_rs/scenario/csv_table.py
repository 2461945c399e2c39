"""Reads tables of numbers from CSV files with a header."""

from __future__ import annotations

import csv
from collections.abc import Mapping
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from onorbit_rs.common.input_files import LARGEST_TABLE, read_text
from onorbit_rs.common.suggestions import did_you_mean
from onorbit_rs.exceptions import ReadError

if TYPE_CHECKING:
    from numpy.typing import NDArray


def read_table(
    path: Path, groups: Mapping[str, tuple[str, ...]], needed: tuple[str, ...]
) -> dict[str, NDArray[np.float64]]:
    """Return the numbers in each group of columns of a CSV file; lines that start with ``#`` are comments.

    Parameters
    ----------
    path : path
        CSV file.
    groups : mapping
        Names of the columns in each group.
    needed : tuple of str
        Groups that the file must contain.

    Returns
    -------
    dict
        An array (rows, columns) for each group in the file.

    Raises
    ------
    NotFoundError
        If the file does not exist.
    ReadError
        If the file cannot be read, a required group or a column of a group is missing, a column is unknown or
        duplicate, the number of cells in a row differs from the header, or a cell is not a number. Messages
        about the content of the file contain the line.
    """
    reader = csv.reader(read_text(path, LARGEST_TABLE).splitlines())
    rows = [(reader.line_num, row) for row in reader if _is_filled(row)]
    top, header = rows[0] if rows else (1, [])
    header = [name.strip() for name in header]
    _check_header(header, groups, needed, f"{path}:{top}", path)
    numbers = [_numbers(row, len(header), f"{path}:{line}", path) for line, row in rows[1:]]
    table = np.array(numbers, dtype=np.float64).reshape(-1, len(header))
    return {
        name: np.ascontiguousarray(table[:, [header.index(column) for column in columns]])
        for name, columns in groups.items()
        if columns[0] in header
    }


def _is_filled(row: list[str]) -> bool:
    return any(cell.strip() for cell in row) and not row[0].lstrip().startswith("#")


def _check_header(
    header: list[str], groups: Mapping[str, tuple[str, ...]], needed: tuple[str, ...], where: str, path: Path
) -> None:
    known = [column for columns in groups.values() for column in columns]
    for name in header:
        if name not in known:
            raise ReadError(f"{where}: unknown column {name!r}{did_you_mean(name, known)}", path=str(path))
        if header.count(name) > 1:
            message = f"{where}: column {name!r} occurs more than once; give each column once"
            raise ReadError(message, path=str(path))
    for name, columns in groups.items():
        missing = [column for column in columns if column not in header]
        if missing and (name in needed or len(missing) < len(columns)):
            raise ReadError(
                f"{where}: the header lacks {', '.join(missing)}; give the columns {', '.join(columns)}",
                path=str(path),
            )


def _numbers(row: list[str], width: int, where: str, path: Path) -> list[float]:
    if len(row) != width:
        raise ReadError(
            f"{where}: the number of cells is {len(row)}; it must be {width}, one per column", path=str(path)
        )
    try:
        return [float(cell) for cell in row]
    except ValueError as error:
        cell = str(error).partition(": ")[2]
        message = f"{where}: {cell} is not a number; give a number in SI units, without a unit"
        raise ReadError(message, path=str(path)) from None
