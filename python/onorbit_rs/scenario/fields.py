"""Types of scenario fields: each reads a quantity of its own dimension and holds SI."""

from __future__ import annotations

import math
from pathlib import Path
from typing import Annotated, Literal

from pydantic import (
    AfterValidator,
    BeforeValidator,
    Field,
    PlainSerializer,
    PlainValidator,
    SerializationInfo,
)

from onorbit_rs.exceptions import QuantityError
from onorbit_rs.scenario import units
from onorbit_rs.scenario.units import Dimension, parse_quantity


def _reader(*allowed: Dimension) -> BeforeValidator:
    return BeforeValidator(lambda value: parse_quantity(value, *allowed))


def _positive(value: float) -> float:
    if value <= 0.0:
        raise QuantityError(f"{value:g} is not above zero", text=value, expected="above zero")
    return value


def _not_negative(value: float) -> float:
    if value < 0.0:
        raise QuantityError(f"{value:g} is negative", text=value, expected="zero or above")
    return value


def beside(path: Path | str, info: SerializationInfo) -> str:
    """The path, from the folder that the context of the dump names, if it names one."""
    return str(path if info.context is None else (info.context / path).resolve())


FilePath = Annotated[Path, PlainSerializer(beside, when_used="json")]
"""A file or folder, beside the scenario unless its path is absolute."""

Positive = AfterValidator(_positive)
NotNegative = AfterValidator(_not_negative)

Number = Annotated[float, _reader(units.NUMBER)]
Mass = Annotated[float, _reader(units.MASS)]
Length = Annotated[float, _reader(units.LENGTH)]
Area = Annotated[float, _reader(units.AREA)]
Density = Annotated[float, _reader(units.DENSITY)]
Time = Annotated[float, _reader(units.TIME)]
Angle = Annotated[float, _reader(units.ANGLE)]
Speed = Annotated[float, _reader(units.SPEED)]
Acceleration = Annotated[float, _reader(units.ACCELERATION)]
AngularRate = Annotated[float, _reader(units.ANGULAR_RATE)]
AngularAcceleration = Annotated[float, _reader(units.ANGULAR_ACCELERATION)]
JointRate = Annotated[float, _reader(units.ANGULAR_RATE, units.SPEED)]
JointAcceleration = Annotated[float, _reader(units.ANGULAR_ACCELERATION, units.ACCELERATION)]
Rate = Annotated[float, _reader(units.RATE)]
Flux = Annotated[float, _reader(units.FLUX)]
Force = Annotated[float, _reader(units.FORCE)]
Torque = Annotated[float, _reader(units.TORQUE)]
Inertia = Annotated[float, _reader(units.INERTIA)]
Stiffness = Annotated[float, _reader(units.STIFFNESS)]


def _drift(value: object) -> float | Literal["never"]:
    if value in ("never", math.inf):
        return "never"
    try:
        distance = parse_quantity(value, units.LENGTH)
    except QuantityError as error:
        raise QuantityError(f"{error}, or never", text=value, expected="a length, or never") from None
    if distance < 1.0:
        message = f"{distance:g} m is too near: give at least 1 m, or never"
        raise QuantityError(message, text=value, expected="at least 1 m")
    return distance


Drift = Annotated[float | Literal["never"], BeforeValidator(_drift)]
GravitationalParameter = Annotated[float, _reader(units.GRAVITY)]
Length3 = Annotated[list[Length], Field(min_length=3, max_length=3)]
Angle3 = Annotated[list[Angle], Field(min_length=3, max_length=3)]
Speed3 = Annotated[list[Speed], Field(min_length=3, max_length=3)]
Acceleration3 = Annotated[list[Acceleration], Field(min_length=3, max_length=3)]
AngularRate3 = Annotated[list[AngularRate], Field(min_length=3, max_length=3)]
Force3 = Annotated[list[Force], Field(min_length=3, max_length=3)]
Torque3 = Annotated[list[Torque], Field(min_length=3, max_length=3)]
Number3 = Annotated[list[Number], Field(min_length=3, max_length=3)]
Number4 = Annotated[list[Number], Field(min_length=4, max_length=4)]


