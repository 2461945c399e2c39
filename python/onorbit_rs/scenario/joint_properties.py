"""Damping, friction, rotor inertia and springs of joints in a scenario, with units for each kind of joint."""

from __future__ import annotations

from typing import Annotated, Any, ClassVar

from pydantic import PlainSerializer, PlainValidator

from onorbit_rs import _core
from onorbit_rs.exceptions import QuantityError
from onorbit_rs.scenario import units
from onorbit_rs.scenario.errors import shortened
from onorbit_rs.scenario.joint_values import JointValue, joint_value
from onorbit_rs.scenario.part import Part
from onorbit_rs.scenario.units import Dimension

_DIMENSIONS = {
    "damping": (units.ANGULAR_DAMPING, units.LINEAR_DAMPING),
    "friction": (units.TORQUE, units.FORCE),
    "static_friction": (units.TORQUE, units.FORCE),
    "rotor_inertia": (units.INERTIA, units.MASS),
    "stiffness": (units.ANGULAR_STIFFNESS, units.LINEAR_STIFFNESS),
    "cubic_stiffness": (units.ANGULAR_CUBIC_STIFFNESS, units.LINEAR_CUBIC_STIFFNESS),
    "rest_position": (units.ANGLE, units.LENGTH),
}
"""Dimensions of each property: first for a revolute joint, then for a prismatic joint."""


def _reader(name: str, *, is_signed: bool = False) -> PlainValidator:
    allowed: tuple[Dimension, ...] = _DIMENSIONS[name]

    def read(value: object) -> JointValue:
        number = joint_value(value, allowed)
        if number < 0.0 and not is_signed:
            message = f"{shortened(value)} is out of range; it must be zero or above"
            raise QuantityError(message, text=value, expected="zero or above")
        return number

    return PlainValidator(read)


JointDamping = Annotated[JointValue, _reader("damping"), PlainSerializer(float)]
JointFriction = Annotated[JointValue, _reader("friction"), PlainSerializer(float)]
RotorInertia = Annotated[JointValue, _reader("rotor_inertia"), PlainSerializer(float)]
JointStiffness = Annotated[JointValue, _reader("stiffness"), PlainSerializer(float)]
CubicStiffness = Annotated[JointValue, _reader("cubic_stiffness", is_signed=True), PlainSerializer(float)]
RestPosition = Annotated[JointValue, _reader("rest_position", is_signed=True), PlainSerializer(float)]


class JointProperties(Part):
    """Properties of a joint that replace those of the robot's file; each is optional.

    With the stiffness `k`, the cubic stiffness `k3` and the deflection `d` from the rest position, the torque
    or force of the spring is `-k d - k3 d³`.
    """

    synonyms: ClassVar = {
        "spring": "stiffness", "spring_stiffness": "stiffness", "cubic": "cubic_stiffness",
        "rest": "rest_position", "springref": "rest_position", "spring_reference": "rest_position",
        "armature": "rotor_inertia", "frictionloss": "friction",
    }  # fmt: skip

    damping: JointDamping | None = None
    """Coefficient of viscous friction, N m s/rad or N s/m."""
    friction: JointFriction | None = None
    """Kinetic Coulomb friction, which acts while the joint moves, N m or N."""
    static_friction: JointFriction | None = None
    """Largest torque or force that static friction can hold, N m or N."""
    rotor_inertia: RotorInertia | None = None
    """Rotor inertia reflected to the joint, kg m² or kg."""
    stiffness: JointStiffness | None = None
    """Stiffness of the spring at its rest position, N m/rad or N/m."""
    cubic_stiffness: CubicStiffness | None = None
    """Cubic stiffness of the spring, N m/rad³ or N/m³; negative for a spring that softens."""
    rest_position: RestPosition | None = None
    """Joint position at which the spring exerts no torque or force, rad or m. Default: zero."""

    def apply(self, model: _core.Model, name: str) -> _core.Model:
        """Return the robot with these properties of the joint ``name``.

        Raises
        ------
        FrameError
            If the robot has no joint of this name; the message suggests a similar name, if there is one.
        ModelError
            If the joint is fixed, or the values are inconsistent.
        QuantityError
            If a value has the unit of the other kind of joint, revolute or prismatic.
        """
        given = {key: getattr(self, key) for key in _DIMENSIONS if getattr(self, key) is not None}
        changed = model.with_joint(name, **{key: float(value) for key, value in given.items()})
        _check_units(model, name, given)
        return changed


def _check_units(model: _core.Model, name: str, given: dict[str, Any]) -> None:
    kind = next(joint.kind for joint in model.joints if joint.name == name)
    for key, value in given.items():
        expected = _DIMENSIONS[key][kind == "prismatic"]
        if value.dimension not in (None, expected):
            raise QuantityError(
                f"{key} is {value.dimension.name}, but the joint {name!r} is {kind}; give {expected.name} in "
                f"{expected.si}",
                text=float(value),
                expected=expected.name,
            )
