"""Types of scenario fields; quantities are checked for their dimension and stored in SI."""

from __future__ import annotations

import math
from pathlib import Path
from typing import Annotated, Any, Literal

from pydantic import (
    BeforeValidator,
    Field,
    PlainSerializer,
    SerializationInfo,
    ValidatorFunctionWrapHandler,
    WrapValidator,
)

from onorbit_rs.common.numbers import shortest
from onorbit_rs.exceptions import QuantityError
from onorbit_rs.scenario import units
from onorbit_rs.scenario.errors import shortened
from onorbit_rs.scenario.units import Dimension, parse_quantity


def _reader(*allowed: Dimension) -> BeforeValidator:
    return BeforeValidator(lambda value: parse_quantity(value, *allowed))


def _positive(value: Any, read: ValidatorFunctionWrapHandler) -> float:
    number: float = read(value)
    if number <= 0.0:
        message = f"{shortened(value)} is out of range; it must be above zero"
        raise QuantityError(message, text=value, expected="above zero")
    return number


def _not_negative(value: Any, read: ValidatorFunctionWrapHandler) -> float:
    number: float = read(value)
    if number < 0.0:
        message = f"{shortened(value)} is out of range; it must be zero or above"
        raise QuantityError(message, text=value, expected="zero or above")
    return number


def resolved_path(path: Path | str, info: SerializationInfo) -> str:
    """Return the path as text; absolute if the serialization context is the folder of relative paths."""
    return str(path if info.context is None else (info.context / path).resolve())


FilePath = Annotated[Path, PlainSerializer(resolved_path, when_used="json")]
"""Path of a file or folder; a relative path starts at the folder of the scenario."""

Positive = WrapValidator(_positive)
NotNegative = WrapValidator(_not_negative)

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
Stiffness = Annotated[float, _reader(units.LINEAR_STIFFNESS)]
Damping = Annotated[float, _reader(units.LINEAR_DAMPING)]
Dissipation = Annotated[float, _reader(units.DISSIPATION)]
Inertia = Annotated[float, _reader(units.INERTIA)]


def _whole(value: object) -> object:
    if isinstance(value, bool):
        raise QuantityError(
            f"must be a whole number, not {str(value).lower()}", text=value, expected="a number"
        )
    return value


Whole = Annotated[int, BeforeValidator(_whole)]


def _drift(value: object) -> float | Literal["never"]:
    if value in ("never", math.inf):
        return "never"
    try:
        distance = parse_quantity(value, units.LENGTH)
    except QuantityError as error:
        raise QuantityError(f"{error}, or 'never'", text=value, expected="a length, or never") from None
    if distance < 1.0:
        message = f"{shortest(distance)} m is too short; give at least 1 m, or 'never'"
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
