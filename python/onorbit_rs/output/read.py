"""Reads a run from its folder; each file is checked against the manifest."""

from __future__ import annotations

import json
import os
import textwrap
import warnings
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import TYPE_CHECKING, Any, BinaryIO, cast

from onorbit_rs.common.files import exists, file_kind, is_regular, open_to_read, read_bounded
from onorbit_rs.common.printable import shell_word
from onorbit_rs.exceptions import IntegrityError, NotFoundError, OnOrbitError, ReadError
from onorbit_rs.output.checkpoint import has_checkpoint
from onorbit_rs.output.checks import CHECKS, GATE
from onorbit_rs.output.lock import owner_of
from onorbit_rs.output.manifest import MANIFEST, SCENARIO, SUMMARY, TRACE, read_manifest
from onorbit_rs.output.names import split_names
from onorbit_rs.output.npz_reader import read_arrays
from onorbit_rs.output.saved_trace import SavedTrace, check_shapes
from onorbit_rs.output.saved_world import (
    EVENTS,
    WORLD_COLUMNS,
    SavedWorldTrace,
    saved_world,
    system_in,
    systems_in,
)
from onorbit_rs.scenario import load

if TYPE_CHECKING:
    from onorbit_rs._core import Trace
    from onorbit_rs.scenario import Scenario, WorldScenario

_MOST = 16_000_000
"""Largest size of a summary, bytes."""


