"""Runs with a folder, with few files and in blocks of rows, and the columns in their traces."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import pytest

import onorbit_rs as oo
from onorbit_rs.simulation import memory, streaming

_TIMES = {"wall_s", "real_time_factor"}
SHORT = {"simulation.duration": "0.3 s", "simulation.time_step": "1 ms"}


def without_times(summary: dict[str, Any]) -> dict[str, Any]:
    """Returns a summary without the entries that depend on the speed of the machine."""
    own = {key: value for key, value in summary.items() if key not in _TIMES}
    if "systems" in own:
        own["systems"] = {name: without_times(system) for name, system in own["systems"].items()}
    return own


def columns_of(folder: Path) -> dict[str, tuple[Any, bytes]]:
    """Returns shape and bytes of every array in the trace of a folder, in the order of the file."""
    with np.load(folder / "trace.npz") as stored:
        return {name: (stored[name].shape, stored[name].tobytes()) for name in stored.files}


def stream_all(monkeypatch: pytest.MonkeyPatch, block: int = 100) -> None:
    """Makes every run with a folder write its rows in blocks of ``block`` rows."""
    monkeypatch.setattr(memory, "FITTING", 1.0)
    monkeypatch.setattr(streaming, "BLOCK", block)


def plain(name: str, out: Path, **options: Any) -> oo.Run:
    return oo.run(name, out, quiet=True, figures=False, recording=False, **options)
