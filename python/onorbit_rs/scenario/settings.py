"""Settings of the integrator and the recorder."""

from __future__ import annotations

import math
from typing import Annotated, Any, ClassVar, Literal, Self

from pydantic import Field, model_validator

from onorbit_rs.common.numbers import shortest
from onorbit_rs.scenario.errors import inconsistent, invalid
from onorbit_rs.scenario.fields import Drift, NotNegative, Number, Positive, Time, Whole
from onorbit_rs.scenario.part import Part

NotNegativeNumber = Annotated[Number, NotNegative]
MAX_STEPS = 10**10
MAX_ROWS = 10**7
"""Largest number of rows in a trace; a row requires about half a kilobyte."""


class ControlSettings(Part):
    """Settings of one robot: control period, joint stops, and tolerance at the start of references."""

    control_period: Annotated[Time, Positive] | None = None
    """Interval between two updates of the controllers, s. Default: the time step."""
    enforce_limits: bool = False
    """Whether rigid stops keep the joints within their position limits."""
    restitution: Number = Field(default=0.0, ge=0.0, le=1.0)
    """Coefficient of restitution at the stops: rate of rebound divided by rate of impact, 0 to 1."""
    reference_start_tolerance: (
        Annotated[list[NotNegativeNumber], Field(min_length=2, max_length=2)] | None
    ) = None
    """Largest distance, m, and angle, rad, between a tool and the start of its reference. Default: 0.05 m
    and 0.1 rad."""


class IntegrationSettings(Part):
    """Settings of the integrator and of the recording; all times are simulated times."""

    synonyms: ClassVar = {
        "dt": "time_step", "step": "time_step", "timestep": "time_step", "end": "duration",
    }  # fmt: skip

    duration: Annotated[Time, Positive]
    """Duration of the run, s."""
    time_step: Annotated[Time, Positive] = 1e-3
    """Time step of the integrator, s."""
    integrator: Literal["rk4", "semi_implicit_euler", "dormand_prince"] = "rk4"
    """Integration method. ``dormand_prince`` adapts its steps; ``time_step`` is then the interval of the time
    grid."""
    tolerance: Number = Field(default=1e-9, ge=1e-13, le=0.1)
    """Largest relative error of a step of ``dormand_prince``. Errors of angles are relative to 1 rad, those
    of lengths to the size of the robot or its distance from the origin of W, and those of rates to the
    magnitude of the rates."""
    record_every: Whole = Field(default=1, ge=1, le=MAX_STEPS)
    """Number of steps between two rows of the trace."""
    record_wrenches: bool = False
    """Whether the trace contains the wrench of every effect on every body."""
    rereference_beyond: Drift = 1e5
    """Distance from the reference orbit, m, beyond which a robot without a reference in W gets a new
    reference orbit; or ``never``."""

    @property
    def steps(self) -> int:
        """Number of time steps of the run."""
        return math.ceil(self.duration / self.time_step * (1.0 - 1e-9))

    def arguments(self) -> dict[str, Any]:
        """Return the settings as keyword arguments of :class:`onorbit_rs.Simulation`.

        ``duration`` is omitted. For several systems, ``rereference_beyond`` is an argument of
        :class:`onorbit_rs.World` instead.
        """
        values = self.model_dump(exclude_none=True, exclude={"duration"})
        if self.rereference_beyond == "never":
            values["rereference_beyond"] = math.inf
        return values

    @model_validator(mode="after")
    def _has_valid_steps(self) -> Self:
        if self.time_step > self.duration:
            raise invalid(
                f"time_step {shortest(self.time_step)} s exceeds the duration of {shortest(self.duration)} "
                "s; give a shorter 'time_step' or a longer 'duration'"
            )
        if self.duration / self.time_step > MAX_STEPS:
            raise invalid(
                f"a duration of {shortest(self.duration)} s with a time_step of {shortest(self.time_step)} s "
                f"exceeds the limit of {MAX_STEPS} steps; give a 'time_step' of at least "
                f"{_rounded_up(self.duration / MAX_STEPS):.2g} s, or a shorter 'duration'"
            )
        if self.steps / self.record_every > MAX_ROWS:
            raise invalid(
                f"the run would record {math.ceil(self.steps / self.record_every)} steps; at most {MAX_ROWS} "
                f"are permitted; set 'record_every' to at least {math.ceil(self.steps / MAX_ROWS)}"
            )
        return self


def _rounded_up(number: float) -> float:
    """Return a positive number, rounded up to two significant digits."""
    unit = 10.0 ** (math.floor(math.log10(number)) - 1)
    return math.ceil(number / unit) * unit


class SimulationSettings(ControlSettings, IntegrationSettings):
    """Simulation settings of a scenario with one robot."""

    @model_validator(mode="after")
    def _has_valid_period(self) -> Self:
        if self.control_period is not None and self.control_period < self.time_step * (1.0 - 1e-9):
            raise inconsistent(
                "control_period",
                f"control_period {shortest(self.control_period)} s is shorter than one time_step; give at "
                f"least {shortest(self.time_step)} s",
            )
        return self


class WorldSettings(IntegrationSettings):
    """Simulation settings of a scenario with ``systems``."""

    weld_time_constant: Annotated[Time, Positive] | None = None
    """Time constant, s, of the connections of ``engine: mujoco``. Default and minimum: two time steps."""

    def arguments(self) -> dict[str, Any]:
        """Return the settings, except ``duration`` and ``weld_time_constant``, as keyword arguments.

        They are arguments of :class:`onorbit_rs.Simulation`, except ``rereference_beyond``, which is one of
        :class:`onorbit_rs.World`.
        """
        values = super().arguments()
        values.pop("weld_time_constant", None)
        return values

    @classmethod
    def _hint(cls, key: str, free: list[str]) -> str:
        if key in ControlSettings.model_fields:
            return "; it belongs in each entry of 'systems'"
        return super()._hint(key, free)
