"""Joint positions and rates in a scenario, as a list or by name; units are checked against the robot."""

from __future__ import annotations

from typing import TYPE_CHECKING, Annotated

from pydantic import PlainSerializer, PlainValidator

from onorbit_rs.common.counting import count
from onorbit_rs.common.suggestions import did_you_mean, nearest
from onorbit_rs.exceptions import FrameError, QuantityError, ShapeError
from onorbit_rs.scenario import units
from onorbit_rs.scenario.errors import shortened
from onorbit_rs.scenario.units import Dimension, parse_quantity

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray

    from onorbit_rs._core import Model

    Floats = NDArray[np.float64]


_OTHER = {
    units.LENGTH: units.ANGLE, units.ANGLE: units.LENGTH,
    units.SPEED: units.ANGULAR_RATE, units.ANGULAR_RATE: units.SPEED,
}  # fmt: skip
"""Dimension of the same quantity for the other kind of joint, revolute or prismatic."""


class JointValue(float):
    """Value of a joint in SI; ``dimension`` is the dimension of its unit, None if it has no unit."""

    dimension: Dimension | None = None


def joint_value(value: object, allowed: tuple[Dimension, ...]) -> JointValue:
    """Return the value of a joint, a quantity of one of the dimensions ``allowed``."""
    number = JointValue(parse_quantity(value, *allowed))
    fitting = [dimension for dimension in allowed if _has_dimension(value, dimension)]
    number.dimension = fitting[0] if len(fitting) == 1 else None
    return number


def _has_dimension(value: object, dimension: Dimension) -> bool:
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
            return [joint_value(entry, allowed) for entry in value]
        raise QuantityError(
            f"{shortened(value)} is not a set of joint values; give a list in the order of the robot's "
            "joints, or a mapping from joint names to values",
            text=value,
            expected="joints",
        )

    return PlainValidator(read)


def _named(name: str, value: object, allowed: tuple[Dimension, ...]) -> JointValue:
    try:
        return joint_value(value, allowed)
    except QuantityError as error:
        raise QuantityError(f"{name}: {error}", text=error.text, expected=error.expected) from None


def _plain(joints: _Joints) -> list[float] | dict[str, float]:
    if isinstance(joints, dict):
        return {name: float(value) for name, value in joints.items()}
    return [float(value) for value in joints]


_Joints = list[JointValue] | dict[str, JointValue]

JointPositions = Annotated[_Joints, _joints_reader(units.ANGLE, units.LENGTH), PlainSerializer(_plain)]
JointRates = Annotated[_Joints, _joints_reader(units.ANGULAR_RATE, units.SPEED), PlainSerializer(_plain)]


def joint_values(
    name: str, given: list[JointValue] | dict[str, JointValue], default: Floats, model: Model
) -> Floats:
    """Return the values (n,), SI, in the order of the model's joints; joints not given get the default.

    Raises
    ------
    FrameError
        If a joint does not exist; the message suggests a similar name, if there is one.
    ShapeError
        If a list has the wrong length.
    QuantityError
        If a revolute joint has a value in a unit of length, or a prismatic joint in a unit of angle.
    """
    values, joints = default.copy(), list(model.joint_names)
    if isinstance(given, dict):
        for joint, value in given.items():
            if joint not in joints:
                hint = did_you_mean(joint, joints)
                raise FrameError(
                    f"{name}: no joint is named {joint!r}{hint}",
                    name=joint, kind="joint", known=list(joints), suggestion=nearest(joint, joints),
                )  # fmt: skip
            values[joints.index(joint)] = value
    elif given:
        if len(given) != len(joints):
            entries = count(len(given), "entry", "entries")
            moving = count(len(joints), "moving joint", "moving joints")
            message = (
                f"{name} has {entries}, but the robot has {moving}; give one value per joint, or a mapping "
                "from joint names to values"
            )
            raise ShapeError(message, name=name, expected=(len(joints),), got=(len(given),))
        values[:] = given
    by_name = given if isinstance(given, dict) else dict(zip(joints, given, strict=False))
    if any(value.dimension is not None for value in by_name.values()):
        _check_units(name, by_name, model)
    return values


def _check_units(name: str, given: dict[str, JointValue], model: Model) -> None:
    """Raise QuantityError for a unit of length on a revolute joint or of angle on a prismatic joint."""
    is_prismatic = {joint.name: joint.kind == "prismatic" for joint in model.joints}
    for joint, value in given.items():
        if value.dimension is None:
            continue
        if (value.dimension in (units.LENGTH, units.SPEED)) != is_prismatic[joint]:
            kind, expected = "prismatic" if is_prismatic[joint] else "revolute", _OTHER[value.dimension].name
            message = f"{name}: {joint} is {kind}; give {expected} instead of {value.dimension.name}"
            raise QuantityError(message, text=float(value), expected=expected)
