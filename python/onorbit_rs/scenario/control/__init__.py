"""Controllers of scenarios; a control law is one file with two classes, each in one of the unions below.

``docs/howto/controller.md``, "Add a law to the engine", lists the necessary changes in other folders.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Annotated

from pydantic import Field

from onorbit_rs.scenario.control.compliance import ComplianceControl, ComplianceController
from onorbit_rs.scenario.control.computed_torque import ComputedTorqueControl, ComputedTorqueController
from onorbit_rs.scenario.control.external import ExternalControl, ExternalController
from onorbit_rs.scenario.control.grip_force import GripForceControl, GripForceController
from onorbit_rs.scenario.control.joint_computed_torque import (
    JointComputedTorqueControl,
    JointComputedTorqueController,
)
from onorbit_rs.scenario.control.joint_pid import JointPidControl, JointPidController
from onorbit_rs.scenario.control.law import JointLaw
from onorbit_rs.scenario.control.python import PythonControl, PythonController
from onorbit_rs.scenario.part import of_kind

__all__ = [
    "AnyControl",
    "AnyController",
    "Controller",
    "ExternalController",
    "GripForceController",
    "JointLaw",
    "JointPidController",
    "PythonController",
    "grip_controls",
    "rate_controls",
]

AnyController = (
    ComputedTorqueController
    | JointComputedTorqueController
    | JointPidController
    | ComplianceController
    | GripForceController
    | ExternalController
    | PythonController
)
Controller = Annotated[AnyController, Field(discriminator="kind"), of_kind(AnyController)]

_Controls = (
    ComputedTorqueControl
    | ComplianceControl
    | JointComputedTorqueControl
    | JointPidControl
    | GripForceControl
    | ExternalControl
    | PythonControl
)
AnyControl = Annotated[_Controls, Field(discriminator="kind"), of_kind(_Controls)]


def grip_controls(controls: Sequence[AnyControl] | None) -> tuple[str, ...]:
    """Return the names of the controls that close a gripper to a force."""
    return tuple(control.name for control in controls or () if isinstance(control, GripForceController))


def rate_controls(controls: Sequence[AnyControl] | None) -> tuple[str, ...]:
    """Return the names of the controls whose tracking errors are errors of joint rates."""
    joint_laws = (control for control in controls or () if isinstance(control, JointLaw))
    return tuple(control.name for control in joint_laws if control.tracks_rates)
