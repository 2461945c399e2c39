"""Files that an orbit is read from: points of a path, element sets."""

from __future__ import annotations

import csv
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from onorbit_rs.exceptions import ElementSetError, NotFoundError, PathError, ReadError

if TYPE_CHECKING:
    from numpy.typing import NDArray

GROUPS = {
    "times": ("t",),
    "positions": ("x", "y", "z"),
    "velocities": ("vx", "vy", "vz"),
    "accelerations": ("ax", "ay", "az"),
    "attitudes": ("qx", "qy", "qz", "qw"),
}
"""Columns of a file of points; SI."""


def read_text(file: Path) -> str:
    """A small text file; raises ``NotFoundError`` or ``ReadError``."""
    try:
        return file.read_text(encoding="utf-8-sig")
    except FileNotFoundError:
        raise NotFoundError(f"no such file: {file}", path=str(file), kind="file") from None
    except (OSError, UnicodeDecodeError) as error:
        why = "is no UTF-8 text" if isinstance(error, UnicodeDecodeError) else error.strerror
        raise ReadError(f"{file} cannot be read: {why}", path=str(file), kind="file") from None


def two_lines(text: str, where: str) -> tuple[str, str]:
    """The two lines of a TLE; a name may stand before them, comments (#) and blank lines anywhere."""
    lines = [line for line in text.splitlines() if line.strip() and not line.startswith("#")]
    if len(lines) == 3:
        lines = lines[1:]
    if len(lines) != 2:
        raise ElementSetError(
            f"{where} holds {len(lines)} lines: give the two lines of one TLE, with a name before them or not"
        )
    return lines[0], lines[1]


def read_points(file: Path) -> dict[str, NDArray[np.float64]]:
    """Points of a path from a CSV file with a header, by the names of :class:`onorbit_rs.CustomPath`.

    Raises
    ------
    PathError
        An unknown or missing column, a row of another length, something that is no number; says the line.
    """
    rows = csv.reader(read_text(file).splitlines())
    header = [name.strip() for name in next(rows, [])]
    _check_header(header, file)
    values = []
    for row in rows:
        if not any(cell.strip() for cell in row):
            continue
        if len(row) != len(header):
            raise PathError(f"{file}:{rows.line_num}: {len(row)} cells under {len(header)} columns")
        try:
            values.append([float(cell) for cell in row])
        except ValueError as error:
            raise PathError(f"{file}:{rows.line_num}: {error}; a bare number in SI is needed") from None
    table = np.array(values, dtype=np.float64).reshape(-1, len(header))
    points = {}
    for name, columns in GROUPS.items():
        if columns[0] in header:
            points[name] = np.ascontiguousarray(table[:, [header.index(column) for column in columns]])
    return points | {"times": points["times"][:, 0].copy()}


def _check_header(header: list[str], file: Path) -> None:
    known = [column for columns in GROUPS.values() for column in columns]
    unknown = [name for name in header if name not in known]
    if unknown or len(set(header)) != len(header):
        what = f"unknown column {unknown[0]!r}" if unknown else "a column is named twice"
        raise PathError(f"{file}:1: {what}; the header is t,x,y,z[,vx,vy,vz[,ax,ay,az]][,qx,qy,qz,qw]")
    for name, columns in GROUPS.items():
        there = [column in header for column in columns]
        if not all(there) and (any(there) or name in ("times", "positions")):
            missing = ", ".join(column for column in columns if column not in header)
            raise PathError(f"{file}:1: {name} need the columns {', '.join(columns)}; missing: {missing}")