class SavedRun:
    """Files of one run in a folder; each is checked against the manifest, which is read at construction."""

    def __init__(self, folder: Path) -> None:
        """Read the manifest; without one, a warning is issued when the first file has been read.

        Raises
        ------
        NotFoundError
            If there is no such folder, or the path is not a folder.
        ReadError
            If the manifest is damaged.
        OSError
            If the path cannot be examined, for example because its name is too long.
        """
        self.folder = folder
        check_folder(folder)
        self._manifest = read_manifest(folder)
        self._has_warned = False

    @contextmanager
    def opened(self, name: str) -> Iterator[BinaryIO]:
        """Open a file for reading and check that its content is unchanged.

        Raises
        ------
        IntegrityError
            If the file was changed.
        ReadError
            If another process is replacing the file.
        FileNotFoundError, OSError
            If the file does not exist or cannot be read.
        """
        if self._manifest is None:
            with open_to_read(self.folder / name) as stream:
                yield stream
            self._warn()
            return
        try:
            with self._manifest.opened(self.folder, name) as stream:
                yield stream
        except IntegrityError as error:
            owner = owner_of(self.folder)
            if owner is None or owner.pid == os.getpid():
                raise
            file = self.folder / name
            message = f"{file} is being replaced by {owner}; try again when that process has ended"
            raise ReadError(message, path=str(file), kind=name) from error

    def check(self, name: str) -> None:
        """Raise :class:`IntegrityError` for a changed file and :class:`ReadError` for an unreadable one."""
        try:
            with self.opened(name):
                pass
        except OSError as error:
            if isinstance(error, OnOrbitError):
                raise
            raise _unreadable(self.folder / name, name, error) from error

    def summary(self) -> dict[str, Any]:
        """Return the content of ``summary.json``; its errors are those of :func:`read_summary`."""
        file = self.folder / SUMMARY
        try:
            with self.opened(SUMMARY) as stream:
                return _checked(_from_json(read_bounded(stream, _MOST)))
        except OnOrbitError:
            raise
        except FileNotFoundError as error:
            what = f"no run in this folder ({SUMMARY} is missing): {self.folder}"
            what += _hint(self.folder) or "; give the output folder of a run"
            raise NotFoundError(what, path=str(self.folder), kind="run") from error
        except OSError as error:
            raise _unreadable(file, "summary", error) from error
        except (ValueError, TypeError) as error:
            raise _damaged(file, "summary", error) from error

    def trace(self) -> Trace:
        """Return the trace of a run with one robot; its errors are those of :func:`read_trace`."""
        arrays = self._arrays({"time", "q", "v", "momentum"})
        return cast("Trace", SavedTrace(arrays))

    def world_trace(self) -> SavedWorldTrace:
        """Return the trace of a run with several systems, with the names of its events from the summary.

        Raises
        ------
        NotFoundError, IntegrityError, ReadError
            As for :func:`read_trace` and :func:`read_summary`.
        """
        arrays = self._arrays({*WORLD_COLUMNS, *(f"events/{name}" for name in EVENTS)})
        audits = self.summary().get("events", [])
        try:
            return saved_world(arrays, audits)
        except (ValueError, TypeError, KeyError, IndexError) as error:
            raise _damaged(self.folder / TRACE, "trace", error) from error

    def columns(self) -> tuple[dict[str, Any], dict[str, list[str]]]:
        """Return the columns in ``trace.npz`` by path, and the names of joints and bodies by path.

        Raises the errors of :func:`read_trace`.
        """
        return self._columns_and_names({"time"})

    def _arrays(self, required: set[str]) -> dict[str, Any]:
        return self._columns_and_names(required)[0]

    def _columns_and_names(self, required: set[str]) -> tuple[dict[str, Any], dict[str, list[str]]]:
        file = self.folder / TRACE
        try:
            with self.opened(TRACE) as stream:
                arrays, names = split_names(read_arrays(stream))
            if not required <= set(arrays):
                raise ValueError(f"it has no {' and no '.join(sorted(required - set(arrays)))}")
            for own in [system_in(arrays, name).arrays for name in systems_in(arrays)] or [arrays]:
                check_shapes(own)
        except OnOrbitError:
            raise
        except FileNotFoundError as error:
            hint = _hint(self.folder) or "; give the output folder of a run"
            message = f"no trace in this folder ({TRACE} is missing): {self.folder}{hint}"
            raise NotFoundError(message, path=str(file), kind="trace") from error
        except OSError as error:
            raise _unreadable(file, "trace", error) from error
        except (ValueError, TypeError, AttributeError) as error:
            raise _damaged(file, "trace", error) from error
        return arrays, names

    def scenario_text(self) -> str:
        """Return the text of ``scenario.yaml``.

        Raises
        ------
        NotFoundError, ReadError, IntegrityError
            If the file does not exist, cannot be read, or was changed.
        """
        file = self.folder / SCENARIO
        try:
            with self.opened(SCENARIO) as stream:
                return stream.read().decode("utf-8")
        except OnOrbitError:
            raise
        except FileNotFoundError as error:
            message = (
                f"no scenario in this folder ({SCENARIO} is missing): {self.folder}; give the output folder "
                "of a run"
            )
            raise NotFoundError(message, path=str(file), kind="scenario") from error
        except (OSError, ValueError) as error:
            raise _unreadable(file, "scenario", error) from error

    def scenario(self) -> Scenario | WorldScenario:
        """Return the scenario of the run.

        Raises
        ------
        ScenarioError
            If the scenario is invalid.
        NotFoundError, ReadError, IntegrityError
            As for :meth:`scenario_text`.
        """
        self.scenario_text()
        scenario = load(self.folder / SCENARIO)
        self.check(SCENARIO)  # raises if the file was replaced in the meantime
        return scenario

    def _warn(self) -> None:
        if not self._has_warned:
            self._has_warned = True
            warnings.warn(
                f"{self.folder} has no {MANIFEST} (it was removed, or an earlier version wrote the folder), "
                "so changes to the files since the run cannot be detected; repeat the run to write one",
                UserWarning, stacklevel=2,
            )  # fmt: skip


def check_folder(folder: Path) -> None:
    """Raise :class:`NotFoundError` if the path does not exist or is not a folder."""
    if not folder.is_dir():
        what = (
            f" is {file_kind(folder)}, but the output folder of a run is required"
            if exists(folder)
            else ": no such folder; give the output folder of a run"
        )
        raise NotFoundError(f"{folder}{what}", path=str(folder), kind="run")


def read_trace(folder: Path) -> Trace:
    """Return the columns in ``trace.npz``; computed results such as ``certificate`` are not available.

    Raises
    ------
    NotFoundError
        If the folder does not exist or contains no trace.
    IntegrityError
        If the trace was changed after the run.
    ReadError
        If the file is not the trace of a run.
    """
    return SavedRun(folder).trace()


