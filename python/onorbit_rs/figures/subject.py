"""What the figures of a run need to know beyond its trace."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any, NamedTuple

from onorbit_rs.scenario.control import JOINT_LAWS
from onorbit_rs.scenario.load import load
from onorbit_rs.scenario.make_control import group, tool_of
from onorbit_rs.scenario.targets import Target, targets

if TYPE_CHECKING:
    from onorbit_rs._core import Earth, Model, Orbit, Trace
    from onorbit_rs.scenario import Scenario

PAPER = "humanoid_reach"
"""The bundled scenario that is the paper's experiment."""


class Tool(NamedTuple):
    """A frame that is moved by some joints, and the control that does it."""

    control: str
    frame: str
    joints: list[str]


@dataclass(frozen=True)
class Subject:
    """A run to draw. ``model`` is None where the robot's file is gone, ``mu`` where there is no planet.

    ``is_carried`` where the robot goes along with a reference that does not fall freely.
    """

    trace: Trace
    model: Model | None = None
    tools: tuple[Tool, ...] = ()
    joint_controls: dict[str, list[str]] | None = None
    mu: float | None = None
    earth: Earth | None = None
    is_the_papers: bool = False
    is_carried: bool = False
    targets: tuple[Target, ...] = ()


def subject_of(
    trace: Trace, scenario: Scenario, model: Model | None, orbit: Orbit | None, earth: Earth | None
) -> Subject:
    """From a run's scenario and what was built of it."""
    names = [] if model is None else list(model.joint_names)
    tools, joint_controls = [], {}
    for control in scenario.laws:
        driven: Any = getattr(control, "joints", None)
        joints = group(driven, names) if driven is not None and names else names
        frame = tool_of(control, scenario.tool)
        if isinstance(control, JOINT_LAWS):
            joint_controls[getattr(control, "name", "control")] = joints
        elif frame is not None:
            tools.append(Tool(getattr(control, "name", ""), frame, joints))
    return Subject(
        trace, model, tuple(tools), joint_controls, None if orbit is None else orbit.mu, earth,
        is_the_papers=_is_the_papers(scenario),
        is_carried=scenario.gravity_mode == "carried" or (orbit is not None and orbit.mu is None),
        targets=targets(scenario),
    )  # fmt: skip


def _is_the_papers(scenario: Scenario) -> bool:
    """Whether everything but the integrator's settings, and the epoch, is as the bundled scenario has it."""
    apart = ("name", "description", "epoch", "simulation")
    ours, theirs = (
        {key: value for key, value in one.resolved(Path()).items() if key not in apart}
        for one in (scenario, load(PAPER))
    )
    return ours == theirs
