"""Arrays of a ``.npz``, read only after the sizes that it states were checked against the file itself."""

from __future__ import annotations

import math
import zipfile
import zlib
from typing import Any, BinaryIO

import numpy as np
from numpy.lib import format as npy

_CHUNK = 1 << 24
_MOST_COLUMNS = 10_000


def read_arrays(stream: BinaryIO) -> dict[str, Any]:
    """Every array of numbers in an uncompressed ``.npz``, as :func:`numpy.savez` writes it.

    No more memory is taken than the file has bytes, whatever its headers say; nothing is unpickled.

    Raises
    ------
    ValueError
        It is no such file: no zip, compressed, cut, damaged, or sizes that contradict each other.
    """
    size = stream.seek(0, 2)
    try:
        with zipfile.ZipFile(stream) as archive:
            members = archive.infolist()
            _check_directory(members, size)
            return {member.filename.removesuffix(".npy"): _array(archive, member) for member in members}
    except (zipfile.BadZipFile, zlib.error, NotImplementedError, EOFError, RuntimeError) as error:
        raise ValueError(str(error) or type(error).__name__) from error


def _check_directory(members: list[zipfile.ZipInfo], size: int) -> None:
    """Before anything is read: plain copies, no name twice, together no larger than the file."""
    names = [member.filename for member in members]
    if len(names) > _MOST_COLUMNS or len(set(names)) < len(names):
        raise ValueError("it has too many columns, or one twice")
    for member in members:
        if not member.filename.endswith(".npy"):
            raise ValueError(f"it holds {member.filename!r}, which is no array")
        if member.compress_type != zipfile.ZIP_STORED or member.compress_size != member.file_size:
            raise ValueError(f"{member.filename} is compressed; a run writes its trace uncompressed")
    if sum(member.file_size for member in members) > size:
        raise ValueError("its columns are larger than the file")


def _array(archive: zipfile.ZipFile, member: zipfile.ZipInfo) -> Any:
    with archive.open(member) as stream:
        version = npy.read_magic(stream)
        if version == (1, 0):
            shape, is_fortran, dtype = npy.read_array_header_1_0(stream)
        elif version == (2, 0):
            shape, is_fortran, dtype = npy.read_array_header_2_0(stream)
        else:
            raise ValueError(f"{member.filename} has format {version} of numpy, which no run writes")
        if dtype.kind not in "biuf" or min(shape, default=0) < 0:
            raise ValueError(f"{member.filename} holds {dtype}, not real numbers")
        count = math.prod(shape)
        left = member.file_size - stream.tell()
        if count * dtype.itemsize != left:
            raise ValueError(f"{member.filename} has {left} bytes, its shape {shape} takes {count * dtype.itemsize}")
        content = bytearray()
        while chunk := stream.read(_CHUNK):
            content += chunk
    if len(content) != left:
        raise ValueError(f"{member.filename} is cut")
    return np.frombuffer(content, dtype=dtype).reshape(shape, order="F" if is_fortran else "C")
