"""``checkpoint/`` in the output folder: the recorded rows and the state from which the run can resume.

``<column>.f64`` holds the rows of a column; new rows are appended. ``state.json`` is replaced atomically and
contains the number of valid rows and the SHA-256 of each column, so the checkpoint is consistent after a kill
at any instant. Columns of different systems of a world may differ in their number of rows.
"""

from __future__ import annotations

import hashlib
import json
import os
import warnings
from collections.abc import Callable, Mapping
from pathlib import Path
from typing import TYPE_CHECKING, Any, NamedTuple
from urllib.parse import quote

import numpy as np

from onorbit_rs import _core
from onorbit_rs.common.counting import count
from onorbit_rs.common.files import (
    open_to_change,
    open_to_read,
    output_errors,
    read_bounded,
    sync_folder,
)
from onorbit_rs.common.files import sync as sync_file
from onorbit_rs.exceptions import CheckpointError, OnOrbitError, OutputInUseError
from onorbit_rs.output.folder import OutputFolder
from onorbit_rs.output.manifest import CHECKPOINT, STATE
from onorbit_rs.output.sealed import sealed, unsealed

if TYPE_CHECKING:
    from hashlib import _Hash

    from onorbit_rs._core import Checkpoint

_MOST = 1 << 28
"""Largest size of ``state.json``, bytes; it contains the state of the controllers."""


_CHUNK = 1 << 22
"""Number of bytes that are read from a column at once."""


class _Written(NamedTuple):
    """Number and width of the rows of a column in its file, and their running digest."""

    rows: int
    width: int
    digest: _Hash


class SavedCheckpoint(NamedTuple):
    """A checkpoint read from a folder, with the number, width and digest of the rows of each column."""

    checkpoint: Checkpoint
    written: dict[str, _Written]

    def in_memory(self) -> Checkpoint:
        """Return the checkpoint with all of its rows in memory."""
        columns = {name: column[:] for name, column in self.checkpoint.columns.items()}
        return _core.Checkpoint(self.checkpoint.state, columns, wall_s=self.checkpoint.wall_s)


