"""``manifest.json``: the files that a run wrote, with their sizes and SHA-256."""

from __future__ import annotations

import re
from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any, BinaryIO, NamedTuple

from onorbit_rs.common.files import exists, open_to_read, read_bounded, sha256_of
from onorbit_rs.common.printable import printable, shell_word
from onorbit_rs.exceptions import IntegrityError, ReadError
from onorbit_rs.output.sealed import sealed, unsealed

MANIFEST = "manifest.json"
SUMMARY, TRACE, SCENARIO, COMMANDS, RECORDING, REPORT = (
    "summary.json", "trace.npz", "scenario.yaml", "commands.jsonl", "run.rrd", "report.html",
)  # fmt: skip
RESULTS = (SUMMARY, TRACE, SCENARIO, COMMANDS, RECORDING, REPORT)
"""Files of a run and its report other than figures, in the order in which ``--force`` removes them."""
FIGURES, CHECKPOINT = "figures", "checkpoint"
STATE = "state.json"
_FORMAT = 1
_MOST = 16_000_000
_STEM = r"[^/\\\x00\ud800-\udfff]+"  # lone surrogates, which JSON can contain, are not valid in file names
_FIGURE = re.compile(rf"{FIGURES}/{_STEM}\.(png|pdf)")
_CHECKPOINT = re.compile(rf"{re.escape(STATE)}|{_STEM}\.f64")


class Entry(NamedTuple):
    """Size, bytes, and SHA-256, in hexadecimal, of a file."""

    size: int
    sha256: str

    @classmethod
    def of(cls, file: Path) -> Entry:
        """Return the current size and digest of a file."""
        with open_to_read(file) as stream:
            digest = sha256_of(stream)
            return cls(stream.tell(), digest)


@dataclass(frozen=True)
class Manifest:
    """Entries of files by name (``figures/x.png``), and the names of the files of the checkpoint."""

    files: Mapping[str, Entry] = field(default_factory=dict)
    checkpoint: tuple[str, ...] = ()

    def as_bytes(self) -> bytes:
        """Return the content of ``manifest.json``."""
        files = {name: entry._asdict() for name, entry in sorted(self.files.items())}
        return sealed({"format": _FORMAT, "files": files, "checkpoint": list(self.checkpoint)})

    @contextmanager
    def opened(self, folder: Path, name: str) -> Iterator[BinaryIO]:
        """Open a file for reading and check that its content is unchanged.

        Raises
        ------
        IntegrityError
            If the file was changed, or was not written by the run.
        FileNotFoundError, OSError
            If the file does not exist or cannot be read.
        """
        with open_to_read(folder / name) as stream:
            expected = self.files.get(name)
            size = stream.seek(0, 2)
            stream.seek(0)
            if expected is None or size != expected.size:
                raise _changed(folder, name, expected, Entry(size, "not computed"))
            if (digest := sha256_of(stream)) != expected.sha256:
                raise _changed(folder, name, expected, Entry(size, digest))
            stream.seek(0)
            yield stream


def read_manifest(folder: Path) -> Manifest | None:
    """Return the manifest of a folder; None if the folder has no manifest.

    Raises
    ------
    ReadError
        If the manifest cannot be read, is damaged, or lists files that no run writes.
    """
    file = folder / MANIFEST
    if not exists(file):
        return None
    try:
        with open_to_read(file) as stream:
            record = unsealed(read_bounded(stream, _MOST))
        if record["format"] != _FORMAT:
            raise ValueError(
                f"its format is {record['format']!r}, but this version of onorbit reads format {_FORMAT}"
            )
        files = {name: _entry(name, entry) for name, entry in record["files"].items()}
        names = tuple(record["checkpoint"])
        for name in names:
            if not (isinstance(name, str) and _CHECKPOINT.fullmatch(name)):
                raise ValueError(f"it lists {name!r}, which is not part of a checkpoint")
    except (OSError, ValueError, KeyError, TypeError, AttributeError) as error:
        reason = (
            f"it lacks {error}" if isinstance(error, KeyError) else getattr(error, "strerror", 0) or error
        )
        raise ReadError(
            f"cannot read {file}: {reason}, so the files of the run cannot be verified; repeat the run in "
            f"another folder with onorbit run {shell_word(folder / SCENARIO)} --out DIR, or remove "
            f"{MANIFEST} to read the folder without verification",
            path=str(file), kind="manifest",
        ) from error  # fmt: skip
    return Manifest(files, names)


def _entry(name: str, entry: Any) -> Entry:
    if name not in RESULTS and not _FIGURE.fullmatch(name):
        raise ValueError(f"it lists {name!r}, which is not a file of a run")
    size, digest = entry["size"], entry["sha256"]
    if type(size) is not int or not isinstance(digest, str):
        raise ValueError(f"the entry of {name!r} must contain a size and a SHA-256")
    return Entry(size, digest)


def _changed(folder: Path, name: str, expected: Entry | None, got: Entry) -> IntegrityError:
    if expected is None:
        what = f"{name} in {folder} was not written by the run of this folder"
    elif got.size != expected.size:
        what = f"{name} in {folder} has changed since the run wrote it: {got.size} bytes, not {expected.size}"
    else:
        why = f"its SHA-256 differs from that in {MANIFEST}"
        what = f"{name} in {folder} has changed since the run wrote it: {why}"
    again = f"onorbit run {shell_word(folder / SCENARIO)} --out DIR"
    fix = f"undo the change, or repeat the run: {again}"
    return IntegrityError(
        printable(f"{what}; {fix}"), path=str(folder / name), kind=name, expected=expected, got=got
    )
