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
"""Key of a gain, its order (1: rate, 2: position), and the acceleration per error."""


class Law(Part, ABC):
    """Control law."""

    @abstractmethod
    def build_law(self, model: Model, tool: str | None, folder: Path, *, runs_code: bool = True) -> Any:
        """Return the control law of the engine.

        Parameters
        ----------
        model : Model
        tool : str, optional
            The frame that is controlled, if the law controls one.
        folder : path
            Folder of the scenario.
        runs_code : bool
            Whether to execute the user's code; otherwise it is inspected and replaced by a placeholder.
        """

    def sampled_gains(self, mobility: InitialMobility) -> Iterator[SampledGain]:
        """Yield the gains for which errors grow if they are too high for the control period.

        Parameters
        ----------
        mobility : InitialMobility
            The robot at the start of the run.

        Yields
        ------
        SampledGain
            Key of the gain, its order (1: rate, 2: position), and the acceleration per error, a matrix.
        """
        yield from ()


class TaskLaw(Law):
    """Control law of a tool."""


class JointLaw(Law):
    """Control law of joints."""


def arguments(**values: Any) -> dict[str, Any]:
    """Return the keyword arguments for the engine: lists become arrays, None is omitted."""
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
        If a gain is invalid or too few joints move the tool; suggests other laws in the second case.
    """
    try:
        return law(model, tool, **arguments(**gains))
    except ControlError as error:
        if error.name is None:  # the error is not about a gain, but about the joints that move the tool
            error.message += "; use joint_computed_torque for the joints, or compliance for the tool"
        raise
