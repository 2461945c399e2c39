"""Files of a campaign: parts with the outcomes of cases, each of which is written atomically.

``cases/part-N.json`` holds the outcomes of some cases, and ``cases/columns-N.npz`` their kept columns. A case
counts as done as soon as the JSON file of its part exists, so a campaign that was killed at any instant
resumes with the cases that are missing.
"""

from __future__ import annotations

import json
import os
import re
import time
from collections.abc import Iterable, Iterator
from pathlib import Path
from typing import Any

import numpy as np

from onorbit_rs.campaigns.cases import Outcome
from onorbit_rs.campaigns.failure_folders import failure_folders, remove_failure
from onorbit_rs.common.files import is_regular, output_errors, remove, replacing
from onorbit_rs.exceptions import OutputInUseError, OutputNotEmptyError, ReadError
from onorbit_rs.output.errors import not_writable
from onorbit_rs.output.folder import make_folder
from onorbit_rs.output.lock import LOCK, FolderLock, owner_of

CAMPAIGN, TABLE, COLUMNS, REPORT = "campaign.yaml", "cases.parquet", "columns.parquet", "report.html"
PARTS, IDENTITY = "cases", "identity.json"
_PART = re.compile(r"part-(\d{8})\.json")
_OWN = re.compile(rf"(part|columns)-\d{{8}}\.(json|npz)|{re.escape(IDENTITY)}|\.partial-[0-9a-f]+")
_EVERY_S = 1.0
"""Wall-clock time between two parts, s; a process that is killed loses the outcomes since the last part."""
_MOST_ROWS = 500
_MOST_PARTS = 200
"""Number of parts at which they are merged into one."""


