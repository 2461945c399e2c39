"""Types of scenario fields for gains and tolerances; each number has its dimension and is stored in SI."""

from __future__ import annotations

from typing import Annotated

from pydantic import BeforeValidator

from onorbit_rs.exceptions import QuantityError
from onorbit_rs.scenario import units
from onorbit_rs.scenario.errors import shortened
from onorbit_rs.scenario.units import Dimension, parse_quantity


def _gain_reader(linear: Dimension, angular: Dimension | None = None) -> BeforeValidator:
    """Return the validator that reads a task-space gain; with ``angular``, a single number has no unit."""

    def row(value: object) -> list[float]:
        if not isinstance(value, list) or len(value) != 6:
            raise QuantityError(f"{_GAIN_SHAPES}, not {shortened(value)}", text=value, expected="6 numbers")
        kinds = [linear] * 3 + [angular or linear] * 3
        return [parse_quantity(entry, kind) for entry, kind in zip(value, kinds, strict=True)]

    def read(value: object) -> float | list[float] | list[list[float]]:
        if not isinstance(value, list):
            return parse_quantity(value, units.NUMBER if angular else linear)
        if any(isinstance(entry, list) for entry in value):
            if len(value) != 6:
                raise QuantityError(
                    f"{_GAIN_SHAPES}, not {shortened(value)}", text=value, expected="6 x 6 numbers"
                )
            return [row(entry) for entry in value]
        return row(value)

    return BeforeValidator(read)


_GAIN_SHAPES = (
    "a gain must be one number, six numbers (linear, then angular), or a 6 x 6 matrix given as six rows"
)
_Gain = float | list[float] | list[list[float]]

StiffnessGain = Annotated[_Gain, _gain_reader(units.STIFFNESS)]
RateGain = Annotated[_Gain, _gain_reader(units.RATE)]
SpringGain = Annotated[_Gain, _gain_reader(units.LINEAR_STIFFNESS, units.ANGULAR_STIFFNESS)]
DamperGain = Annotated[_Gain, _gain_reader(units.LINEAR_DAMPING, units.ANGULAR_DAMPING)]


def _per_joint_reader(*allowed: Dimension) -> BeforeValidator:
    """Return the validator that reads one number for all joints of a group, or one number per joint."""

    def read(value: object) -> float | list[float]:
        if isinstance(value, list):
            return [parse_quantity(entry, *allowed) for entry in value]
        return parse_quantity(value, *allowed)

    return BeforeValidator(read)


_PerJoint = float | list[float]

JointNumber = Annotated[_PerJoint, _per_joint_reader(units.NUMBER)]
JointStiffnessGain = Annotated[_PerJoint, _per_joint_reader(units.STIFFNESS)]
JointRateGain = Annotated[_PerJoint, _per_joint_reader(units.RATE)]
JointEffort = Annotated[_PerJoint, _per_joint_reader(units.TORQUE, units.FORCE)]
JointRates = Annotated[_PerJoint, _per_joint_reader(units.ANGULAR_RATE, units.SPEED)]
JointTolerance = Annotated[_PerJoint, _per_joint_reader(units.ANGLE, units.LENGTH)]


def _task_tolerance(value: object) -> list[float]:
    if not isinstance(value, list) or len(value) != 2:
        raise QuantityError(
            f"the tolerance of a tool is {shortened(value)}; give a distance and an angle, such as "
            "[1 mm, 0.1 deg]",
            text=value,
            expected="a length and an angle",
        )
    return [parse_quantity(value[0], units.LENGTH), parse_quantity(value[1], units.ANGLE)]


TaskTolerance = Annotated[list[float], BeforeValidator(_task_tolerance)]
