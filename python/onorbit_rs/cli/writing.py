"""Files that commands write where their users say."""

from __future__ import annotations

import os
from pathlib import Path

from onorbit_rs.exceptions import OutputFolderError, OutputNotEmptyError
from onorbit_rs.files import described, exists, is_link, refusals


def claim(file: Path | None, *, force: bool) -> None:
    """Refuse early, before anything is worked out, where the file could not be written.

    Raises
    ------
    OutputNotEmptyError
        It is there, and may not be replaced.
    OutputFolderError
        Its folder is not there, it is one, a link or a device, or it may not be written.
    """
    if file is None:
        return
    folder = file.absolute().parent
    with refusals(file):
        if file.is_dir():
            raise OutputFolderError(f"cannot write {file}: it is a folder, name a file in it", path=str(file))
        if is_link(file) or (file.exists() and not file.is_file()):
            raise OutputFolderError(
                f"cannot write {file}: it is {described(file)}, name a regular file", path=str(file)
            )
        if exists(file) and not force:
            raise OutputNotEmptyError(f"{file} is there already; replace it with --force", path=str(file))
        if not folder.is_dir():
            raise OutputFolderError(f"cannot write {file}: no such folder", path=str(file))
        if not os.access(folder, os.W_OK):
            raise OutputFolderError(f"cannot write {file}: its folder is not yours to write", path=str(file))
