"""``checkpoint/`` in the output folder: the rows so far and where the run stands, to go on from after a kill.

``<column>.f64`` holds the rows of a column, appended; ``state.json`` is replaced as a whole and says how many
rows count, so that a kill at any instant leaves a checkpoint that is whole.
"""

from __future__ import annotations

import hashlib
import json
import os
import shutil
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from onorbit_rs import _core
from onorbit_rs.exceptions import CheckpointError
from onorbit_rs.output.folder import CHECKPOINT, OutputFolder

if TYPE_CHECKING:
    from onorbit_rs._core import Checkpoint

_STATE = "state.json"


class CheckpointWriter:
    """Takes what :meth:`onorbit_rs.Simulation.run` hands to its ``checkpoint``; ``rows`` are there."""

    def __init__(self, folder: OutputFolder, digest: str, *, rows: int = 0) -> None:
        """For a run whose scenario has this digest."""
        self._folder, self._path = folder, folder.path / CHECKPOINT
        self._digest, self._rows = digest, rows

    def __call__(self, checkpoint: Checkpoint) -> None:
        """Append the new rows, then say that they count."""
        widths: dict[str, int] = {}
        new_rows = 0
        with self._folder.refusals(CHECKPOINT):
            self._path.mkdir(exist_ok=True)
            for name, rows in checkpoint.columns.items():
                new_rows, widths[name] = rows.shape
                _append(self._path / f"{name}.f64", rows, after=8 * self._rows * widths[name])
        self._rows += new_rows
        record = {
            "fingerprint": self._digest,
            "rows": self._rows,
            "widths": widths,
            "wall_s": checkpoint.wall_s,
            "engine": json.loads(checkpoint.state),
        }
        with (
            self._folder.writing(f"{CHECKPOINT}/{_STATE}") as path,
            path.open("w", encoding="utf-8") as stream,
        ):
            json.dump(record, stream, allow_nan=False)
            _to_disk(stream)


def has_checkpoint(folder: Path) -> bool:
    """Whether a run that was stopped left something to go on from."""
    return (folder / CHECKPOINT / _STATE).is_file()


def read_checkpoint(folder: Path, digest: str) -> tuple[Checkpoint, int]:
    """The checkpoint in an output folder, and how many rows it has.

    Raises
    ------
    CheckpointError
        There is none, it is broken, or it was left by another scenario, robot or controller.
    """
    path = folder / CHECKPOINT
    if not has_checkpoint(folder):
        raise _refused(
            f"no checkpoint in {folder}: the run ended, or was stopped before it left one; "
            "run the scenario again",
            path,
        )
    try:
        record = json.loads((path / _STATE).read_text(encoding="utf-8"))
        found, rows, wall = str(record["fingerprint"]), int(record["rows"]), float(record["wall_s"])
        if found != digest:
            raise _refused(
                f"the checkpoint in {folder} is of another scenario: scenario.yaml, or a file it names, was "
                "changed since; undo that or run the scenario again",
                path,
            )
        columns = {
            name: _column(path / f"{name}.f64", rows, int(width)) for name, width in record["widths"].items()
        }
        return _core.Checkpoint(json.dumps(record["engine"]), columns, wall_s=wall), rows
    except CheckpointError:
        raise
    except (OSError, ValueError, KeyError, TypeError, AttributeError) as error:
        raise _refused(
            f"the checkpoint in {folder} is broken: {error}; run the scenario again", path
        ) from error


def discard_checkpoint(folder: OutputFolder) -> None:
    """The run came to its end: there is nothing to go on from."""
    shutil.rmtree(folder.path / CHECKPOINT, ignore_errors=True)


def scenario_digest(scenario: dict[str, Any]) -> str:
    """Digest of a resolved scenario and of the content of every file it names."""
    digest = hashlib.sha256(json.dumps(scenario, sort_keys=True, default=str).encode())
    for text in _texts(scenario):
        file = Path(text)
        try:
            if file.is_absolute() and file.is_file():
                with file.open("rb") as stream:  # a SPICE kernel is larger than the memory
                    for part in iter(lambda: stream.read(1 << 20), b""):
                        digest.update(part)
        except OSError:  # a text too long for a path; a file that closed itself is told by who reads it
            continue
    return digest.hexdigest()


def _texts(value: Any) -> list[str]:
    if isinstance(value, str):
        return [value]
    children = value.values() if isinstance(value, dict) else value if isinstance(value, list) else ()
    return [text for child in children for text in _texts(child)]


def _append(file: Path, rows: Any, *, after: int) -> None:
    """Write rows at ``after`` bytes: what an earlier kill left behind that does not count is overwritten."""
    with file.open("r+b" if file.exists() else "w+b") as stream:
        if stream.seek(0, os.SEEK_END) < after:
            raise _refused(f"rows of the checkpoint are gone from {file}; run the scenario again", file)
        stream.truncate(after)
        stream.seek(after)
        stream.write(np.ascontiguousarray(rows, dtype="<f8").tobytes())
        _to_disk(stream)


def _to_disk(stream: Any) -> None:
    stream.flush()
    os.fsync(stream.fileno())


def _column(file: Path, rows: int, width: int) -> Any:
    values = np.fromfile(file, dtype="<f8", count=rows * width)
    if values.size != rows * width:
        raise ValueError(f"{file.name} holds {values.size} numbers, {rows * width} are needed")
    return values.reshape(rows, width)


def _refused(message: str, path: Path) -> CheckpointError:
    return CheckpointError(message, path=str(path))