class CampaignFolder:
    """Folder of a campaign, locked against other processes; a context manager."""

    def __init__(self, path: str | os.PathLike[str], name: str, digest: str, *, force: bool = False) -> None:
        """Create the folder, or continue the same campaign in it.

        Raises
        ------
        OutputNotEmptyError
            If the folder contains other files, or another campaign and ``force`` is False.
        OutputNotWritableError, OutputInUseError
            If the path is not a writable folder, or another process writes to it.
        """
        self.path, self._digest = Path(path), digest
        self._buffer: list[Outcome] = []
        self._last_write = time.monotonic()
        make_folder(self.path)
        if owner_of(self.path) is None and not is_campaign(self.path) and not _is_empty(self.path):
            raise OutputNotEmptyError(
                f"the output folder {self.path} contains files, but no campaign; choose another folder",
                path=str(self.path),
            )
        try:
            self._lock = FolderLock(self.path)
        except OutputInUseError:
            raise
        except OSError as error:
            raise not_writable(self.path, error) from error
        try:
            self._claim(name, force)
        except BaseException:
            self.close()
            raise

    def _claim(self, name: str, force: bool) -> None:
        parts = self.path / PARTS
        if is_campaign(self.path):
            found = _identity(self.path)
            if found.get("digest") == self._digest:
                return
            if not force:
                what = (
                    f"another campaign, {found['name']!r}, whose scenario, settings or version differ"
                    if "name" in found
                    else f"a campaign whose file {PARTS}/{IDENTITY} cannot be read"
                )
                raise OutputNotEmptyError(
                    f"{self.path} contains {what}; choose another folder, or replace the campaign with "
                    "--force (force=True)",
                    path=str(self.path),
                )
            self._remove_campaign()
        with output_errors(parts):
            parts.mkdir(exist_ok=True)
        self.write(f"{PARTS}/{IDENTITY}", json.dumps({"name": name, "digest": self._digest}).encode())

    def _remove_campaign(self) -> None:
        """Remove the campaign; its identity is removed last, so that it remains one if this fails."""
        for folder in failure_folders(self.path).values():
            remove_failure(folder)
        with output_errors(self.path):
            for name in (TABLE, COLUMNS, REPORT, CAMPAIGN):
                remove(self.path / name)
            for file in sorted((self.path / PARTS).iterdir(), key=lambda file: file.name == IDENTITY):
                if _OWN.fullmatch(file.name):
                    remove(file)

    def __enter__(self) -> CampaignFolder:
        """Return the folder."""
        return self

    def __exit__(self, *_: object) -> None:
        """Release the lock."""
        self.close()

    def close(self) -> None:
        """Release the lock."""
        self._lock.release()

    def write(self, name: str, content: bytes) -> None:
        """Replace a file atomically."""
        with replacing(self.path / name) as temporary:
            temporary.write_bytes(content)

    def add(self, outcome: Outcome) -> None:
        """Add an outcome; write all new ones if there are many, or the last write was over a second ago."""
        self._buffer.append(outcome)
        if len(self._buffer) >= _MOST_ROWS or time.monotonic() - self._last_write >= _EVERY_S:
            self.flush()

    def flush(self) -> None:
        """Write the outcomes that are not on the disk yet.

        Raises
        ------
        OutputFolderError
            If the outcomes cannot be written, as on a full disk; all earlier parts are complete.
        """
        self._last_write = time.monotonic()
        if not self._buffer:
            return
        numbers = self._numbers()
        if len(numbers) >= _MOST_PARTS:
            self._merge(numbers)
            numbers = self._numbers()
        self._write_part(numbers[-1] + 1 if numbers else 0, self._buffer)
        self._buffer = []

    def _numbers(self) -> list[int]:
        names = (_PART.fullmatch(file.name) for file in (self.path / PARTS).iterdir())
        return sorted(int(match[1]) for match in names if match)

    def _write_part(self, number: int, outcomes: list[Outcome]) -> None:
        """Write a part: first the columns, then the outcomes, whose file makes the part valid."""
        arrays = {f"{outcome.case}/{name}": values for outcome in outcomes
                  for name, values in outcome.columns.items()}  # fmt: skip
        if arrays:
            with replacing(self._columns_file(number)) as file, file.open("wb") as stream:
                np.savez(stream, allow_pickle=False, **arrays)
        self._write_rows(
            number,
            [
                [one.case, one.status, one.error, one.values, one.numbers, number if one.columns else None]
                for one in outcomes
            ],
        )

    def _write_rows(self, number: int, rows: list[Any]) -> None:
        with replacing(self._part_file(number)) as file:
            file.write_text(json.dumps(rows, allow_nan=False, separators=(",", ":")), encoding="utf-8")

    def _part_file(self, number: int) -> Path:
        return self.path / PARTS / f"part-{number:08d}.json"

    def _columns_file(self, number: int) -> Path:
        return self.path / PARTS / f"columns-{number:08d}.npz"

    def _merge(self, numbers: list[int]) -> None:
        """Replace all parts by one with the next number; if this is interrupted, some rows exist twice."""
        self._write_rows(numbers[-1] + 1, list(self._all_rows()))
        with output_errors(self.path / PARTS):
            for number in numbers:
                remove(self._part_file(number))

    def done(self) -> set[int]:
        """Return the numbers of the cases whose outcomes are on the disk."""
        return {row[0] for row in self._all_rows()}

    def outcomes(self) -> Iterator[Outcome]:
        """Yield the outcomes on the disk without columns, each case once, in the order of their parts."""
        for case, status, error, values, found, _ in self._all_rows():
            yield Outcome(case, status, error, values, found)

    def columns(self, cases: Iterable[int]) -> Iterator[tuple[int, dict[str, Any]]]:
        """Yield the kept columns of the given cases in this order; cases without columns are left out."""
        numbers = {row[0]: row[5] for row in self._all_rows() if row[5] is not None}
        for case in cases:
            if case in numbers:
                with np.load(self._columns_file(numbers[case]), allow_pickle=False) as arrays:
                    prefix = f"{case}/"
                    names = [key for key in arrays.files if key.startswith(prefix)]
                    yield case, {key.removeprefix(prefix): arrays[key] for key in names}

    def _all_rows(self) -> Iterator[Any]:
        """Yield the rows of all parts, each case once."""
        seen: set[int] = set()
        for number in self._numbers():
            for row in self._rows(number):
                if row[0] not in seen:
                    seen.add(row[0])
                    yield row

    def _rows(self, number: int) -> list[Any]:
        file = self._part_file(number)
        try:
            rows: list[Any] = json.loads(file.read_text(encoding="utf-8"))
        except (OSError, ValueError) as error:
            raise ReadError(
                f"{file} cannot be read: {error}; remove it, and run the campaign again to repeat its cases",
                path=str(file), kind="part",
            ) from None  # fmt: skip
        return rows


def is_campaign(folder: Path) -> bool:
    """Return True if a folder contains a campaign."""
    return is_regular(folder / PARTS / IDENTITY)


def _identity(folder: Path) -> dict[str, Any]:
    try:
        found: dict[str, Any] = json.loads((folder / PARTS / IDENTITY).read_text(encoding="utf-8"))
    except (OSError, ValueError):
        return {}
    return found if isinstance(found, dict) else {}


def _is_empty(folder: Path) -> bool:
    return not any(file.name != LOCK for file in folder.iterdir())
