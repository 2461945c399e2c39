"""Paths and shapes of the columns of a trace, from the table of columns."""

from __future__ import annotations

from onorbit_rs._core import COLUMNS
from onorbit_rs.common.coordinates import BASE_NQ, BASE_NV

_PREFIXES = {
    column.path.removesuffix("*"): name for name, column in COLUMNS.items() if column.path.endswith("*")
}
"""Names of the columns of each control, effect, contact or loop, by the prefix of their paths."""


def path_of(name: str, owner: str) -> str:
    """Return the path of the column of one control, effect, contact or loop."""
    return COLUMNS[name].path.replace("*", owner)


def split_path(path: str) -> tuple[str, str | None]:
    """Return the name of the column with this path, and the name of its owner.

    The owner is a control, an effect, a contact or a loop; it is None for other columns.
    """
    for prefix, name in _PREFIXES.items():
        if path.startswith(prefix):
            return name, path.removeprefix(prefix)
    return path, None


def row_shape(name: str, joints: int) -> tuple[int, ...]:
    """Return the shape of one row of a column for a robot with ``joints`` joints.

    -1 denotes a length that the number of joints does not determine.
    """
    lengths = {"n": joints, "nq": BASE_NQ + joints, "nv": BASE_NV + joints, "bodies": joints + 1}
    return tuple(
        length if isinstance(length, int) else lengths.get(length, -1) for length in COLUMNS[name].shape[1:]
    )
