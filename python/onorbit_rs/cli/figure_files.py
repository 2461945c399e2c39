"""Checks the output files of figures before a command runs, and saves the figure of a robot."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING

from onorbit_rs.cli.output_files import check_output_file
from onorbit_rs.exceptions import InputError

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray

    from onorbit_rs._core import Model

KINDS = (".png", ".pdf", ".svg")


def check_figure_file(option: str, file: Path | None, *, force: bool) -> None:
    """Check that a figure can be saved in a file; called before any computation.

    Raises
    ------
    InputError
        If the file name does not end in one of :data:`KINDS`.
    OutputNotEmptyError, OutputFolderError
        As raised by :func:`onorbit_rs.cli.output_files.check_output_file`.
    """
    if file is not None and file.suffix.lower() not in KINDS:
        raise InputError(
            f"{option}: the file name {file} must end in {', '.join(KINDS[:-1])} or {KINDS[-1]}",
            name=option.lstrip("-"), got=file.suffix, expected=KINDS,
        )  # fmt: skip
    check_output_file(file, force=force)


def save_portrait(
    file: Path | None, model: Model, q: NDArray[np.float64], frames: Sequence[str] = ()
) -> None:
    """Save a figure of a robot, see :func:`onorbit_rs.figures.portrait`; do nothing if ``file`` is None.

    Raises
    ------
    OutputFolderError
        If the file cannot be written.
    """
    if file is not None:
        from onorbit_rs.figures import portrait, save

        save(portrait(model, q, frames), file)
