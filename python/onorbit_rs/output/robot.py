"""Whether the robot that a run's folder names is still the one that ran."""

from __future__ import annotations

import warnings
from typing import TYPE_CHECKING, Any

from onorbit_rs.exceptions import IntegrityError, OnOrbitError
from onorbit_rs.output.read import SavedRun
from onorbit_rs.robots.fingerprint import is_another
from onorbit_rs.scenario.make_robot import make_robot

if TYPE_CHECKING:
    from onorbit_rs._core import Model

CHANGED = "the robot's file was changed since the run: it is not the robot that was recorded"


def was_changed(model: Model, summary: dict[str, Any]) -> bool:
    """Whether a robot is not the one of a run; of runs of earlier versions nobody knows."""
    return is_another(model, summary.get("robot_fingerprint"))


def remark_on_robot(saved: SavedRun, summary: dict[str, Any]) -> str | None:
    """What is to be said where the robot of a folder's run was changed since, or is gone; None where not.

    Raises
    ------
    IntegrityError
        The folder's scenario was changed since the run.
    """
    try:
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")  # what the file is like was told when it ran
            model = make_robot(saved.scenario())
    except IntegrityError:
        raise
    except OnOrbitError as error:
        return f"the robot of the run cannot be read again: {error}"
    return CHANGED if was_changed(model, summary) else None
