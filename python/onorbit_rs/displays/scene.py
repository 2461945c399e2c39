"""The viewer in a notebook: :func:`onorbit_rs.show`."""

from __future__ import annotations

import os
import tempfile
import warnings
from pathlib import Path

from onorbit_rs.exceptions import DtypeError, InputError, NotFoundError
from onorbit_rs.output.manifest import RECORDING
from onorbit_rs.output.read import SavedRun
from onorbit_rs.output.write import write_recording
from onorbit_rs.scenario import WorldScenario
from onorbit_rs.scenario.build import build
from onorbit_rs.scenario.build_world import build_world
from onorbit_rs.simulation.run import Run
from onorbit_rs.tables import RecordedRun


def show(
    source: Run | RecordedRun | str | os.PathLike[str], *, width: int | None = None, height: int = 720
) -> None:
    """Display a run in the viewer, below the cell of a notebook.

    The viewer runs in the browser, to which the installed copy is sent; no connection to the internet is
    needed, unless the environment variable ``RERUN_NOTEBOOK_ASSET`` selects another copy.

    Parameters
    ----------
    source : Run, RecordedRun, str or path
        Result of :func:`onorbit_rs.run` or :func:`onorbit_rs.read_run`, or the folder of a run.
    width : int, optional
        Width, pixels; default: that of the notebook.
    height : int
        Height, pixels.

    Raises
    ------
    ViewerError
        If rerun-notebook is not installed (extra ``notebooks``), or this is not a notebook.
    NotFoundError
        If the folder does not exist, or contains no recording.
    ReadError
        If the recording has changed since the run.
    InputError
        If a size is not positive.
    DtypeError
        If a size is not an integer, or ``source`` is not a run.
    """
    for name, value in (("width", width), ("height", height)):
        _check_size(name, value)
    if not isinstance(source, Run | RecordedRun | str | os.PathLike):
        raise DtypeError(
            f"source is of type {type(source).__name__}; give a run, a recorded run or its folder",
            name="source", got=type(source).__name__, expected="Run, RecordedRun, str or path",
        )  # fmt: skip
    from onorbit_rs.viewer.inline import check_notebook, display_recording

    check_notebook()
    display_recording(recording_of(source), width, height)


def recording_of(source: Run | RecordedRun | str | os.PathLike[str]) -> bytes:
    """Return the content of a run's recording file; for a ``Run`` without one, compute the recording.

    Raises
    ------
    NotFoundError
        If a folder does not exist, or contains no recording.
    ReadError
        If the recording has changed since the run.
    """
    if isinstance(source, Run):
        if source.out is None or not (source.out / RECORDING).is_file():
            return _written(source)
        folder = source.out
    else:
        folder = source.folder if isinstance(source, RecordedRun) else Path(source)
    saved = SavedRun(folder)
    if not (folder / RECORDING).is_file():
        raise NotFoundError(
            f"there is no recording in {folder}; repeat the run without --no-recording, or with "
            "recording=True",
            path=str(folder), kind="recording",
        )  # fmt: skip
    with saved.opened(RECORDING) as file:
        return file.read()


def _written(run: Run) -> bytes:
    """Return the recording of a run in memory; the scenario is built again, without the user's code."""
    scenario = run.scenario
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")  # these warnings were issued during the run
        is_world = isinstance(scenario, WorldScenario)
        built = build_world(scenario, runs_code=False) if is_world else build(scenario, runs_code=False)  # type: ignore[arg-type]
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / RECORDING
        write_recording(path, run.trace, run.summary, built)
        return path.read_bytes()


def _check_size(name: str, value: object) -> None:
    if value is None and name == "width":
        return
    if isinstance(value, bool) or not isinstance(value, int):
        raise DtypeError(f"{name} is {value!r}; it must be a whole number of pixels", name=name, got=value)
    if value < 1:
        raise InputError(
            f"{name} is {value}; it must be at least 1 pixel", name=name, got=value, expected=">= 1"
        )
