"""Reads the arrays of a ``.npz`` file; stated sizes are checked against the size of the file."""

from __future__ import annotations

import errno
import math
import re
import shutil
import tempfile
import zipfile
import zlib
from typing import Any, BinaryIO, Literal

import numpy as np

from onorbit_rs.output.npz import LOCAL_HEADER, PADDING

_CHUNK = 1 << 22
_MAPPED = 1 << 24
"""Size of an array, bytes, above which it is mapped from a file."""
_MAPPED_TRUSTED = 1 << 18
"""Size of an array, bytes, above which it is mapped from a file that this process has written.

The checksums of such arrays are not computed.
"""
_MOST_EXPANDED = 1 << 28
"""Size of the compressed arrays in memory, bytes, above which all further arrays are mapped from files."""
_MOST_RATIO = 1032
"""Largest ratio of the sizes before and after compression with deflate."""
_MOST_COLUMNS = 10_000
_MAGIC = b"\x93NUMPY\x01\x00"
_HEADER = re.compile(
    rb"\{'descr': '(?P<kind>[<>|][biuf][1248]|<U[0-9]{1,4})', 'fortran_order': (?P<is_fortran>True|False), "
    rb"'shape': \((?P<shape>[0-9, ]{0,200})\), \} *\n"
)
"""Header that NumPy writes. NumPy parses it with ``ast``, which is not safe for untrusted input."""


def read_arrays(stream: BinaryIO, *, trusted: bool = False) -> dict[str, Any]:
    """Return every array of a ``.npz`` file of numbers and texts, uncompressed or compressed with deflate.

    Arrays of more than 16 MB (256 kB if ``trusted``) are mapped from the file, and read-only. If they are
    compressed, they are written to temporary files, which are mapped and have no name. The memory used is
    bounded by the size of the file, or by 256 MB for a compressed file, even if its headers are wrong;
    nothing is unpickled. The checksums of arrays that are mapped from a ``trusted`` file, which this process
    has written, are not computed.

    Raises
    ------
    ValueError
        If the file is not a zip of arrays of real numbers and texts, is compressed by a method other
        than deflate, truncated or damaged, or states contradictory sizes.
    OSError
        If the folder of temporary files has too little space.
    """
    size = stream.seek(0, 2)
    try:
        with zipfile.ZipFile(stream) as archive:
            members = archive.infolist()
            _check_directory(members, size)
            reader = _Reader(archive, stream, trusted)
            return {member.filename.removesuffix(".npy"): reader.array(member) for member in members}
    except (zipfile.BadZipFile, zlib.error, NotImplementedError, EOFError, RuntimeError) as error:
        raise ValueError(str(error) or type(error).__name__) from error


def _check_directory(members: list[zipfile.ZipInfo], size: int) -> None:
    """Check that members have distinct names and possible sizes, and in total fit into the file."""
    names = [member.filename for member in members]
    if len(names) > _MOST_COLUMNS:
        raise ValueError(f"it has {len(names)} columns; at most {_MOST_COLUMNS} are allowed")
    if len(set(names)) < len(names):
        twice = next(name for name in names if names.count(name) > 1)
        raise ValueError(f"it contains {twice!r} more than once")
    for member in members:
        name, stored, expanded = member.filename, member.compress_size, member.file_size
        if not name.endswith(".npy"):
            raise ValueError(f"it contains {name!r}, which is not an array")
        if member.compress_type not in (zipfile.ZIP_STORED, zipfile.ZIP_DEFLATED):
            raise ValueError(
                f"{name} is compressed by method {member.compress_type} of the zip format; arrays must be "
                "uncompressed, or compressed with deflate as by numpy.savez_compressed"
            )
        most = _MOST_RATIO * stored if _is_compressed(member) else stored
        if expanded > most or (not _is_compressed(member) and expanded < stored):
            raise ValueError(
                f"{name} states {expanded} bytes, which is impossible for its {stored} bytes in the file"
            )
    total = sum(member.compress_size for member in members)
    if total > size:
        raise ValueError(f"its columns have {total} bytes in total, but the file has {size}")


