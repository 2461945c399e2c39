"""Controllers. A new kind is one class with its own ``kind``, added to its union and to ``controls``."""

from __future__ import annotations

from typing import Annotated, Any, ClassVar, Literal, Self

from pydantic import Field, model_validator

from onorbit_rs.scenario.fields import FilePath, NotNegative, Number, Rate
from onorbit_rs.scenario.gains import (
    DamperGain,
    JointEffort,
    JointNumber,
    JointRateGain,
    JointStiffnessGain,
    RateGain,
    SpringGain,
    StiffnessGain,
)
from onorbit_rs.scenario.part import Part, of_kind
from onorbit_rs.scenario.refusals import wrong


class ComputedTorqueController(Part):
    """The paper's Eq. (6)-(8) in task space, with the exact drift."""

    kind: Literal["computed_torque"] = "computed_torque"
    kp: StiffnessGain = 100.0
    """On the pose error, 1/s²: a number, six, or 6 x 6; linear first."""
    kd: RateGain = 20.0
    """On the velocity error, 1/s."""
    damping: Annotated[Number, NotNegative] = 0.05
    """Of the pseudo-inverse near singularities."""
    null_space_damping: Annotated[Rate, NotNegative] = 0.0
    """On the motion that does not move the tool, 1/s; brings a redundant arm to rest."""
    compensate_environment: bool = True
    """Whether the controller knows the wrenches of the environment."""
    compensate_friction: bool = True
    """Whether damping and Coulomb friction of the joints are compensated, at rest too."""


class JointComputedTorqueController(Part):
    """Computed torque on the joints themselves: exact whatever the base does."""

    kind: Literal["joint_computed_torque"] = "joint_computed_torque"
    kp: JointStiffnessGain = 100.0
    """On the position errors, 1/s²: a number, or one for each joint."""
    kd: JointRateGain = 20.0
    """On the rate errors, 1/s."""
    compensate_environment: bool = True
    compensate_friction: bool = True


class JointPidController(Part):
    """A PID for each joint, after the interfaces of ROS Control; ignores friction. Gains: bare SI numbers."""

    other_words: ClassVar = {"kp": "p", "ki": "i", "kd": "d", "i_clamp": "i_limit"}

    kind: Literal["joint_pid"] = "joint_pid"
    interface: Literal["position", "velocity", "effort"] = "position"
    """What the reference says; of ``effort``, its positions are the efforts, N m (N)."""
    p: JointNumber = 0.0
    """N m per rad (per rad/s of ``velocity``)."""
    i: JointNumber = 0.0
    d: JointNumber = 0.0
    i_limit: JointEffort | None = None
    """Largest share of the integral, N m."""
    effort_limit: JointEffort | None = None
    """Largest effort, N m (N where a joint slides); the limits of the robot's file where not given."""

    @model_validator(mode="after")
    def _has_gains(self) -> Self:
        """Of ``effort`` the reference is the effort; else a PID without gains would leave the joints limp."""
        if self.interface != "effort" and not self.model_fields_set & {"p", "i", "d"}:
            raise wrong(
                f"a PID of interface {self.interface} without gains does nothing: give 'p', 'i' or 'd', or no"
                " controller where the joints are to be limp"
            )
        return self


class ComplianceController(Part):
    """The tool on a spring and a damper; nothing is compensated, not friction either."""

    kind: Literal["compliance"] = "compliance"
    stiffness: SpringGain
    """N/m, then N m/rad: a number, six, or 6 x 6."""
    damping: DamperGain
    """N s/m, then N m s/rad."""
    null_space_damping: Annotated[Number, NotNegative] = 0.0
    """N m s/rad."""


class PythonController(Part):
    """A class of yours with ``update(t, state)``; its file is run as Python."""

    kind: Literal["python"] = "python"
    file: FilePath | None = None
    """Beside the scenario."""
    module: str | None = None
    """Or one that can be imported."""
    class_: str = Field(alias="class")
    arguments: dict[str, Any] = Field(default_factory=dict)
    """Of its constructor, by name."""

    @model_validator(mode="after")
    def _says_where(self) -> PythonController:
        if (self.file is None) == (self.module is None):
            raise wrong("give exactly one of 'file' (beside the scenario) and 'module'")
        return self


TASK_LAWS = (ComputedTorqueController, ComplianceController)
JOINT_LAWS = (JointComputedTorqueController, JointPidController)

AnyController = (
    ComputedTorqueController
    | JointComputedTorqueController
    | JointPidController
    | ComplianceController
    | PythonController
)
Controller = Annotated[AnyController, Field(discriminator="kind"), of_kind(AnyController)]
