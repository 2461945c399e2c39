"""Writes the arrays of a ``.npz`` file; :mod:`onorbit_rs.output.npz_reader` reads it."""

from __future__ import annotations

import struct
import zipfile
from collections.abc import Mapping
from typing import Any, BinaryIO

import numpy as np

from onorbit_rs.common.blocks import ROWS, blocks

LOCAL_HEADER, _ZIP64_FIELD = 30, 20
"""Sizes of the local header of a member without its name, and of its ZIP64 field, bytes."""
PADDING, _PADDING_ID = struct.Struct("<HH"), 0xD935
"""Header of a field of zeros between the header and the content of a member."""
_LEVEL = 1
"""Level of the compression. Level 6 takes twice the time and saves less than 1 % more."""


def write_arrays(stream: BinaryIO, arrays: Mapping[str, Any], *, compress: bool = False) -> None:
    """Write arrays of numbers and texts as a ``.npz`` file, which :func:`numpy.load` reads.

    Long arrays are written in blocks of rows, so that arrays that are mapped from files need little memory.
    Uncompressed, the numbers of each array begin at a multiple of 8 bytes, so that they can be mapped into
    memory. With ``compress``, the arrays are compressed with deflate, as :func:`numpy.savez_compressed` does.
    """
    with zipfile.ZipFile(stream, "w", allowZip64=True) as archive:
        for name, array in arrays.items():
            file = f"{name}.npy"
            entry = _compressed(file) if compress else _aligned(file, stream.tell())
            with archive.open(entry, "w", force_zip64=True) as member:
                if np.ndim(array) == 0 or len(array) <= ROWS:
                    np.lib.format.write_array(member, np.asarray(array), allow_pickle=False)
                    continue
                header = {"descr": np.lib.format.dtype_to_descr(array.dtype), "fortran_order": False}
                np.lib.format.write_array_header_1_0(member, header | {"shape": np.shape(array)})
                for (rows,) in blocks(array):
                    member.write(np.ascontiguousarray(rows).tobytes())


def _member(name: str) -> zipfile.ZipInfo:
    """Return a member with a fixed date, so that the same arrays give the same file."""
    member = zipfile.ZipInfo(name)
    member.external_attr = 0o600 << 16
    return member


def _compressed(name: str) -> zipfile.ZipInfo:
    member = _member(name)
    member.compress_type = zipfile.ZIP_DEFLATED
    # zipfile has no public argument for the level of a member that is written in blocks before Python 3.13
    setattr(member, "_compresslevel", _LEVEL)  # noqa: B010
    return member


def _aligned(name: str, offset: int) -> zipfile.ZipInfo:
    """Return a member whose header begins at ``offset`` and whose content begins at a multiple of 8 bytes."""
    member = _member(name)
    before = offset + LOCAL_HEADER + len(name.encode()) + _ZIP64_FIELD + len(PADDING.pack(0, 0))
    padding = -before % 8
    member.extra = PADDING.pack(_PADDING_ID, padding) + bytes(padding)
    return member
