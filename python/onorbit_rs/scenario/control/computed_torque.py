"""Computed torque in task space."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path
from typing import Annotated, Any, Literal

from onorbit_rs import _core
from onorbit_rs.scenario.control.control import TaskControl
from onorbit_rs.scenario.control.gains import RateGain, StiffnessGain
from onorbit_rs.scenario.control.initial_mobility import InitialMobility, square
from onorbit_rs.scenario.control.law import SampledGain, TaskLaw, task_law
from onorbit_rs.scenario.fields import NotNegative, Number, Rate


class ComputedTorqueController(TaskLaw):
    """Computed torque in task space, Eq. (6)-(8) of the OnOrbitROS paper, with the exact drift term."""

    kind: Literal["computed_torque"] = "computed_torque"
    kp: StiffnessGain = 100.0
    """Gain of the pose error, 1/s²: one number, six numbers, or a 6 x 6 matrix; linear first."""
    kd: RateGain = 20.0
    """Gain of the velocity error, 1/s; one number, six numbers, or a 6 x 6 matrix; linear first."""
    damping: Annotated[Number, NotNegative] = 0.05
    """Largest damping of the pseudo-inverse, in the units of the singular values of the generalized Jacobian;
    the damping is zero unless a lower bound of the smallest singular value is below this number."""
    null_space_damping: Annotated[Rate, NotNegative] = 0.0
    """Damping of joint motion that does not move the tool, 1/s; brings a redundant arm to rest."""
    compensate_environment: bool = True
    """Whether the wrenches of the environment are compensated."""
    compensate_friction: bool = True
    """Whether damping and Coulomb friction of the joints are compensated, including at rest."""

    def build_law(self, model: _core.Model, tool: str | None, folder: Path, *, runs_code: bool = True) -> Any:
        """Return the engine's control law object."""
        return task_law(
            _core.ComputedTorque, model, tool, kp=self.kp, kd=self.kd, damping=self.damping,
            null_space_damping=self.null_space_damping, compensate_environment=self.compensate_environment,
            compensate_friction=self.compensate_friction,
        )  # fmt: skip

    def sampled_gains(self, mobility: InitialMobility) -> Iterator[SampledGain]:
        """Yield the gains whose largest stable value depends on the control period."""
        yield "kd", 1, square(self.kd, 6)
        yield "kp", 2, square(self.kp, 6)
        yield "null_space_damping", 1, square(self.null_space_damping, 1)


class ComputedTorqueControl(ComputedTorqueController, TaskControl):
    """Computed torque in task space, acting through the joints of a joint group."""