class CheckpointWriter:
    """Writes the checkpoints that :meth:`onorbit_rs.Simulation.run` passes to its ``checkpoint`` callback."""

    def __init__(self, folder: OutputFolder, digest: str, *, after: SavedCheckpoint | None = None) -> None:
        """Store the folder and the digest of the scenario; a resumed run continues ``after`` a checkpoint."""
        self._folder, self._path = folder, folder.path / CHECKPOINT
        self._digest, self._columns = digest, dict(after.written) if after else {}
        self._has_warned = False

    def __call__(self, checkpoint: Checkpoint) -> bool:
        """Write a checkpoint; return False, after one warning per run, if it cannot be written.

        Raises
        ------
        OutputInUseError
            If another process has locked the folder.
        """
        return self._warning_once(lambda: self._write(checkpoint))

    def rows_of(self, prefix: str) -> int:
        """Return the number of rows in the files of a system, given the prefix of its columns."""
        found = self._columns.get(f"{prefix}time")
        return found.rows if found else 0

    def file_of(self, column: str) -> Path:
        """Return the file of a column."""
        return self._path / _file_name(column)

    def append(self, columns: Mapping[str, Any], *, must: bool = False) -> bool:
        """Write rows without a checkpoint; return False, after one warning, if they cannot be written.

        A later checkpoint also contains the rows of columns that are only written here.

        Raises
        ------
        OutputFolderError, CheckpointError
            If the rows cannot be written and ``must`` is True.
        OutputInUseError
            If another process has locked the folder.
        """
        if not must:
            return self._warning_once(lambda: self._append_rows(columns))
        with output_errors(self._path):
            self._append_rows(columns)
        return True

    def _warning_once(self, write: Callable[[], object]) -> bool:
        try:
            with output_errors(self._path):
                write()
        except OutputInUseError:
            raise
        except OnOrbitError as error:
            if not self._has_warned:
                self._has_warned = True
                warnings.warn(
                    f"{error}; the run continues and will try again later to write its rows and checkpoints",
                    UserWarning, stacklevel=3,
                )  # fmt: skip
            return False
        return True

    def _append_rows(self, given: Mapping[str, Any], *, sync: bool = False) -> None:
        """Append rows to the files of the columns."""
        known = dict.fromkeys((*self._columns, *given))
        self._folder.expect_checkpoint((STATE, *map(_file_name, known)))
        columns = dict(self._columns)
        for name, rows in given.items():
            new_rows, width = rows.shape
            before = columns.get(name, _Written(0, width, hashlib.sha256()))
            content = np.ascontiguousarray(rows, dtype="<f8").tobytes()
            _append(self.file_of(name), content, after=8 * before.rows * width, sync=sync)
            digest = before.digest.copy()
            digest.update(content)
            columns[name] = _Written(before.rows + new_rows, width, digest)
        self._columns = columns

    def _write(self, checkpoint: Checkpoint) -> None:
        """Append the new rows, then replace the state, which contains the number of valid rows."""
        before = self._columns
        try:
            self._append_rows(checkpoint.columns, sync=True)
            for name in self._columns.keys() - checkpoint.columns.keys():
                sync_file(self.file_of(name))
            self._write_state(checkpoint)
        except BaseException:  # the next checkpoint contains these rows again
            self._columns = before
            raise

    def _write_state(self, checkpoint: Checkpoint) -> None:
        """Replace ``state.json``; raise CheckpointError if the state is too large."""
        columns = {
            name: {"rows": one.rows, "width": one.width, "sha256": one.digest.hexdigest()}
            for name, one in self._columns.items()
        }
        record = {
            "fingerprint": self._digest,
            "columns": columns,
            "wall_s": checkpoint.wall_s,
            "engine": json.loads(checkpoint.state),
        }
        content = sealed(record)
        if len(content) > _MOST:
            raise _refused(
                f"cannot write {self._path / STATE}: the state of the run has {len(content)} bytes, but "
                f"at most {_MOST} are allowed; store less in the state of Python controllers",
                self._path,
            )
        sync_folder(self._path)
        self._folder.replace(f"{CHECKPOINT}/{STATE}", content)
        sync_folder(self._path)


def has_checkpoint(folder: Path) -> bool:
    """Return True if the folder contains a checkpoint."""
    return (folder / CHECKPOINT / STATE).is_file()


def read_checkpoint(folder: Path, digest: str) -> SavedCheckpoint:
    """Read the checkpoint of an output folder; its columns are read from the files when they are sliced.

    Raises
    ------
    CheckpointError
        If there is no checkpoint, its files were changed or damaged, or the scenario or a file named in it
        has changed since the checkpoint was written.
    """
    path = folder / CHECKPOINT
    if not has_checkpoint(folder):
        raise _refused(
            f"there is no checkpoint in {folder}: the run is complete, or was stopped before its first "
            "checkpoint; to repeat it, run the scenario again",
            path,
        )
    file = path / STATE
    try:
        with open_to_read(file) as stream:
            record = unsealed(read_bounded(stream, _MOST))
        found, wall = str(record["fingerprint"]), float(record["wall_s"])
        if found != digest:
            raise _refused(
                f"the checkpoint in {folder} belongs to another scenario: scenario.yaml, or a file named in "
                "it, was changed after the checkpoint; undo the change or run the scenario again",
                path,
            )
        columns, written = {}, {}
        for name, entry in record["columns"].items():
            file, rows, width = path / _file_name(name), int(entry["rows"]), int(entry["width"])
            columns[name], digest_read = _column(file, rows, width)
            written[name] = _Written(rows, width, digest_read)
            if digest_read.hexdigest() != entry["sha256"]:
                raise ValueError("its rows do not match their checksum, so they were changed or damaged")
        state = json.dumps(record["engine"])
        return SavedCheckpoint(_core.Checkpoint(state, columns, wall_s=wall), written)
    except CheckpointError:
        raise
    except (OSError, ValueError, KeyError, TypeError, AttributeError, OverflowError, MemoryError) as error:
        reason = (
            f"it lacks {error}" if isinstance(error, KeyError) else getattr(error, "strerror", 0) or error
        )
        raise _refused(
            f"the checkpoint is damaged or cannot be read: {file} ({reason}); run the scenario again", file
        ) from error


