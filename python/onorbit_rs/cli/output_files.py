"""Checks output files that are given on the command line."""

from __future__ import annotations

import os
from pathlib import Path

from onorbit_rs.common.files import exists, file_kind, is_link, output_errors
from onorbit_rs.exceptions import InputError, OutputFolderError, OutputNotEmptyError


def check_output_file(file: Path | None, *, force: bool) -> None:
    """Check that a file can be written; called before any computation.

    Raises
    ------
    OutputNotEmptyError
        If the file exists and ``force`` is false.
    OutputFolderError
        If the file is a folder, a link or a device, or its folder does not exist or is not writable.
    """
    if file is None:
        return
    folder = file.absolute().parent
    with output_errors(file):
        if file.is_dir():
            raise OutputFolderError(f"cannot write {file}: it is a folder; give a file", path=str(file))
        if is_link(file) or (file.exists() and not file.is_file()):
            raise OutputFolderError(
                f"cannot write {file}: it is {file_kind(file)}; give a regular file", path=str(file)
            )
        if exists(file) and not force:
            raise OutputNotEmptyError(f"{file} already exists; replace it with --force", path=str(file))
        if not folder.is_dir():
            message = f"cannot write {file}: the folder {folder} does not exist; create it first"
            raise OutputFolderError(message, path=str(file))
        if not os.access(folder, os.W_OK):
            message = f"cannot write {file}: the folder {folder} is not writable; choose another folder"
            raise OutputFolderError(message, path=str(file))


def check_bag_file(option: str, file: Path | None, suffix: str, *, force: bool) -> None:
    """Check that a bag can be written, and has the suffix by which readers recognise its format.

    Raises
    ------
    InputError
        If the file has another suffix.
    OutputNotEmptyError, OutputFolderError
        As for :func:`check_output_file`.
    """
    if file is not None and file.suffix != suffix:
        raise InputError(
            f"{option}: the file name {file} must end in {suffix}, by which readers recognise the format",
            name=option.lstrip("-"), got=file.suffix, expected=suffix,
        )  # fmt: skip
    check_output_file(file, force=force)
