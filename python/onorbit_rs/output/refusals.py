"""Why an output folder, or a file in it, may not be written."""

from __future__ import annotations

from pathlib import Path

from onorbit_rs.exceptions import OutputNotEmptyError, OutputNotWritableError
from onorbit_rs.files import described, is_regular
from onorbit_rs.output.manifest import MANIFEST


def not_empty(folder: Path) -> OutputNotEmptyError:
    """Of a folder that holds files, where a run may replace none."""
    return OutputNotEmptyError(
        f"output folder is not empty: {folder}; choose another or replace its run with --force (force=True)",
        path=str(folder),
    )


def foreign(file: Path) -> OutputNotEmptyError:
    """Of a file that no run wrote, or what is no file: a link, a pipe."""
    is_file = is_regular(file)
    what = "there" if is_file else described(file)
    why = f"and {MANIFEST} does not list it as a file that a run wrote" if is_file else "which no run makes"
    return OutputNotEmptyError(
        f"cannot write {file}: it is {what}, {why}; move it away or choose another folder", path=str(file)
    )


def edited(file: Path) -> OutputNotEmptyError:
    """Of a figure that somebody worked on."""
    return OutputNotEmptyError(
        f"cannot replace {file}: it was changed since it was drawn; move it out of the folder to keep it, or "
        "remove it",
        path=str(file),
    )


def not_writable(folder: Path, error: OSError) -> OutputNotWritableError:
    """Of a folder, by what the system says."""
    return OutputNotWritableError(
        f"output folder cannot be written: {folder}: {error.strerror or error}", path=str(folder)
    )
