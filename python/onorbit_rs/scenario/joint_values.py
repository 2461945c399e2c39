"""Types of scenario fields for joints, in order or by name; a unit is checked once the robot is known."""

from __future__ import annotations

from typing import Annotated

from pydantic import PlainSerializer, PlainValidator

from onorbit_rs.exceptions import QuantityError
from onorbit_rs.scenario import units
from onorbit_rs.scenario.units import Dimension, parse_quantity


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