def scenario_digest(scenario: dict[str, Any]) -> str:
    """Return the SHA-256, in hexadecimal, of a resolved scenario and the files to which it refers.

    These are the readable files that it names by absolute path.
    """
    digest = hashlib.sha256(json.dumps(scenario, sort_keys=True, default=str).encode())
    for text in _texts(scenario):
        file = Path(text)
        try:
            if file.is_absolute() and file.is_file():
                with file.open(
                    "rb"
                ) as stream:  # read in chunks, because a SPICE kernel may be larger than the memory
                    for part in iter(lambda: stream.read(1 << 20), b""):
                        digest.update(part)
        except OSError:  # too long for a path, or unreadable; building the scenario raises the error
            continue
    return digest.hexdigest()


def _texts(value: Any) -> list[str]:
    if isinstance(value, str):
        return [value]
    children = value.values() if isinstance(value, dict) else value if isinstance(value, list) else ()
    return [text for child in children for text in _texts(child)]


def _file_name(column: str) -> str:
    """Return the file name of a column; characters not allowed in a file name are percent-encoded."""
    return f"{quote(column, safe=' ')}.f64"


def _append(file: Path, content: bytes, *, after: int, sync: bool) -> None:
    """Write rows at the byte offset ``after``, replacing invalid rows of a run that was killed.

    With ``sync``, wait until all rows of the file are on the disk.

    Raises a CheckpointError if the file is shorter than ``after``.
    """
    with open_to_change(file) as stream:
        if stream.seek(0, os.SEEK_END) < after:
            raise _refused(
                f"{file} has lost rows that this run wrote, so the checkpoint cannot be updated; run the "
                "scenario again",
                file,
            )
        stream.truncate(after)
        stream.seek(after)
        left = memoryview(content)
        while left:
            left = left[stream.write(left) :]
        if sync:
            os.fsync(stream.fileno())


def _column(file: Path, rows: int, width: int) -> tuple[Any, _Hash]:
    """Return the valid rows of a column, which are read when they are sliced, and their running digest."""
    needed, digest = rows * width, hashlib.sha256()
    with open_to_read(file) as stream:
        size = stream.seek(0, os.SEEK_END)
        if min(rows, width) < 0 or size < 8 * needed:
            raise ValueError(f"it contains {count(size // 8, 'number', 'numbers')}, expected {needed}")
        stream.seek(0)
        left = 8 * needed
        while left and (part := stream.read(min(left, _CHUNK))):
            digest.update(part)
            left -= len(part)
    if left:
        raise ValueError(f"it ends after {8 * needed - left} of {8 * needed} bytes")
    return _FileColumn(file, rows, width), digest


class _FileColumn:
    """Column (rows, width) that is read from its file in slices."""

    def __init__(self, file: Path, rows: int, width: int) -> None:
        self.file, self.rows, self.width = file, rows, width

    def __len__(self) -> int:
        return self.rows

    def __getitem__(self, wanted: Any) -> Any:
        start, stop, _ = wanted.indices(self.rows)
        numbers = max(stop - start, 0) * self.width
        found = np.fromfile(self.file, dtype="<f8", count=numbers, offset=8 * start * self.width)
        return found.reshape(-1, self.width)


def _refused(message: str, path: Path) -> CheckpointError:
    return CheckpointError(message, path=str(path))
