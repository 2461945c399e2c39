"""A run read back from its folder."""

from __future__ import annotations

import json
import zipfile
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any, cast

import numpy as np

from onorbit_rs.exceptions import NotFoundError, ReadError
from onorbit_rs.output.checkpoint import has_checkpoint
from onorbit_rs.printable import shell_word

if TYPE_CHECKING:
    from onorbit_rs._core import Trace


@dataclass(frozen=True)
class SavedTrace:
    """Columns under their names, as a :class:`onorbit_rs.Trace` has them."""

    arrays: Mapping[str, Any]

    def __getattr__(self, name: str) -> Any:
        """A column; None where the run had nothing for it."""
        if name in _COLUMNS:
            return self.arrays.get(name)
        if name.startswith("__") or name == "arrays" or name not in self.arrays:
            raise AttributeError(f"the trace has no column {name!r}")
        return self.arrays[name]

    def columns(self) -> list[str]:
        """Names of the columns."""
        return [name for name in self.arrays if not name.startswith(("tracking_", "wrench_", "rereferenced"))]

    @property
    def tracking(self) -> dict[str, Any]:
        """Errors of each controller."""
        return self._named("tracking_")

    @property
    def wrenches(self) -> dict[str, Any]:
        """(T, bodies, 6) of each effect."""
        return self._named("wrench_")

    def _named(self, kind: str) -> dict[str, Any]:
        return {name.removeprefix(kind): rows for name, rows in self.arrays.items() if name.startswith(kind)}


def read_trace(folder: Path) -> Trace:
    """The columns in ``trace.npz``; what a trace computes on request (its certificate) is not there.

    Raises
    ------
    NotFoundError, ReadError
        No such file, or not one of ours.
    """
    file = folder / "trace.npz"
    try:
        with file.open("rb") as stream, np.load(stream, allow_pickle=False) as stored:
            arrays = {name: stored[name] for name in stored.files}
        if not {"time", "q", "v", "momentum"} <= set(arrays):
            raise ValueError("columns are missing")
        _check_shapes(arrays)
    except FileNotFoundError as error:
        message = f"no trace in this folder: {file}{_way_out(folder)}"
        raise NotFoundError(message, path=str(file), kind="trace") from error
    except (ValueError, EOFError, OSError, TypeError, AttributeError, zipfile.BadZipFile) as error:
        raise ReadError(f"cannot read {file}: {error}", path=str(file), kind="trace") from error
    return cast("Trace", SavedTrace(arrays))


def _way_out(folder: Path) -> str:
    """How to go on with a run that was killed."""
    if not has_checkpoint(folder):
        return ""
    return f"; its run was stopped before its end, go on with: onorbit resume {shell_word(folder)}"


def _check_shapes(arrays: Mapping[str, Any]) -> None:
    """Every column has a row per instant, and is as wide as the robot: (7 + n) and (6 + n) for n joints."""
    rows, n = np.shape(arrays["time"]), max((np.shape(arrays["q"]) or (7,))[-1] - 7, 0)
    if len(rows) != 1 or rows[0] == 0:
        raise ValueError(f"column 'time' has shape {rows}, expected (T,) with a row at least")
    widths = {name: width for name, width in _widths(n).items() if name in arrays}
    for name, values in arrays.items():
        if name.startswith("rereferenced"):
            continue
        shape, expected = np.shape(values), (*rows, *widths.get(name, np.shape(values)[1:]))
        if shape != expected:
            raise ValueError(f"column {name!r} has shape {shape}, expected {expected}")


def _widths(n: int) -> dict[str, tuple[int, ...]]:
    """Shapes of a row of the columns, for ``n`` joints."""
    three, six, pose = (3,), (6,), (4, 4)
    return {
        "q": (7 + n,), "v": (6 + n,), "acceleration": (6 + n,), "tau": (n,), "momentum": six,
        "friction_compensation": (n,), "impulse": six,
        "kinetic_energy": (), "work": (), "dissipated": (), "center_of_mass": three,
        "tool_pose": pose, "reference_pose": pose, "position_error": three, "attitude_error": three,
        "position_eci": three, "velocity_eci": three, "reference_residual": three,
    }  # fmt: skip


_COLUMNS = ("time", *_widths(0))


def read_summary(folder: Path) -> dict[str, Any]:
    """``summary.json`` of a run.

    Raises
    ------
    NotFoundError
        No such folder, or no run in it.
    ReadError
        It cannot be read.
    """
    file = folder / "summary.json"
    try:
        is_there = file.is_file()
    except OSError as error:  # a name too long
        raise ReadError(f"cannot read {file}: {error.strerror}", path=str(file), kind="summary") from error
    if not is_there:
        what = "no run in this folder (no summary.json)" if folder.is_dir() else "no such folder"
        what = "this is a file, not the folder of a run" if folder.is_file() else what
        raise NotFoundError(f"{what}: {folder}{_way_out(folder)}", path=str(folder), kind="run")
    try:
        return _checked(json.loads(file.read_text(encoding="utf-8")))
    except OSError as error:
        raise ReadError(f"cannot read {file}: {error}", path=str(file), kind="summary") from error
    except (ValueError, TypeError) as error:
        here = shell_word(folder)
        again = f"run it again: onorbit run {shell_word(folder / 'scenario.yaml')} --out {here} --force"
        raise ReadError(f"cannot read {file}: {error}; {again}", path=str(file), kind="summary") from error


_KINDS: dict[str, tuple[type | tuple[type, ...], str]] = {
    "status": (str, "a word"),
    "certificate_passed": ((bool, type(None)), "true or false"),
    "simulated_s": ((int, float, type(None)), "a number"),
}
"""What entries that decide what is said must be."""


def _checked(summary: Any) -> dict[str, Any]:
    if not isinstance(summary, dict):
        raise TypeError(f"it holds a {type(summary).__name__}, not a mapping")
    for name, (kind, words) in _KINDS.items():
        if name in summary and not isinstance(summary[name], kind):
            raise TypeError(f"{name} is {summary[name]!r}, expected {words}")
    return summary
