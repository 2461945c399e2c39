"""Reads files up to a size limit, and replaces them atomically without following links."""

from __future__ import annotations

import errno
import hashlib
import os
import secrets
import stat
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from pathlib import Path
from typing import BinaryIO

from onorbit_rs.exceptions import OnOrbitError, OutputFolderError

_NO_LINK = getattr(os, "O_NOFOLLOW", 0) | getattr(os, "O_CLOEXEC", 0) | getattr(os, "O_BINARY", 0)
_READ = os.O_RDONLY | getattr(os, "O_NONBLOCK", 0) | getattr(os, "O_CLOEXEC", 0) | getattr(os, "O_BINARY", 0)
_CHUNK = 1 << 20


def open_to_read(file: Path) -> BinaryIO:
    """Open a regular file; raise OSError for anything else (folder, device, pipe) without blocking."""
    try:
        descriptor = os.open(file, _READ)
    except FileNotFoundError:
        if is_link(file):
            raise OSError(
                errno.EINVAL, "it is a symbolic link whose target does not exist", str(file)
            ) from None
        raise
    try:
        mode = os.fstat(descriptor).st_mode
        if not stat.S_ISREG(mode):
            what = "a folder" if stat.S_ISDIR(mode) else "a pipe or a device"
            raise OSError(errno.EINVAL, f"it is {what}, but must be a regular file", str(file))
        return os.fdopen(descriptor, "rb")
    except BaseException:
        os.close(descriptor)
        raise


def read_bounded(stream: BinaryIO, most: int) -> bytes:
    """Return the content of a stream; raise ValueError if it has more than ``most`` bytes."""
    size = os.fstat(stream.fileno()).st_size
    content = b"" if size > most else stream.read(size + 1)
    if size < len(content) <= most:  # the file has grown since its size was read
        content += stream.read(most + 1 - len(content))
    if max(size, len(content)) > most:
        raise ValueError(f"it has more than {most} bytes, the largest permitted size")
    return content


def open_to_change(file: Path) -> BinaryIO:
    """Open a regular file for reading and writing, or create it if missing.

    Raise OSError for a folder, a device, a symbolic link or a file with several hard links.
    """
    descriptor = os.open(file, os.O_RDWR | os.O_CREAT | _NO_LINK | getattr(os, "O_NONBLOCK", 0), 0o666)
    try:
        found = os.fstat(descriptor)
        if not stat.S_ISREG(found.st_mode) or found.st_nlink > 1 or is_link(file):
            raise OSError(errno.EINVAL, "it is a link, or not a regular file; remove it", str(file))
        return os.fdopen(descriptor, "r+b", buffering=0)
    except BaseException:
        os.close(descriptor)
        raise


def create(file: Path) -> None:
    """Create an empty file; raise OSError if the path exists, even as a link without a target."""
    os.close(os.open(file, os.O_WRONLY | os.O_CREAT | os.O_EXCL | _NO_LINK, 0o666))


def exists(path: Path) -> bool:
    """Return whether the path exists; a link without a target counts as existing."""
    return os.path.lexists(path)


def is_link(path: Path) -> bool:
    """Return whether the path is a symbolic link or a Windows junction."""
    return path.is_symlink() or bool(getattr(os.path, "isjunction", lambda _: False)(path))


def is_regular(path: Path) -> bool:
    """Return whether the path is a regular file and not a link to one."""
    try:
        return stat.S_ISREG(path.lstat().st_mode)
    except OSError:
        return False


def file_kind(path: Path) -> str:
    """Return the kind of a path for messages, such as ``a symbolic link`` or ``a folder``."""
    if is_link(path):
        return "a symbolic link"
    return "a folder" if path.is_dir() else "a file" if is_regular(path) else "a pipe or a device"


def is_real_folder(path: Path) -> bool:
    """Return whether the path is a folder and not a link to one."""
    return path.is_dir() and not is_link(path)


def remove(file: Path) -> None:
    """Remove a regular file; folders, links and other kinds of file are kept."""
    if is_regular(file):
        file.unlink(missing_ok=True)


def sync(file: Path) -> None:
    """Flush the content of a file to the disk."""
    descriptor = os.open(file, os.O_RDWR | _NO_LINK)  # Windows syncs only writable files
    try:
        os.fsync(descriptor)
    finally:
        os.close(descriptor)


def sync_folder(folder: Path) -> None:
    """Flush the entries of a folder to the disk, if the system supports it."""
    with suppress(OSError):  # Windows, some network folders
        descriptor = os.open(folder, os.O_RDONLY)
        try:
            os.fsync(descriptor)
        finally:
            os.close(descriptor)


def sha256_of(stream: BinaryIO) -> str:
    """Return the SHA-256 of the rest of a stream, in hexadecimal."""
    digest = hashlib.sha256()
    while chunk := stream.read(_CHUNK):
        digest.update(chunk)
    return digest.hexdigest()


@contextmanager
def replacing(file: Path) -> Iterator[Path]:
    """Yield a temporary path that replaces ``file`` after the block; its folder must exist.

    Raises
    ------
    OutputFolderError
        If the file cannot be written, or is a link, a folder, a pipe or a device.
    """
    with output_errors(file):
        if exists(file) and not is_regular(file):
            raise OSError(errno.EINVAL, f"it is {file_kind(file)}; give a regular file")
        temporary = file.with_name(f".partial-{secrets.token_hex(8)}")
        with renamed(temporary, file):
            yield temporary
        sync_folder(file.parent)


@contextmanager
def renamed(temporary: Path, file: Path) -> Iterator[None]:
    """Create a temporary file that replaces ``file`` after the block, or is removed if the block fails."""
    try:
        with partial(temporary):
            yield
        temporary.replace(file)
    finally:  # includes Ctrl-C
        temporary.unlink(missing_ok=True)


@contextmanager
def partial(temporary: Path) -> Iterator[None]:
    """Create a temporary file that is flushed to the disk after the block, or removed if the block fails."""
    create(temporary)
    try:
        yield
        sync(temporary)
    except BaseException:  # Ctrl-C included
        temporary.unlink(missing_ok=True)
        raise


@contextmanager
def output_errors(file: Path) -> Iterator[None]:
    """Convert operating-system errors in the block to :class:`OutputFolderError`, which names ``file``."""
    try:
        yield
    except OSError as error:
        if isinstance(error, OnOrbitError):
            raise
        raise OutputFolderError(f"cannot write {file}: {error.strerror or error}", path=str(file)) from error
