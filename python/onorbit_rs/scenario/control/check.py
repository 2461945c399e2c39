"""Checks that controllers, references and tools of a scenario are consistent."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from onorbit_rs.common.suggestions import did_you_mean
from onorbit_rs.scenario.control.external import ExternalController
from onorbit_rs.scenario.control.grip_force import GripForceController
from onorbit_rs.scenario.control.law import JointLaw, TaskLaw
from onorbit_rs.scenario.control.selection import tool_of
from onorbit_rs.scenario.errors import inconsistent
from onorbit_rs.scenario.reference import HoldReference, JointHoldReference, TaskReference
from onorbit_rs.scenario.reference.frame import moving_frame

if TYPE_CHECKING:
    from onorbit_rs.scenario.schema import Scenario
    from onorbit_rs.scenario.yaml_lines import Location


def check_control(scenario: Scenario, events: list[str], systems: list[str]) -> None:
    """Raise an error for inconsistent controllers; set the default reference, a constant pose or position.

    ``events`` are the names of the events of the world, after which a control may start. ``systems`` are the
    names of the other systems, in whose frames references may be given.
    """
    if scenario.controllers is not None:
        if scenario.controller is not None:
            raise inconsistent(
                "controllers", "'controller' and 'controllers' are both given; omit one of them"
            )
        if scenario.reference is not None:
            raise inconsistent(
                "reference",
                "with 'controllers', each controller has its own reference; move this 'reference' into one "
                "of the controllers",
            )
        _check_names(scenario.controllers, events)
        for index, control in enumerate(scenario.controllers):
            tool = tool_of(control, scenario.tool)
            control.reference = _checked(control, control.reference, tool, scenario, ("controllers", index))
            _check_frame(control.reference, systems, ("controllers", index))
    elif scenario.controller is not None:
        scenario.reference = _checked(scenario.controller, scenario.reference, scenario.tool, scenario, ())
        _check_frame(scenario.reference, systems, ())
    elif scenario.reference is not None:
        raise inconsistent(
            "reference", "a reference requires a 'controller'; add a controller or remove the reference"
        )


def _check_names(controls: list[Any], events: list[str]) -> None:
    """Raise an error for duplicate names, an unknown name in ``after``, or ``after`` with ``start``."""
    names = [control.name for control in controls]
    for index, control in enumerate(controls):
        at: Location = ("controllers", index)
        if control.name in names[:index]:
            raise inconsistent(
                (*at, "name"), f"two controllers are named {control.name!r}; names must be unique"
            )
        if control.after is None:
            continue
        others = [*(name for name in names if name != control.name), *events]
        if control.after not in others:
            what = "other controller or event" if events else "other controller"
            hint = did_you_mean(control.after, others)
            raise inconsistent((*at, "after"), f"no {what} is named {control.after!r}{hint}")
        if control.start != 0.0:
            raise inconsistent(
                (*at, "start"),
                "'start' (a time) and 'after' (a controller or event) are both given; omit one of them",
            )


def _check_frame(reference: Any, systems: list[str], at: Location) -> None:
    """Raise an error if a reference is given in a frame of a system that does not exist."""
    path = moving_frame(getattr(reference, "frame", None))
    if path is not None and path[0] not in systems:
        message = f"no other system is named {path[0]!r}{did_you_mean(path[0], systems)}"
        raise inconsistent((*at, "reference", "frame"), message)


def _checked(law: Any, reference: Any, tool: str | None, scenario: Scenario, at: Location) -> Any:
    """Return the reference of a control law, or the default; raise an error if it does not suit the law."""
    kind, is_task = law.kind, isinstance(reference, TaskReference)
    if isinstance(law, (ExternalController, GripForceController)):
        return _without_reference(law, reference, at)
    if isinstance(law, JointLaw):
        if is_task:
            raise inconsistent(
                (*at, "reference"),
                f"the reference {reference.kind} is for a tool, but the controller {kind} accepts only joint "
                "references; use a joint reference (joint_hold, joint_waypoints, joint_ramps, joint_sampled, "
                "bag), or the controller computed_torque",
            )
        if reference is None and getattr(law, "interface", None) == "effort":
            raise inconsistent(
                (*at, "reference"),
                "with interface effort, the values of the reference are efforts, so a reference is required; "
                "use joint_sampled or joint_hold",
            )
        return reference or JointHoldReference()
    if reference is not None and not is_task:
        raise inconsistent(
            (*at, "reference"),
            f"the reference {reference.kind} is for joints, but the controller {kind} accepts only tool "
            "references; use a tool reference (hold, line, waypoints, ...), or the controller "
            "joint_computed_torque",
        )
    if isinstance(law, TaskLaw) and reference is None:
        reference = HoldReference()
    if reference is not None and tool is None:
        raise inconsistent((*at, "tool"), "'tool' is missing; give the frame that the controller moves")
    if getattr(reference, "frame", None) == "lvlh" and scenario.orbit is None:
        raise inconsistent(
            (*at, "reference", "frame"), "frame lvlh requires an orbit; add 'orbit' or use another frame"
        )
    return reference


def _without_reference(law: ExternalController | GripForceController, reference: Any, at: Location) -> None:
    """Raise an error if a law that uses no reference has one, or another key that would have no effect."""
    is_external = isinstance(law, ExternalController)
    why = "gets its motion from commands" if is_external else "grips with a given force"
    for key, given in [
        ("reference", reference is not None),
        ("goal", is_external and getattr(law, "goal", None) is not None),
        ("starts_at_present", getattr(law, "starts_at_present", False)),
        ("internal_forces", not is_external and bool(getattr(law, "internal_forces", None))),
    ]:
        if given:
            raise inconsistent(
                (*at, key),
                f"the controller {law.kind} {why}, so it has no '{key}'; remove this key, or use the "
                "controller joint_computed_torque",
            )