def _gain_reader(linear: Dimension, angular: Dimension | None = None) -> BeforeValidator:
    """Gains of the six directions; a number for all of them is bare where they differ in dimension."""

    def row(value: object) -> list[float]:
        if not isinstance(value, list) or len(value) != 6:
            raise QuantityError(_GAIN_SHAPES, text=value, expected="6 numbers")
        kinds = [linear] * 3 + [angular or linear] * 3
        return [parse_quantity(entry, kind) for entry, kind in zip(value, kinds, strict=True)]

    def read(value: object) -> float | list[float] | list[list[float]]:
        if not isinstance(value, list):
            return parse_quantity(value, units.NUMBER if angular else linear)
        if any(isinstance(entry, list) for entry in value):
            if len(value) != 6:
                raise QuantityError(_GAIN_SHAPES, text=value, expected="6 x 6 numbers")
            return [row(entry) for entry in value]
        return row(value)

    return BeforeValidator(read)


_GAIN_SHAPES = "a gain is one number, six (linear first, then angular), or a 6 x 6 matrix given as six rows"
_Gain = float | list[float] | list[list[float]]

StiffnessGain = Annotated[_Gain, _gain_reader(units.STIFFNESS)]
RateGain = Annotated[_Gain, _gain_reader(units.RATE)]
SpringGain = Annotated[_Gain, _gain_reader(units.LINEAR_STIFFNESS, units.ANGULAR_STIFFNESS)]
DamperGain = Annotated[_Gain, _gain_reader(units.LINEAR_DAMPING, units.ANGULAR_DAMPING)]


def _per_joint_reader(*allowed: Dimension) -> BeforeValidator:
    """A number for all joints of a group, or one for each."""

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
JointTolerance = Annotated[_PerJoint, _per_joint_reader(units.ANGLE, units.LENGTH)]


def _task_tolerance(value: object) -> list[float]:
    if not isinstance(value, list) or len(value) != 2:
        raise QuantityError(
            "the tolerance of a tool is a distance and an angle, such as [1 mm, 0.1 deg]",
            text=value,
            expected="a length and an angle",
        )
    return [parse_quantity(value[0], units.LENGTH), parse_quantity(value[1], units.ANGLE)]


TaskTolerance = Annotated[list[float], BeforeValidator(_task_tolerance)]


class JointValue(float):
    """The value of a joint in SI; ``dimension`` is that of its unit, None for a bare number."""

    dimension: Dimension | None = None


def _joint_value(value: object, allowed: tuple[Dimension, ...]) -> JointValue:
    number = JointValue(parse_quantity(value, *allowed))
    fitting = [dimension for dimension in allowed if _measures(value, dimension)]
    number.dimension = fitting[0] if len(fitting) == 1 else None
    return number


def _measures(value: object, dimension: Dimension) -> bool:
    try:
        parse_quantity(value, dimension)
    except QuantityError:
        return False
    return True


def _joints_reader(*allowed: Dimension) -> PlainValidator:
    def read(value: object) -> list[JointValue] | dict[str, JointValue]:
        if isinstance(value, dict):
            return {str(name): _named(str(name), entry, allowed) for name, entry in value.items()}
        if isinstance(value, list):
            return [_joint_value(entry, allowed) for entry in value]
        raise QuantityError(
            "joints are a list in the model's order, or a mapping from joint name to value",
            text=value,
            expected="joints",
        )

    return PlainValidator(read)


def _named(name: str, value: object, allowed: tuple[Dimension, ...]) -> JointValue:
    try:
        return _joint_value(value, allowed)
    except QuantityError as error:
        raise QuantityError(f"{name}: {error}", text=error.text, expected=error.expected) from None


def _plain(joints: _Joints) -> list[float] | dict[str, float]:
    if isinstance(joints, dict):
        return {name: float(value) for name, value in joints.items()}
    return [float(value) for value in joints]


_Joints = list[JointValue] | dict[str, JointValue]

JointPositions = Annotated[_Joints, _joints_reader(units.ANGLE, units.LENGTH), PlainSerializer(_plain)]
JointRates = Annotated[_Joints, _joints_reader(units.ANGULAR_RATE, units.SPEED), PlainSerializer(_plain)]
