"""Errors for output folders and files that must not be overwritten or cannot be written."""

from __future__ import annotations

from pathlib import Path

from onorbit_rs.common.files import file_kind, is_regular
from onorbit_rs.exceptions import OutputNotEmptyError, OutputNotWritableError
from onorbit_rs.output.manifest import MANIFEST


def not_empty(folder: Path) -> OutputNotEmptyError:
    """Return the error for a folder that contains files."""
    return OutputNotEmptyError(
        f"the output folder {folder} is not empty; choose another folder, or replace its run with --force "
        "(force=True)",
        path=str(folder),
    )


def foreign(file: Path) -> OutputNotEmptyError:
    """Return the error for a file that was not written by a run, or for a link, a pipe or a folder."""
    is_file = is_regular(file)
    what = "already exists" if is_file else f"is {file_kind(file)}"
    why = f"and {MANIFEST} does not list it as a file that a run wrote" if is_file else "which no run creates"
    return OutputNotEmptyError(
        f"cannot write {file}: it {what}, {why}; move it away or choose another folder", path=str(file)
    )


def edited(file: Path) -> OutputNotEmptyError:
    """Return the error for a figure that was edited."""
    return OutputNotEmptyError(
        f"cannot replace {file}: the figure was edited after it was drawn; move the figure out of the folder "
        "to keep it, or remove it",
        path=str(file),
    )


def not_writable(folder: Path, error: OSError) -> OutputNotWritableError:
    """Return the error for an output folder that cannot be created or written."""
    return OutputNotWritableError(
        f"the output folder {folder} cannot be written: {error.strerror or error}; choose another folder",
        path=str(folder),
    )
