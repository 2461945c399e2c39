"""Actuators of a system: brakes of joints."""

from __future__ import annotations

from typing import Annotated

from pydantic import PlainSerializer, PlainValidator

from onorbit_rs import _core
from onorbit_rs.common.suggestions import did_you_mean, nearest
from onorbit_rs.exceptions import FrameError, QuantityError
from onorbit_rs.scenario import units
from onorbit_rs.scenario.errors import inconsistent, shortened
from onorbit_rs.scenario.joint_values import JointValue, joint_value
from onorbit_rs.scenario.part import Part
from onorbit_rs.scenario.yaml_lines import Location


def _slip_torque(value: object) -> JointValue:
    number = joint_value(value, (units.TORQUE, units.FORCE))
    if number <= 0.0:
        raise QuantityError(
            f"{shortened(value)} is out of range; the slip torque (or force) must be above zero; omit "
            "'slip_torque' for a brake that holds rigidly",
            text=value,
            expected="above zero",
        )
    return number


SlipTorque = Annotated[JointValue, PlainValidator(_slip_torque), PlainSerializer(float)]


class Brake(Part):
    """Brake that locks a joint, rigidly or up to a slip torque."""

    brake: str
    """Name, unique among the actuators of the system."""
    joint: str
    slip_torque: SlipTorque | None = None
    """Largest torque, N m, or force at a prismatic joint, N, that the brake holds. Default: unlimited."""
    engaged: bool = False
    """Whether the brake is engaged at the start."""

    def build(self, model: _core.Model) -> _core.Brake:
        """Return the brake as an object of the engine.

        Raises
        ------
        FrameError
            If the robot has no moving joint of this name.
        QuantityError
            If the slip torque is a force on a revolute joint, or a torque on a prismatic joint.
        """
        slip = float("inf") if self.slip_torque is None else float(self.slip_torque)
        joint = {joint.name: joint for joint in model.joints}.get(self.joint)
        if joint is None:
            raise FrameError(
                f"the robot has no moving joint {self.joint!r}{did_you_mean(self.joint, model.joint_names)}",
                name=self.joint, kind="joint", known=list(model.joint_names),
                suggestion=nearest(self.joint, model.joint_names),
            )  # fmt: skip
        given = None if self.slip_torque is None else self.slip_torque.dimension
        if given is not None:
            expected = units.FORCE if joint.kind == "prismatic" else units.TORQUE
            if given != expected:
                raise QuantityError(
                    f"the slip torque is {given.name}, but the joint {self.joint!r} is {joint.kind}; give "
                    f"{expected.name} in {expected.si}",
                    text=slip,
                    expected=expected.name,
                )
        return _core.Brake(self.brake, self.joint, slip_torque=slip, engaged=self.engaged)


def check_actuators(owner: Location, actuators: list[Brake]) -> None:
    """Raise an error if a name is empty or given twice, or two brakes are on one joint.

    ``owner`` is the location of the entry that has the actuators.
    """
    for index, brake in enumerate(actuators):
        at = (*owner, "actuators", index)
        if not brake.brake:
            raise inconsistent((*at, "brake"), "the name is empty; give the brake a name")
        for before in actuators[:index]:
            if before.brake == brake.brake:
                message = f"two actuators are named {brake.brake!r}; names must be unique"
                raise inconsistent((*at, "brake"), message)
            if before.joint == brake.joint:
                message = (
                    f"the joint {brake.joint!r} already has the brake {before.brake!r}; omit one of the "
                    "brakes"
                )
                raise inconsistent((*at, "joint"), message)


def check_brake(path: str, brakes: dict[str, list[str]]) -> str | None:
    """Return the reason why ``path`` does not name a brake as ``SYSTEM/BRAKE``; None if it names one.

    ``brakes`` contains the names of the brakes of each system.
    """
    system, _, name = path.partition("/")
    if not (system and name):
        every = [f"{owner}/{brake}" for owner, names in brakes.items() for brake in names]
        example = f", such as {every[0]}" if every else ""
        return f"{path!r} is not a brake of a system; write SYSTEM/BRAKE{example}"
    if system not in brakes:
        return f"no system is named {system!r}{did_you_mean(system, brakes)}"
    if not brakes[system]:
        return f"the system {system!r} has no brakes; add one to its 'actuators'"
    if name not in brakes[system]:
        return f"no brake of {system!r} is named {name!r}{did_you_mean(name, brakes[system])}"
    return None