def _is_compressed(member: zipfile.ZipInfo) -> bool:
    return member.compress_type == zipfile.ZIP_DEFLATED


class _Reader:
    """Reads the members of one file, and counts the bytes of compressed members in memory."""

    def __init__(self, archive: zipfile.ZipFile, file: BinaryIO, trusted: bool) -> None:
        self._archive, self._file, self._trusted = archive, file, trusted
        self._expanded = 0

    def array(self, member: zipfile.ZipInfo) -> Any:
        """Return the array of a member, which has passed the checks of the directory."""
        with self._archive.open(member) as stream:
            magic, length = stream.read(8), int.from_bytes(stream.read(2), "little")
            header = _HEADER.fullmatch(stream.read(length))
            if magic != _MAGIC or header is None:
                raise ValueError(
                    f"{member.filename} is not an array of real numbers or texts in the format that a run "
                    "writes"
                )
            dtype = np.dtype(header["kind"].decode())
            shape = tuple(int(number) for number in header["shape"].split(b",") if number.strip())
            left, needed = member.file_size - 10 - length, math.prod(shape) * dtype.itemsize
            if needed != left:
                raise ValueError(
                    f"{member.filename} contains {left} bytes, but its shape {shape} requires {needed}"
                )
            order: Literal["F", "C"] = "F" if header["is_fortran"] == b"True" else "C"
            if _is_compressed(member):
                return self._expanded_array(stream, member.filename, left, dtype, shape, order)
            start = _content_start(self._file, member) + 10 + length
            least = _MAPPED_TRUSTED if self._trusted else _MAPPED
            if left > least and start % 8 == 0 and hasattr(self._file, "name"):
                if not self._trusted:
                    _copy(stream, None, member.filename, left)  # verifies the checksum
                return np.memmap(self._file, dtype, "r", start, shape, order)
            return _in_memory(stream, member.filename, left, dtype, shape, order)

    def _expanded_array(
        self, stream: Any, name: str, size: int, dtype: Any, shape: tuple[int, ...], order: Literal["F", "C"]
    ) -> Any:
        """Return the array of a compressed member; a large one is mapped from a temporary file."""
        if size <= _MAPPED and self._expanded + size <= _MOST_EXPANDED:
            self._expanded += size
            return _in_memory(stream, name, size, dtype, shape, order)
        folder = tempfile.gettempdir()
        free = shutil.disk_usage(folder).free
        if size > free:
            raise OSError(
                errno.ENOSPC,
                f"{name} is compressed and needs {size} bytes in {folder}, the folder of temporary files, "
                f"which has {free}; set the environment variable TMPDIR to a folder with more space",
            )
        with tempfile.TemporaryFile() as file:  # the mapping keeps the content until the array is deleted
            _copy(stream, file, name, size)
            file.flush()
            return np.memmap(file, dtype, "r", 0, shape, order)


def _in_memory(
    stream: Any, name: str, size: int, dtype: Any, shape: tuple[int, ...], order: Literal["F", "C"]
) -> Any:
    content = bytearray()
    _copy(stream, content, name, size)
    return np.frombuffer(content, dtype=dtype).reshape(shape, order=order)


def _copy(stream: Any, to: Any, name: str, size: int) -> None:
    """Copy the rest of a member to a bytearray or a file, if given; zipfile verifies its checksum.

    Raises ValueError if the member does not have ``size`` bytes.
    """
    found = 0
    while chunk := stream.read(_CHUNK):
        found += len(chunk)
        if isinstance(to, bytearray):
            to += chunk
        elif to is not None:
            to.write(chunk)
    if found != size:
        raise ValueError(f"{name} ends after {found} of {size} bytes")


def _content_start(file: BinaryIO, member: zipfile.ZipInfo) -> int:
    """Return the offset of the content of a member in the file."""
    position = file.tell()
    file.seek(member.header_offset + LOCAL_HEADER - 4)
    name, extra = PADDING.unpack(file.read(4))
    file.seek(position)
    return int(member.header_offset + LOCAL_HEADER + name + extra)
