"""The output folder: checked before the run, so that no hours of simulation are lost to a foreign folder."""

from __future__ import annotations

import os
import tempfile
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path

from onorbit_rs.exceptions import (
    OnOrbitError,
    OutputFolderError,
    OutputNotEmptyError,
    OutputNotWritableError,
)

REPORT = "report.html"
OURS = ("scenario.yaml", "trace.npz", "summary.json", "run.rrd", REPORT)
FIGURES = "figures"
CHECKPOINT = "checkpoint"


@dataclass(frozen=True)
class OutputFolder:
    """Where the files of one run go."""

    path: Path

    @classmethod
    def claim(cls, path: str | os.PathLike[str], *, force: bool = False) -> OutputFolder:
        """Make the folder where missing and see that it is empty and writable.

        Parameters
        ----------
        path : str or path
        force : bool
            Replace the files of an earlier run; what a run does not write stays.

        Raises
        ------
        OutputNotEmptyError
            It holds files and ``force`` is not set.
        OutputNotWritableError
            It is a file, or cannot be made or written.
        """
        folder = cls(Path(path))
        folder._make()
        if not force and any(folder.path.iterdir()):
            raise OutputNotEmptyError(
                f"output folder is not empty: {folder.path}; choose another or replace its run with --force "
                "(force=True)",
                path=str(folder.path),
            )
        folder._probe()
        folder._remove_earlier_run()
        return folder

    @contextmanager
    def writing(self, name: str) -> Iterator[Path]:
        """A temporary path that becomes ``name`` when all went well: no half-written files.

        Raises
        ------
        OutputFolderError
            The disk is full or gone.
        """
        final = self.path / name
        partial = final.with_name(f".partial-{final.name}")
        with self.refusals(name):
            try:
                yield partial
                partial.replace(final)
            finally:  # whatever ended it, Ctrl-C included
                partial.unlink(missing_ok=True)

    @contextmanager
    def refusals(self, name: str) -> Iterator[None]:
        """What the disk refuses becomes an :class:`OutputFolderError` about ``name``."""
        try:
            yield
        except OSError as error:
            if isinstance(error, OnOrbitError):
                raise
            file = self.path / name
            raise OutputFolderError(
                f"cannot write {file}: {error.strerror or error}", path=str(file)
            ) from error

    def discard(self) -> None:
        """Remove what a run that never began has written."""
        (self.path / "scenario.yaml").unlink(missing_ok=True)

    def _make(self) -> None:
        try:
            if self.path.exists() and not self.path.is_dir():
                raise _is_a_file(self.path)
            self.path.mkdir(parents=True, exist_ok=True)
            next(self.path.iterdir(), None)
            figures = self.path / FIGURES
            if figures.exists() and not figures.is_dir():
                raise _is_a_file(figures)
        except OSError as error:
            if isinstance(error, OutputFolderError):
                raise
            raise self._not_writable(error) from error

    def _probe(self) -> None:
        try:
            with tempfile.TemporaryFile(dir=self.path) as probe:
                probe.write(b"can be written")
        except OSError as error:
            raise self._not_writable(error) from error

    def _remove_earlier_run(self) -> None:
        """Only what a run writes."""
        figures, checkpoint = self.path / FIGURES, self.path / CHECKPOINT
        rows = [
            checkpoint / "state.json",
            *checkpoint.glob("*.f64"),
        ]  # the state first: rows alone count nothing
        for file in [
            *(self.path / name for name in OURS),
            *figures.glob("*.png"),
            *figures.glob("*.pdf"),
            *rows,
        ]:
            try:
                file.unlink(missing_ok=True)
            except OSError as error:
                raise self._not_writable(error) from error

    def _not_writable(self, error: OSError) -> OutputNotWritableError:
        return OutputNotWritableError(
            f"output folder cannot be written: {self.path}: {error.strerror or error}", path=str(self.path)
        )


def _is_a_file(path: Path) -> OutputNotWritableError:
    return OutputNotWritableError(f"output path is a file, not a folder: {path}", path=str(path))
