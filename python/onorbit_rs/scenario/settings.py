"""How the run is integrated and recorded."""

from __future__ import annotations

import math
from typing import Annotated, ClassVar, Literal

from pydantic import Field, model_validator

from onorbit_rs.scenario.fields import Drift, NotNegative, Number, Positive, Time, Whole
from onorbit_rs.scenario.part import Part
from onorbit_rs.scenario.refusals import wrong

NotNegativeNumber = Annotated[Number, NotNegative]
MAX_STEPS = 10**10
MAX_ROWS = 10**7
"""Of the trace; a row is about half a kilobyte."""


class SimulationSettings(Part):
    """Times in seconds of simulation."""

    other_words: ClassVar = {
        "dt": "time_step", "step": "time_step", "timestep": "time_step", "end": "duration",
    }  # fmt: skip

    duration: Annotated[Time, Positive]
    time_step: Annotated[Time, Positive] = 1e-3
    control_period: Annotated[Time, Positive] | None = None
    """How often the controller runs; every time step where not given."""
    integrator: Literal["rk4", "semi_implicit_euler", "dormand_prince"] = "rk4"
    """``dormand_prince`` adapts its steps; ``time_step`` is then the grid of the rows."""
    tolerance: Number = Field(default=1e-9, ge=1e-13, le=0.1)
    """Of ``dormand_prince``: error of a step as a share of a radian, of the robot's size, of rates."""
    enforce_limits: bool = False
    """Whether rigid stops keep the joints within their position limits."""
    restitution: Number = Field(default=0.0, ge=0.0, le=1.0)
    """Share of its rate that a joint keeps when it hits a stop."""
    record_every: Whole = Field(default=1, ge=1, le=MAX_STEPS)
    """One row of the trace every so many steps."""
    record_wrenches: bool = False
    """Whether the trace holds the wrench of every effect on every body."""
    rereference_beyond: Drift = 1e5
    """How far a robot that nothing leads may drift before it gets a reference of its own; ``never``."""
    reference_start_tolerance: (
        Annotated[list[NotNegativeNumber], Field(min_length=2, max_length=2)] | None
    ) = None
    """How far from the tool a reference may start, m and rad; 0.05 and 0.1 where not given."""

    @property
    def steps(self) -> int:
        """Of the grid of time steps that the run has."""
        return math.ceil(self.duration / self.time_step * (1.0 - 1e-9))

    @model_validator(mode="after")
    def _steps_fit(self) -> SimulationSettings:
        if self.time_step > self.duration:
            raise wrong(f"time_step {self.time_step:g} s is longer than the duration {self.duration:g} s")
        if self.duration / self.time_step > MAX_STEPS:
            raise wrong(f"duration / time_step is above {MAX_STEPS:.0e} steps; take a longer 'time_step'")
        if self.steps / self.record_every > MAX_ROWS:
            raise wrong(
                f"the trace would have more than {MAX_ROWS} rows; record less often with 'record_every'"
            )
        if self.control_period is not None and self.control_period < self.time_step * (1.0 - 1e-9):
            raise wrong(
                f"control_period {self.control_period:g} s is shorter than time_step {self.time_step:g} s"
            )
        return self
