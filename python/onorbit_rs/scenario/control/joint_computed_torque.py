"""Computed torque in joint space."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path
from typing import Any, Literal

from onorbit_rs import _core
from onorbit_rs.scenario.control.control import JointControl
from onorbit_rs.scenario.control.gains import JointRateGain, JointStiffnessGain
from onorbit_rs.scenario.control.initial_mobility import InitialMobility, square
from onorbit_rs.scenario.control.law import JointLaw, SampledGain, arguments


class JointComputedTorqueController(JointLaw):
    """Computed torque in joint space; the feedforward is exact for any motion of the free base."""

    kind: Literal["joint_computed_torque"] = "joint_computed_torque"
    kp: JointStiffnessGain = 100.0
    """Gain of the position errors, 1/s²: one number for all joints, or one number per joint."""
    kd: JointRateGain = 20.0
    """Gain of the rate errors, 1/s: one number for all joints, or one number per joint."""
    compensate_environment: bool = True
    """Whether the wrenches of the environment are compensated."""
    compensate_friction: bool = True
    """Whether damping and Coulomb friction of the joints are compensated, including at rest."""

    def build_law(self, model: _core.Model, tool: str | None, folder: Path, *, runs_code: bool = True) -> Any:
        """Return the engine's control law object."""
        return _core.JointComputedTorque(
            **arguments(kp=self.kp, kd=self.kd),
            compensate_environment=self.compensate_environment,
            compensate_friction=self.compensate_friction,
        )

    def sampled_gains(self, mobility: InitialMobility) -> Iterator[SampledGain]:
        """Yield the gains whose largest stable value depends on the control period."""
        joints = mobility.joint_count(self)
        yield "kd", 1, square(self.kd, joints)
        yield "kp", 2, square(self.kp, joints)


class JointComputedTorqueControl(JointComputedTorqueController, JointControl):
    """Computed torque in joint space for the joints of a joint group."""
