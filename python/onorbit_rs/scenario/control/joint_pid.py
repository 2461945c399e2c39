"""PID controllers of joints."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path
from typing import Any, ClassVar, Literal, Self

from pydantic import model_validator

from onorbit_rs import _core
from onorbit_rs.scenario.control.control import JointControl
from onorbit_rs.scenario.control.gains import JointEffort, JointNumber
from onorbit_rs.scenario.control.initial_mobility import InitialMobility, square
from onorbit_rs.scenario.control.law import JointLaw, SampledGain, arguments
from onorbit_rs.scenario.errors import invalid


class JointPidController(JointLaw):
    """One PID controller per joint, with the interfaces of ROS Control; gains are plain numbers in SI units.

    Friction is not compensated.
    """

    synonyms: ClassVar = {"kp": "p", "ki": "i", "kd": "d", "i_clamp": "i_limit"}

    kind: Literal["joint_pid"] = "joint_pid"
    interface: Literal["position", "velocity", "effort"] = "position"
    """Quantity that the reference prescribes; with ``effort``, its values are efforts, N m or N."""
    p: JointNumber = 0.0
    """Proportional gain, N m/rad, or N m s/rad with ``velocity``; N/m or N s/m for prismatic joints."""
    i: JointNumber = 0.0
    """Integral gain, in the unit of ``p`` per second."""
    d: JointNumber = 0.0
    """Derivative gain, in the unit of ``p`` times one second."""
    i_limit: JointEffort | None = None
    """Largest contribution of the integral, N m or N."""
    effort_limit: JointEffort | None = None
    """Largest effort, N m or N. Default: the limits in the robot's file."""

    @model_validator(mode="after")
    def _has_gains(self) -> Self:
        """Raise an error if all gains are missing, which would leave the joints passive."""
        if self.interface != "effort" and not self.model_fields_set & {"p", "i", "d"}:
            raise invalid(
                f"a PID with interface {self.interface} has no gains; give 'p', 'i' or 'd', or"
                " omit the controller to leave the joints passive"
            )
        return self

    @property
    def tracks_rates(self) -> bool:
        """True for ``velocity``."""
        return self.interface == "velocity"

    def build_law(self, model: _core.Model, tool: str | None, folder: Path, *, runs_code: bool = True) -> Any:
        """Return the engine's control law object."""
        return _core.JointPid(
            interface=self.interface,
            **arguments(p=self.p, i=self.i, d=self.d, i_limit=self.i_limit, effort_limit=self.effort_limit),
        )

    def sampled_gains(self, mobility: InitialMobility) -> Iterator[SampledGain]:
        """Yield the gains whose largest stable value depends on the control period; none for ``effort``."""
        if self.interface == "effort":
            return
        joints, of_joints = mobility.joint_count(self), mobility.of_joints(self)
        yield "p", 1 if self.tracks_rates else 2, of_joints @ square(self.p, joints)
        if not self.tracks_rates:
            yield "d", 1, of_joints @ square(self.d, joints)


class JointPidControl(JointPidController, JointControl):
    """One PID controller for each joint of a joint group."""
