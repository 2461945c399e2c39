"""Base classes of control laws."""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import TYPE_CHECKING, Any, Literal

import numpy as np
from numpy.typing import NDArray

from onorbit_rs._core import Model
from onorbit_rs.exceptions import ControlError
from onorbit_rs.scenario.part import Part

if TYPE_CHECKING:
    from onorbit_rs.scenario.control.initial_mobility import InitialMobility

SampledGain = tuple[str, Literal[1, 2], NDArray[np.float64]]
"""Key of a gain, its order (1: rate, 2: position), and the acceleration per unit error."""


class Law(Part, ABC):
    """Control law of a scenario, without its reference and schedule."""

    @abstractmethod
    def build_law(self, model: Model, tool: str | None, folder: Path, *, runs_code: bool = True) -> Any:
        """Return the engine's control law object.

        Parameters
        ----------
        model : Model
            Robot.
        tool : str, optional
            Controlled frame; required by laws of a tool.
        folder : path
            Folder of the scenario.
        runs_code : bool
            Whether to execute the user's code; otherwise it is inspected and replaced by a placeholder.
        """

    def sampled_gains(self, mobility: InitialMobility) -> Iterator[SampledGain]:
        """Yield the gains with which errors grow if the control period is too long; by default none.

        Parameters
        ----------
        mobility : InitialMobility
            The robot at the start of the run.

        Yields
        ------
        SampledGain
            Key of the gain, its order (1: rate, 2: position), and the matrix of the acceleration per unit
            error.
        """
        yield from ()


class TaskLaw(Law):
    """Control law that makes a tool track a reference in task space."""


class JointLaw(Law):
    """Control law that makes joints track a reference in joint space."""

    @property
    def tracks_rates(self) -> bool:
        """True if the tracking errors are those of the joint rates, rad/s and m/s, not of the positions."""
        return False


def arguments(**values: Any) -> dict[str, Any]:
    """Return keyword arguments for the engine: lists are converted to arrays, and None is omitted."""
    return {
        name: np.array(value) if isinstance(value, list) else value
        for name, value in values.items()
        if value is not None
    }


def task_law(law: Callable[..., Any], model: Model, tool: str | None, **gains: Any) -> Any:
    """Return a control law of the engine for a tool.

    Raises
    ------
    ControlError
        If a gain is invalid, or if too few joints move the tool; the latter message suggests other laws.
    """
    try:
        return law(model, tool, **arguments(**gains))
    except ControlError as error:
        if error.name is None:  # too few joints move the tool
            error.message += "; use joint_computed_torque for the joints, or compliance for the tool"
        raise
