"""Files that commands write where their users say."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

from onorbit_rs.exceptions import OnOrbitError, OutputFolderError, OutputNotEmptyError


def claim(file: Path | None, *, force: bool) -> None:
    """Refuse early, before anything is worked out, where the file could not be written.

    Raises
    ------
    OutputNotEmptyError
        It is there, and may not be replaced.
    OutputFolderError
        Its folder is not there, or it is one.
    """
    if file is None:
        return
    if file.is_dir():
        raise OutputFolderError(f"cannot write {file}: it is a folder, name a file in it", path=str(file))
    if file.exists() and not force:
        raise OutputNotEmptyError(f"{file} is there already; replace it with --force", path=str(file))
    if not file.absolute().parent.is_dir():
        raise OutputFolderError(f"cannot write {file}: no such folder", path=str(file))


@contextmanager
def writing(file: Path) -> Iterator[None]:
    """Around what writes the file.

    Raises
    ------
    OutputFolderError
        It cannot be written.
    """
    try:
        yield
    except OSError as error:
        if isinstance(error, OnOrbitError):
            raise
        reason = error.strerror or error
        raise OutputFolderError(f"cannot write {file}: {reason}", path=str(file)) from error
