"""Compliance (impedance) control of a tool."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path
from typing import Annotated, Any, Literal

from onorbit_rs import _core
from onorbit_rs.scenario.control.control import TaskControl
from onorbit_rs.scenario.control.gains import DamperGain, SpringGain
from onorbit_rs.scenario.control.initial_mobility import InitialMobility, square
from onorbit_rs.scenario.control.law import SampledGain, TaskLaw, task_law
from onorbit_rs.scenario.fields import NotNegative, Number


class ComplianceController(TaskLaw):
    """Spring and damper between the tool and its reference; dynamics and friction are not compensated."""

    kind: Literal["compliance"] = "compliance"
    stiffness: SpringGain
    """Stiffness, N/m (linear) and N m/rad (angular): one number, six numbers, or a 6 x 6 matrix; linear
    first."""
    damping: DamperGain
    """Damping, N s/m (linear) and N m s/rad (angular): one number, six numbers, or a 6 x 6 matrix."""
    null_space_damping: Annotated[Number, NotNegative] = 0.0
    """Damping of joint motion that does not move the tool, N m s/rad."""

    def build_law(self, model: _core.Model, tool: str | None, folder: Path, *, runs_code: bool = True) -> Any:
        """Return the engine's control law object."""
        return task_law(
            _core.Compliance, model, tool, stiffness=self.stiffness, damping=self.damping,
            null_space_damping=self.null_space_damping,
        )  # fmt: skip

    def sampled_gains(self, mobility: InitialMobility) -> Iterator[SampledGain]:
        """Yield the gains whose largest stable value depends on the control period.

        If the reference is in the frame ``base``, nothing is yielded.
        """
        if mobility.is_in_w(self):
            of_tool = mobility.of_tool(self)
            yield "damping", 1, of_tool @ square(self.damping, 6)
            yield "stiffness", 2, of_tool @ square(self.stiffness, 6)


class ComplianceControl(ComplianceController, TaskControl):
    """Spring and damper between a tool and its reference, acting through the joints of a joint group."""