def _unreadable(file: Path, kind: str, error: Exception) -> ReadError:
    reason = getattr(error, "strerror", None) or error
    return ReadError(f"cannot read {file}: {reason}", path=str(file), kind=kind)


def _damaged(file: Path, kind: str, error: Exception) -> ReadError:
    """Return the error for a file whose content is invalid."""
    reason = f"it has no {error}" if isinstance(error, KeyError) else error
    again = f"onorbit run {shell_word(file.parent / SCENARIO)} --out DIR"
    return ReadError(
        f"cannot read {file}: {reason}; repeat the run in another folder with {again}",
        path=str(file), kind=kind,
    )  # fmt: skip


def _hint(folder: Path) -> str:
    """Return a hint for the message about a missing file; empty if there is none.

    The hint names the process that writes the run, the files of a campaign, or the command that resumes an
    interrupted run.
    """
    owner = owner_of(folder)
    if owner is not None and owner.pid != os.getpid():
        return f"; {owner} is writing it"
    if is_regular(folder / "cases.parquet"):
        return (
            "; it contains a campaign: its results are in cases.parquet and report.html, and the option "
            "--case of onorbit campaign repeats one case as a run"
        )
    if not has_checkpoint(folder):
        return ""
    return f"; the run was stopped before its end; continue with: onorbit resume {shell_word(folder)}"


def read_summary(folder: Path) -> dict[str, Any]:
    """Return the content of ``summary.json`` of a run.

    Raises
    ------
    NotFoundError
        If the folder does not exist or contains no run.
    IntegrityError
        If the summary was changed after the run.
    ReadError
        If the summary cannot be read.
    """
    try:
        return SavedRun(folder).summary()
    except OSError as error:  # for example a name that is too long
        if isinstance(error, OnOrbitError):
            raise
        raise _unreadable(folder / SUMMARY, "summary", error) from error


_KINDS: dict[str, tuple[type | tuple[type, ...], str]] = {
    "status": (str, "text"),
    "certificate_passed": ((bool, type(None)), "true, false or null"),
    "simulated_s": ((int, float, type(None)), "a number or null"),
}
"""Required types, with their names in messages, of the entries that other code reads."""


def _checked(summary: Any) -> dict[str, Any]:
    if not isinstance(summary, dict):
        raise TypeError(f"its content is {_brief(summary)}; expected a mapping")
    if isinstance(summary.get("systems"), dict):
        return _checked_world(summary)
    for name, value in summary.items():
        if name in CHECKS or name.startswith(GATE):
            if not isinstance(value, (int, float, type(None))):
                raise TypeError(f"{name} is {_brief(value)}; expected a number or null")
        elif not isinstance(value, (str, int, float, type(None))):
            raise TypeError(f"{name} is {_brief(value)}; expected a number, text or null")
    for name, (kind, words) in _KINDS.items():
        if name in summary and not isinstance(summary[name], kind):
            raise TypeError(f"{name} is {_brief(summary[name])}; expected {words}")
    return summary


def _checked_world(summary: dict[str, Any]) -> dict[str, Any]:
    """Return the summary of a run with several systems after checking the types of its parts."""
    for system in summary["systems"].values():
        _checked(system)
    lists = ("events", "certificate", "contacts", "latches")
    for part in lists:
        rows = summary.get(part, [] if part in ("contacts", "latches") else None)
        if not isinstance(rows, list) or not all(isinstance(row, dict) for row in rows):
            got = _brief(rows) if part in summary else "missing"
            raise TypeError(f"{part} is {got}; expected a list of mappings")
    _checked({key: value for key, value in summary.items() if key not in ("systems", *lists)})
    return summary


def _brief(value: Any) -> str:
    return textwrap.shorten(repr(value), 60)


def _from_json(text: bytes) -> Any:
    try:
        return json.loads(text)
    except RecursionError:
        raise ValueError("it is nested too deeply") from None
