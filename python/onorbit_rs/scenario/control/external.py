"""Joints that follow commands from outside the run."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path
from typing import Annotated, Any, Literal

from onorbit_rs import _core
from onorbit_rs.scenario.control.control import JointControl
from onorbit_rs.scenario.control.gains import JointRateGain, JointStiffnessGain
from onorbit_rs.scenario.control.initial_mobility import InitialMobility, square
from onorbit_rs.scenario.control.law import JointLaw, SampledGain, arguments
from onorbit_rs.scenario.fields import Positive, Time


class ExternalController(JointLaw):
    """Joints that follow commands from outside: a file of commands, or a program that advances the run.

    Each command is held until the next one. Positions, velocities and trajectories are tracked by computed
    torque in joint space; a command that contains only efforts sets the joint efforts directly. There is no
    ``reference``.
    """

    kind: Literal["external"] = "external"
    kp: JointStiffnessGain = 0.0
    """Gain of the position errors, 1/s²; required for commands of positions or trajectories, such as 100."""
    kd: JointRateGain = 0.0
    """Gain of the rate errors, 1/s; required for commands of velocities, such as 20."""
    timeout: Annotated[Time, Positive] | None = None
    """Time without a command, s, after which ``on_timeout`` applies. Default: never."""
    on_timeout: Literal["hold", "damp", "zero"] = "hold"
    """Behaviour after a timeout: ``hold`` keeps the positions, ``damp`` brings the joints to rest with
    ``kd``, and ``zero`` sets zero torques."""
    compensate_environment: bool = True
    """Whether the wrenches of the environment are compensated while positions or velocities are commanded."""
    compensate_friction: bool = True
    """Whether damping and Coulomb friction of the joints are compensated while positions or velocities are
    commanded."""

    def build_law(self, model: _core.Model, tool: str | None, folder: Path, *, runs_code: bool = True) -> Any:
        """Return the engine's control law object."""
        return _core.External(
            **arguments(kp=self.kp, kd=self.kd, timeout=self.timeout),
            on_timeout=self.on_timeout,
            compensate_environment=self.compensate_environment,
            compensate_friction=self.compensate_friction,
        )

    def sampled_gains(self, mobility: InitialMobility) -> Iterator[SampledGain]:
        """Yield the gains whose largest stable value depends on the control period."""
        joints = mobility.joint_count(self)
        yield "kd", 1, square(self.kd, joints)
        yield "kp", 2, square(self.kp, joints)

    def without_commands(self) -> str:
        """Return a clause for messages that describes how the joints behave before the first command."""
        has_kp, has_kd = (bool(gain) and (gain if isinstance(gain, float) else min(gain)) > 0.0
                          for gain in (self.kp, self.kd))  # fmt: skip
        if has_kp:
            return "its joints hold their initial positions"
        return "its joints are brought to rest" if has_kd else "its joints have no torque"


class ExternalControl(ExternalController, JointControl):
    """Joints of a group that follow commands from outside the run."""
