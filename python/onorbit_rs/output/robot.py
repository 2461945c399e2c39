"""Checks whether the robot of a run was changed after the run."""

from __future__ import annotations

import warnings
from typing import TYPE_CHECKING, Any

from onorbit_rs.exceptions import IntegrityError, OnOrbitError
from onorbit_rs.output.read import SavedRun
from onorbit_rs.robots.fingerprint import has_changed
from onorbit_rs.scenario import WorldScenario

if TYPE_CHECKING:
    from onorbit_rs._core import Model

CHANGED = (
    "the robot differs from that of the run; undo the changes to its file and to the files that it includes, "
    "or repeat the run"
)


def was_changed(model: Model, summary: dict[str, Any]) -> bool:
    """Return True if the robot differs from that of the run; False if the summary has no fingerprint."""
    return has_changed(model, summary.get("robot_fingerprint"))


def remark_on_robot(saved: SavedRun, summary: dict[str, Any]) -> str | None:
    """Return a remark if the robot of a run was changed or cannot be read; None otherwise.

    Raises
    ------
    IntegrityError
        If the scenario in the folder was changed after the run.
    """
    try:
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")  # the warnings were issued during the run
            scenario = saved.scenario()
            if isinstance(scenario, WorldScenario):
                robots = [
                    (alone, summary["systems"].get(name, {})) for name, alone in scenario.scenarios.items()
                ]
            else:
                robots = [(scenario, summary)]
            models = [(alone.robot.build(alone), own) for alone, own in robots]
    except IntegrityError:
        raise
    except OnOrbitError as error:
        return f"the robot of the run cannot be read again: {error}"
    return CHANGED if any(was_changed(model, own) for model, own in models) else None
