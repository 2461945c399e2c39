"""Figures that commands save where the user says."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

from onorbit_rs.cli.writing import claim
from onorbit_rs.exceptions import InputError
from onorbit_rs.files import replacing

if TYPE_CHECKING:
    from matplotlib.figure import Figure

KINDS = (".png", ".pdf", ".svg")


def claim_picture(option: str, file: Path | None, *, force: bool) -> None:
    """Refuse a file that a figure cannot be saved to, before any work is done.

    Raises
    ------
    InputError
        If the name ends in none of :data:`KINDS`.
    OutputNotEmptyError, OutputFolderError
        As :func:`onorbit_rs.cli.writing.claim`.
    """
    if file is not None and file.suffix.lower() not in KINDS:
        raise InputError(
            f"{option} {file} is none of {', '.join(KINDS)}",
            name=option.lstrip("-"), got=file.suffix, expected=KINDS,
        )  # fmt: skip
    claim(file, force=force)


def save_figure(figure: Figure, file: Path) -> None:
    """Save a figure in the format that the name of the file says.

    Raises
    ------
    OutputFolderError
        If it cannot be written.
    """
    from onorbit_rs.figures import as_bytes

    with replacing(file) as temporary:
        temporary.write_bytes(as_bytes(figure, file.suffix[1:].lower()))
