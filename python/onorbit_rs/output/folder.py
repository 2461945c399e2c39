"""The output folder: checked before the run, so that no hours of simulation are lost to a foreign folder."""

from __future__ import annotations

import os
import tempfile
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path

from onorbit_rs.exceptions import OutputFolderError, OutputNotEmptyError, OutputNotWritableError

OURS = ("scenario.yaml", "trace.npz", "summary.json", "run.rrd")
FIGURES = "figures"


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
        try:
            yield partial
            partial.replace(final)
        except OSError as error:
            if isinstance(error, OutputFolderError):
                raise
            raise OutputFolderError(
                f"cannot write {final}: {error.strerror or error}", path=str(final)
            ) from error
        finally:  # whatever ended it, Ctrl-C included
            partial.unlink(missing_ok=True)

    def _make(self) -> None:
        if self.path.exists() and not self.path.is_dir():
            raise OutputNotWritableError(
                f"output path is a file, not a folder: {self.path}", path=str(self.path)
            )
        try:
            self.path.mkdir(parents=True, exist_ok=True)
            next(self.path.iterdir(), None)
        except OSError as error:
            raise self._not_writable(error) from error

    def _probe(self) -> None:
        try:
            with tempfile.TemporaryFile(dir=self.path) as probe:
                probe.write(b"can be written")
        except OSError as error:
            raise self._not_writable(error) from error

    def _remove_earlier_run(self) -> None:
        """Only what a run writes."""
        figures = self.path / FIGURES
        for file in [*(self.path / name for name in OURS), *figures.glob("*.png")]:
            try:
                file.unlink(missing_ok=True)
            except OSError as error:
                raise self._not_writable(error) from error

    def _not_writable(self, error: OSError) -> OutputNotWritableError:
        return OutputNotWritableError(
            f"output folder cannot be written: {self.path}: {error.strerror or error}", path=str(self.path)
        )
