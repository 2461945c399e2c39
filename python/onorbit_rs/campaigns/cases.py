"""Runs one case of a campaign: for a row of the table, or as an ordinary run in a folder."""

from __future__ import annotations

import threading
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any

import numpy as np

from onorbit_rs._core import WorldTrace
from onorbit_rs.campaigns.failure_folders import begin_failure
from onorbit_rs.campaigns.kept_columns import kept_columns
from onorbit_rs.campaigns.numbers import numbers_of
from onorbit_rs.common.files import exists
from onorbit_rs.common.printable import printable
from onorbit_rs.exceptions import OutputFolderError, SimulationError
from onorbit_rs.output import summarize, summarize_world
from onorbit_rs.output.clearance import add_clearances, found_clearances
from onorbit_rs.output.manifest import SUMMARY
from onorbit_rs.scenario import WorldScenario
from onorbit_rs.scenario.build import Built, build
from onorbit_rs.scenario.build_world import BuiltWorld, build_world
from onorbit_rs.scenario.load import check
from onorbit_rs.simulation.run import run

if TYPE_CHECKING:
    from collections.abc import Callable
    from pathlib import Path

    from numpy.typing import NDArray

    from onorbit_rs.campaigns.plan import Plan

_BUILDING = threading.Lock()
"""Lock for building a scenario, which changes the warning filters of the whole process."""


@dataclass(frozen=True)
class Outcome:
    """Result of a case; it can be pickled."""

    case: int
    status: str
    """``complete``, ``diverged``, or ``failed`` if another error ended the case."""
    error: str | None
    values: dict[str, Any]
    """Dispersed values, by name."""
    numbers: dict[str, Any]
    """Numbers, truth values and texts of results in the summary, by name."""
    columns: dict[str, NDArray[np.float64]] = field(default_factory=dict)
    """Columns of the trace that the campaign keeps, by name."""


def run_case(plan: Plan, case: int, check_stop: Callable[[], None] = lambda: None) -> Outcome:
    """Run a case and return its outcome; an error of the case is part of the outcome.

    Parameters
    ----------
    plan : Plan
        Campaign.
    case : int
        Number of the case, from 0.
    check_stop : callable
        Called during the run; raises :class:`Stopped` to end the case.

    Returns
    -------
    Outcome
    """
    data, values = plan.case(case)
    built: Built | BuiltWorld | None = None
    try:
        scenario = check(data, None, {})
        with _BUILDING:
            built = build_world(scenario) if isinstance(scenario, WorldScenario) else build(scenario)
        check_stop()
        trace = built.simulation.run(scenario.simulation.duration, progress=lambda *_: check_stop())
        numbers = numbers_of(summary_of(trace, built, "complete"))
        return Outcome(case, "complete", None, values, numbers, kept_columns(trace, plan.keep))
    except Stopped:
        raise
    except Exception as error:
        status = "diverged" if isinstance(error, SimulationError) else "failed"
        return Outcome(case, status, _text(error), values, _numbers_before(error, built, status))


def keep_case(plan: Plan, case: int, folder: Path) -> Outcome:
    """Run a case in ``folder`` as an ordinary run; return its outcome without values and numbers.

    Raises
    ------
    OutputFolderError
        If the results cannot be written, as on a full disk.
    """
    begin_failure(folder)
    error, text = _error_of_run(plan.case(case).scenario, folder), None
    if error is not None:
        text, trace = _text(error), getattr(error, "trace", None)
        if trace is not None and len(trace) and not exists(folder / SUMMARY):
            raise OutputFolderError(f"cannot write {folder}: {text}", path=str(folder)) from error
    return Outcome(case, "complete" if error is None else "failed", text, {}, {})


def _error_of_run(data: dict[str, Any], folder: Path) -> Exception | None:
    """Run a scenario in a folder, whose results are replaced; return the error that ends the run, or None."""
    try:
        run(check(data, None, {}), folder, force=True, quiet=True)
    except OutputFolderError:
        raise
    except Exception as error:
        return error
    return None


class Stopped(Exception):
    """Raised in the cases that are in progress when the campaign is stopped."""


def summary_of(trace: Any, built: Built | BuiltWorld, status: str) -> dict[str, Any]:
    """Return the summary of a case, with its clearances if the case is complete."""
    if isinstance(trace, WorldTrace):
        assert isinstance(built, BuiltWorld)
        summary = summarize_world(trace, built, status=status)
    else:
        assert isinstance(built, Built)
        summary = summarize(trace, built, status=status)
    if status == "complete":
        add_clearances(summary, found_clearances(trace, built))
    return summary


def _numbers_before(error: Exception, built: Built | BuiltWorld | None, status: str) -> dict[str, Any]:
    """Return the numbers of the summary up to an error; empty if no summary can be computed."""
    trace = getattr(error, "trace", None)
    if built is None or trace is None or len(trace) == 0:
        return {}
    try:
        with np.errstate(all="ignore"):
            return numbers_of(summary_of(trace, built, status))
    except Exception:  # the error of the case is the one to report
        return {}


def _text(error: Exception) -> str:
    notes = "; ".join(getattr(error, "__notes__", ()))
    message = f"{type(error).__name__}: {error}" + (f"; {notes}" if notes else "")
    return printable(message)
