"""Data of a run that its figures need in addition to its trace."""

from __future__ import annotations

from dataclasses import dataclass, replace
from pathlib import Path
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from onorbit_rs.figures.grip import Grip
from onorbit_rs.scenario.control import GripForceController, JointLaw, rate_controls
from onorbit_rs.scenario.control.fingers import finger_contacts
from onorbit_rs.scenario.control.selection import joint_group, tool_of
from onorbit_rs.scenario.load import load
from onorbit_rs.scenario.targets import Target, targets

if TYPE_CHECKING:
    from onorbit_rs._core import Earth, Model, Orbit, Trace, WorldTrace
    from onorbit_rs.scenario import Scenario, WorldScenario

PAPER = "humanoid_reach"
"""The bundled scenario of the experiment in the OnOrbitROS paper."""


class Tool(NamedTuple):
    """A controlled frame, with the control and the joints that move it."""

    control: str
    frame: str
    joints: list[str]


@dataclass(frozen=True)
class Subject:
    """Run whose figures are drawn, with the data that the figures need.

    Attributes
    ----------
    trace : Trace
        Trace of the run.
    model : Model or None
        Robot; None if its file cannot be read or has changed since the run.
    tools : tuple of Tool
        Controlled frames.
    joint_controls : dict
        Names of the joints of each control in joint space, by the name of the control.
    rate_controls : tuple of str
        Controls in joint space whose errors are those of joint rates.
    grips : dict
        Controls that close a gripper, by their names.
    mu : float or None
        Gravitational parameter, m³/s²; None without a planet.
    earth : Earth or None
        Earth of the run, if it has one.
    is_the_papers : bool
        Whether the run is the experiment of the OnOrbitROS paper.
    is_carried : bool
        Whether the robot moves with a reference that is not in free fall.
    targets : tuple of Target
        Target spacecraft that references follow.
    """

    trace: Trace
    model: Model | None = None
    tools: tuple[Tool, ...] = ()
    joint_controls: dict[str, list[str]] | None = None
    grips: dict[str, Grip] | None = None
    mu: float | None = None
    earth: Earth | None = None
    is_the_papers: bool = False
    is_carried: bool = False
    targets: tuple[Target, ...] = ()
    rate_controls: tuple[str, ...] = ()


def subject_of(
    trace: Trace, scenario: Scenario, model: Model | None, orbit: Orbit | None, earth: Earth | None
) -> Subject:
    """Return the subject of the figures from the scenario of a run and the objects built from it."""
    names = [] if model is None else list(model.joint_names)
    tools, joint_controls, grips = [], {}, {}
    for control in scenario.laws:
        driven: Any = getattr(control, "joints", None)
        joints = joint_group(driven, names) if driven is not None and names else names
        frame = tool_of(control, scenario.tool)
        if isinstance(control, JointLaw):
            joint_controls[getattr(control, "name", "control")] = joints
        elif isinstance(control, GripForceController):
            grips[getattr(control, "name", "control")] = Grip(control.force, control.ramp)
        elif frame is not None:
            tools.append(Tool(getattr(control, "name", ""), frame, joints))
    return Subject(
        trace, model, tuple(tools), joint_controls, grips, None if orbit is None else orbit.mu, earth,
        is_the_papers=_is_the_papers(scenario),
        is_carried=scenario.gravity_mode == "carried" or (orbit is not None and orbit.mu is None),
        targets=targets(scenario),
        rate_controls=rate_controls(scenario.controllers),
    )  # fmt: skip


def with_fingers(subject: Subject, system: str, scenario: WorldScenario, trace: WorldTrace) -> Subject:
    """Return the subject with the contacts of the fingers of its grippers, and their normal forces."""
    if subject.model is None or not subject.grips:
        return subject
    grips = dict(subject.grips)
    for control in scenario.scenarios[system].laws:
        if isinstance(control, GripForceController):
            fingers = finger_contacts(control, system, subject.model, scenario.contacts)
            contacts = {name: trace.contacts[name] for names in fingers for name in names}
            pressures = {
                name: np.einsum("ti,ti->t", contact.force, contact.normal)
                for name, contact in contacts.items()
            }
            name = getattr(control, "name", "control")
            grips[name] = replace(grips[name], fingers=fingers, pressures=pressures)
    return replace(subject, grips=grips)


def _is_the_papers(scenario: Scenario) -> bool:
    """Return True if the scenario equals that of the paper except for texts, epoch and run settings."""
    ignored = ("name", "description", "epoch", "simulation")
    given, bundled = (
        {key: value for key, value in one.resolved(Path()).items() if key not in ignored}
        for one in (scenario, load(PAPER))
    )
    return given == bundled
