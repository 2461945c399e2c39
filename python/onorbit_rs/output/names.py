"""Names of joints and bodies in ``trace.npz``."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING, Any

import numpy as np

if TYPE_CHECKING:
    from onorbit_rs._core import Model

NAMES = ("joint_names", "body_names")
"""Arrays of texts in ``trace.npz``: joints in the order of ``tau``, bodies in that of ``wrenches``."""


def names_of(model: Model, prefix: str = "") -> dict[str, Any]:
    """Return the names of the joints and bodies of a robot as arrays of text, by path."""
    return {f"{prefix}{kind}": np.array(list(getattr(model, kind)), dtype=np.str_) for kind in NAMES}


def split_names(arrays: Mapping[str, Any]) -> tuple[dict[str, Any], dict[str, list[str]]]:
    """Return the columns of ``trace.npz``, and the names of joints and bodies by path.

    Raises
    ------
    ValueError
        If an array of names contains numbers, or any other array contains texts.
    """
    columns, names = {}, {}
    for path, rows in arrays.items():
        is_text, are_names = rows.dtype.kind == "U", path.rpartition("/")[2] in NAMES
        if is_text != are_names:
            kinds = ("numbers", "texts")
            raise ValueError(f"column {path!r} has {kinds[is_text]}; expected {kinds[are_names]}")
        if is_text:
            names[path] = [str(name) for name in rows.flat]
        else:
            columns[path] = rows
    return columns, names
