"""Names of the files that commands save figures to."""

from __future__ import annotations

from pathlib import Path

from onorbit_rs.cli.writing import claim
from onorbit_rs.exceptions import InputError

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
