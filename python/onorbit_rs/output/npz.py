"""Writes and reads the arrays of a ``.npz`` file; stated sizes are checked against the size of the file."""

from __future__ import annotations

import math
import re
import struct
import zipfile
import zlib
from collections.abc import Mapping
from typing import Any, BinaryIO, Literal

import numpy as np

from onorbit_rs.common.blocks import ROWS, blocks

_CHUNK = _MAPPED = 1 << 24
_MOST_COLUMNS = 10_000
_LOCAL_HEADER, _ZIP64_FIELD = 30, 20
"""Sizes of the header of a member without its name, and of its field with sizes of 64 bits, bytes."""
_PADDING, _PADDING_ID = struct.Struct("<HH"), 0xD935
"""Header of a field of zeros between the header and the content of a member."""
_MAGIC = b"\x93NUMPY\x01\x00"
_HEADER = re.compile(
    rb"\{'descr': '(?P<kind>[<>|][biuf][1248]|<U[0-9]{1,4})', 'fortran_order': (?P<is_fortran>True|False), "
    rb"'shape': \((?P<shape>[0-9, ]{0,200})\), \} *\n"
)
"""Header that NumPy writes. NumPy parses it with ``ast``, which is not safe for untrusted input."""


def write_arrays(stream: BinaryIO, arrays: Mapping[str, Any]) -> None:
    """Write arrays of numbers and texts as an uncompressed ``.npz`` file, as :func:`numpy.savez` does.

    Long arrays are written in blocks of rows, so that arrays that are mapped from files need little memory.
    The numbers of each array begin at a multiple of 8 bytes, so that they can be mapped into memory.
    """
    with zipfile.ZipFile(stream, "w", zipfile.ZIP_STORED, allowZip64=True) as archive:
        for name, array in arrays.items():
            with archive.open(_aligned(f"{name}.npy", stream.tell()), "w", force_zip64=True) as member:
                if np.ndim(array) == 0 or len(array) <= ROWS:
                    np.lib.format.write_array(member, np.asarray(array), allow_pickle=False)
                    continue
                header = {"descr": np.lib.format.dtype_to_descr(array.dtype), "fortran_order": False}
                np.lib.format.write_array_header_1_0(member, header | {"shape": np.shape(array)})
                for (rows,) in blocks(array):
                    member.write(np.ascontiguousarray(rows).tobytes())


def _aligned(name: str, offset: int) -> zipfile.ZipInfo:
    """Return a member whose header begins at ``offset`` and whose content begins at a multiple of 8 bytes."""
    member = zipfile.ZipInfo(name)
    member.external_attr = 0o600 << 16
    before = offset + _LOCAL_HEADER + len(name.encode()) + _ZIP64_FIELD + len(_PADDING.pack(0, 0))
    padding = -before % 8
    member.extra = _PADDING.pack(_PADDING_ID, padding) + bytes(padding)
    return member


def read_arrays(stream: BinaryIO, *, trusted: bool = False) -> dict[str, Any]:
    """Return every array of a ``.npz`` file of numbers and texts, as :func:`write_arrays` writes.

    Arrays of more than 16 MB are mapped from the file, and read-only. The memory used is bounded by the size
    of the file even if its headers are wrong; nothing is unpickled. The checksums of mapped arrays are not
    computed for a ``trusted`` file, which this process has written.

    Raises
    ------
    ValueError
        If the file is not a zip of arrays of real numbers and texts, is compressed, truncated or damaged, or
        states contradictory sizes.
    """
    size = stream.seek(0, 2)
    try:
        with zipfile.ZipFile(stream) as archive:
            members = archive.infolist()
            _check_directory(members, size)
            return {
                member.filename.removesuffix(".npy"): _array(archive, member, stream, trusted)
                for member in members
            }
    except (zipfile.BadZipFile, zlib.error, NotImplementedError, EOFError, RuntimeError) as error:
        raise ValueError(str(error) or type(error).__name__) from error


def _check_directory(members: list[zipfile.ZipInfo], size: int) -> None:
    """Check that members are uncompressed, have distinct names and are in total no larger than the file."""
    names = [member.filename for member in members]
    if len(names) > _MOST_COLUMNS:
        raise ValueError(f"it has {len(names)} columns; at most {_MOST_COLUMNS} are allowed")
    if len(set(names)) < len(names):
        twice = next(name for name in names if names.count(name) > 1)
        raise ValueError(f"it contains {twice!r} more than once")
    for member in members:
        if not member.filename.endswith(".npy"):
            raise ValueError(f"it contains {member.filename!r}, which is not an array")
        if member.compress_type != zipfile.ZIP_STORED or member.compress_size != member.file_size:
            raise ValueError(f"{member.filename} is compressed, but must be uncompressed")
    total = sum(member.file_size for member in members)
    if total > size:
        raise ValueError(f"its columns have {total} bytes in total, but the file has {size}")


def _array(archive: zipfile.ZipFile, member: zipfile.ZipInfo, file: BinaryIO, trusted: bool) -> Any:
    with archive.open(member) as stream:
        magic, length = stream.read(8), int.from_bytes(stream.read(2), "little")
        header = _HEADER.fullmatch(stream.read(length))
        if magic != _MAGIC or header is None:
            raise ValueError(
                f"{member.filename} is not an array of real numbers or texts in the format that a run writes"
            )
        dtype = np.dtype(header["kind"].decode())
        shape = tuple(int(number) for number in header["shape"].split(b",") if number.strip())
        left, needed = member.file_size - 10 - length, math.prod(shape) * dtype.itemsize
        if needed != left:
            raise ValueError(
                f"{member.filename} contains {left} bytes, but its shape {shape} requires {needed}"
            )
        order: Literal["F", "C"] = "F" if header["is_fortran"] == b"True" else "C"
        start = _content_start(file, member) + 10 + length
        is_mapped = left > _MAPPED and start % 8 == 0 and hasattr(file, "name")
        content, found = bytearray(), 0
        while not (is_mapped and trusted) and (chunk := stream.read(_CHUNK)):
            found += len(chunk)  # zipfile verifies the checksum at the end of the member
            if not is_mapped:
                content += chunk
    if is_mapped and (trusted or found == left):
        return np.memmap(file, dtype, "r", start, shape, order)
    if found != left:
        raise ValueError(f"{member.filename} ends after {found} of {left} bytes")
    return np.frombuffer(content, dtype=dtype).reshape(shape, order=order)


def _content_start(file: BinaryIO, member: zipfile.ZipInfo) -> int:
    """Return the offset of the content of a member in the file."""
    position = file.tell()
    file.seek(member.header_offset + _LOCAL_HEADER - 4)
    name, extra = _PADDING.unpack(file.read(4))
    file.seek(position)
    return int(member.header_offset + _LOCAL_HEADER + name + extra)
