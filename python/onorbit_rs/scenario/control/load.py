"""Checks the loads that controls move, and finds the controls that require a capture."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING, Any

from onorbit_rs.common.suggestions import did_you_mean, nearest
from onorbit_rs.exceptions import FrameError

if TYPE_CHECKING:
    from onorbit_rs.scenario.initial import Neighbour


def check_load(load: str | None, neighbours: Mapping[str, Neighbour]) -> None:
    """Raise an error if a load is given that is not a frame of another system.

    Raises
    ------
    FrameError
        If there is no such system or frame.
    """
    if load is None:
        return
    system, _, frame = load.partition("/")
    names = neighbours.keys() if system not in neighbours else neighbours[system].model.frame_names
    wrong = system if system not in neighbours else frame
    if wrong not in names:
        what = "system" if system not in neighbours else f"frame of {system}"
        why = f"no {what} is named {wrong!r}" if wrong else f"the {what} is missing"
        raise FrameError(
            f"{load!r} is not SYSTEM/FRAME of another system: {why}{did_you_mean(wrong, list(names))}",
            name=wrong, kind="frame", known=list(names), suggestion=nearest(wrong, list(names)),
        )  # fmt: skip


def needs_load(part: Any, events: Sequence[str]) -> bool:
    """Return True if a control moves a frame of another system or commands the internal force of a capture.

    ``events`` are the names of the events, among them the captures.
    """
    forces = {force.loop for force in part.internal_forces}
    return getattr(part, "load", None) is not None or bool(forces.intersection(events))
