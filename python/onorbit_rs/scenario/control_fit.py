"""Whether controllers, references and tools of a scenario fit together."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from onorbit_rs.names import did_you_mean
from onorbit_rs.scenario import control as laws
from onorbit_rs.scenario import reference_parts as references
from onorbit_rs.scenario.joint_reference_parts import JointHoldReference
from onorbit_rs.scenario.refusals import misfit

if TYPE_CHECKING:
    from onorbit_rs.scenario.schema import Scenario
    from onorbit_rs.scenario.yaml_lines import Location


def check_control(scenario: Scenario) -> None:
    """Complain of what does not fit, and give a law that needs a reference the one that holds still."""
    if scenario.controllers is not None:
        if scenario.controller is not None:
            raise misfit("controllers", "give either one 'controller' or a list of 'controllers'")
        if scenario.reference is not None:
            raise misfit(
                "reference", "with 'controllers' each has its own 'reference': move it into one of them"
            )
        _check_names(scenario.controllers)
        for index, control in enumerate(scenario.controllers):
            tool = getattr(control, "tool", None) or scenario.tool
            control.reference = _fitting(control, control.reference, tool, scenario, ("controllers", index))
    elif scenario.controller is not None:
        scenario.reference = _fitting(scenario.controller, scenario.reference, scenario.tool, scenario, ())
    elif scenario.reference is not None:
        raise misfit("reference", "a reference needs a 'controller' that tracks it")


def _check_names(controls: list[Any]) -> None:
    names = [control.name for control in controls]
    for index, control in enumerate(controls):
        at: Location = ("controllers", index)
        if control.name in names[:index]:
            raise misfit((*at, "name"), f"two controllers are named {control.name!r}: give each its own name")
        if control.after is None:
            continue
        others = [name for name in names if name != control.name]
        if control.after not in others:
            hint = did_you_mean(control.after, others)
            raise misfit((*at, "after"), f"no other controller is named {control.after!r}{hint}")
        if control.start != 0.0:
            raise misfit((*at, "start"), "give either 'start' (a time) or 'after' (another controller)")


def _fitting(law: Any, reference: Any, tool: str | None, scenario: Scenario, at: Location) -> Any:
    """The reference of a law, checked."""
    is_task = isinstance(reference, references.TaskReference)
    if isinstance(law, laws.JOINT_LAWS):
        if is_task:
            raise misfit(
                (*at, "reference"),
                f"{reference.kind} moves a tool, {law.kind} drives joints: take a reference of joints "
                "(joint_hold, joint_waypoints, joint_ramps, joint_sampled), or computed_torque as controller",
            )
        if reference is None and getattr(law, "interface", None) == "effort":
            raise misfit(
                (*at, "reference"),
                "efforts are commanded as they are: say which, with joint_sampled or joint_hold",
            )
        return reference or JointHoldReference()
    if reference is not None and not is_task:
        raise misfit(
            (*at, "reference"),
            f"{reference.kind} moves joints, {law.kind} tracks a tool: take a reference of a tool (hold, "
            "line, waypoints, ...), or the controller joint_computed_torque",
        )
    if isinstance(law, laws.TASK_LAWS) and reference is None:
        reference = references.HoldReference()
    if reference is not None and tool is None:
        raise misfit((*at, "tool"), "the controller tracks a frame: name it with 'tool'")
    if getattr(reference, "frame", None) == "lvlh" and scenario.orbit is None:
        raise misfit((*at, "reference", "frame"), "the frame lvlh needs an 'orbit'")
    return reference
