"""Control of grippers that close to a given force."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path
from typing import Annotated, Any, Literal

from onorbit_rs import _core
from onorbit_rs.scenario.control.control import Control
from onorbit_rs.scenario.control.gains import JointEffort, JointNumber, JointRates
from onorbit_rs.scenario.control.initial_mobility import InitialMobility, square
from onorbit_rs.scenario.control.law import Law, SampledGain, arguments
from onorbit_rs.scenario.fields import Force, NotNegative, Positive, Rate, Time
from onorbit_rs.scenario.part import Part


class GripForceController(Law):
    """Control law that closes the fingers of a gripper until they touch, and then to a given force.

    The fingers are moved by the joints of the group, or by joints that mimic them. The force of the grip is
    the mean normal force of the fingers, from the contacts of the scenario, which must include each finger.
    The control has no ``reference``.
    """

    kind: Literal["grip_force"] = "grip_force"
    force: Annotated[Force, Positive]
    """Desired mean of the normal forces of the fingers, N."""
    closing_rate: JointRates
    """Rate of the joints until all fingers touch, rad/s or m/s; the sign is that of the closing motion."""
    damping: JointNumber
    """Damping of the joints, N m s/rad, or N s/m for prismatic joints."""
    ramp: Annotated[Time, NotNegative] = 0.5
    """Time, s, in which the desired force increases from zero to ``force``."""
    integral: Annotated[Rate, NotNegative] = 5.0
    """Gain of the integral of the force error, 1/s."""
    stiffness: JointNumber = 0.0
    """Stiffness that keeps independent fingers from moving together with the object, N m/rad or N/m."""
    effort_limit: JointEffort | None = None
    """Largest effort, N m or N. Default: the limits in the robot's file."""

    def build_law(self, model: _core.Model, tool: str | None, folder: Path, *, runs_code: bool = True) -> Any:
        """Return the engine's control law object."""
        return _core.GripForce(
            self.force,
            ramp=self.ramp,
            integral=self.integral,
            **arguments(
                closing_rate=self.closing_rate,
                damping=self.damping,
                stiffness=self.stiffness,
                effort_limit=self.effort_limit,
            ),
        )

    def sampled_gains(self, mobility: InitialMobility) -> Iterator[SampledGain]:
        """Yield the gains whose largest stable value depends on the control period."""
        joints, of_joints = mobility.joint_count(self), mobility.of_joints(self)
        yield "integral", 1, square(self.integral, 1)
        yield "damping", 1, of_joints @ square(self.damping, joints)
        yield "stiffness", 2, of_joints @ square(self.stiffness, joints)


class ForceGoal(Part):
    """Goal of a grip: the force must be within a tolerance after the end of the ramp."""

    tolerance: Annotated[Force, Positive]
    """Largest difference between the force of the grip and the desired force, N."""
    time: Annotated[Time, NotNegative] | None = None
    """Time, s, allowed after the start of the control. Default: unlimited."""


class GripForceControl(GripForceController, Control):
    """Control of a group of joints that closes the fingers of a gripper to a given force."""

    goal: ForceGoal | None = None
    """Goal of the grip; the summary of the run contains its result."""
