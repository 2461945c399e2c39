"""The first state of a run, `q` and `v`, from the scenario's ``initial``."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from onorbit_rs.counting import count
from onorbit_rs.exceptions import FrameError, QuantityError, ShapeError
from onorbit_rs.names import did_you_mean, nearest
from onorbit_rs.rotations import (
    matrix_from_quaternion,
    quaternion_from_matrix,
    quaternion_from_roll_pitch_yaw,
)
from onorbit_rs.scenario.initial import Attitude, InitialState
from onorbit_rs.scenario.joint_values import JointValue
from onorbit_rs.scenario.units import LENGTH, SPEED

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from onorbit_rs._core import Model, Orbit

    Floats = NDArray[np.float64]


def initial_state(initial: InitialState, model: Model, orbit: Orbit | None) -> tuple[Floats, Floats]:
    """Configuration and velocity at time zero.

    Given relative to L, position and attitude turn with `R_il`, and the motion of L is added in body axes:
    `ω_b = ω + R_bl ω_l` and `v_b = v + R_bl (ω_l × p_l)`, with the rate `ω_l` of L in its own axes.

    Returns
    -------
    q : (nq,) array
        m, quaternion xyzw, rad or m.
    v : (nv,) array
        m/s, rad/s in body axes, joint rates.

    Raises
    ------
    FrameError
        A joint that does not exist; suggests the nearest.
    ShapeError
        A list of joints of the wrong length.
    QuantityError
        Metres on a joint that turns, radians on one that slides.
    """
    q, v = np.array(model.neutral(), dtype=np.float64), np.zeros(model.nv)
    rot_fb = matrix_from_quaternion(quaternion_of(initial.attitude))
    position, linear, angular = (
        np.array(values) for values in (initial.position, initial.linear_velocity, initial.angular_velocity)
    )
    if initial.frame != "world" and orbit is not None:
        frame = orbit.lvlh(0.0) if initial.frame == "lvlh" else orbit.frame(0.0)
        rot_il, rate = (np.asarray(value, dtype=np.float64) for value in frame)
        linear = linear + rot_fb.T @ np.cross(rate, position)
        angular = angular + rot_fb.T @ rate
        position, rot_fb = rot_il @ position, rot_il @ rot_fb
    q[:3], q[3:7] = position, quaternion_from_matrix(rot_fb)
    v[:3], v[3:6] = linear, angular
    q[7:] = joint_values("joints", initial.joints, q[7:], model)
    v[6:] = joint_values("joint_rates", initial.joint_rates, v[6:], model)
    return q, v


def quaternion_of(attitude: Attitude | None) -> Floats:
    """Unit quaternion xyzw of an attitude; no turn where none is given."""
    if attitude is None:
        return np.array([0.0, 0.0, 0.0, 1.0])
    if attitude.quaternion_xyzw is not None:
        quat: Floats = np.array(attitude.quaternion_xyzw)
        quat /= np.linalg.norm(quat)
        return quat
    return quaternion_from_roll_pitch_yaw(np.array(attitude.roll_pitch_yaw))


def joint_values(
    name: str, given: list[JointValue] | dict[str, JointValue], default: Floats, model: Model
) -> Floats:
    """Values in the order of the model's joints."""
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
            message = (
                f"{name} has {entries}, the robot has {count(len(joints), 'moving joint', 'moving joints')}"
            )
            raise ShapeError(message, name=name, expected=(len(joints),), got=(len(given),))
        values[:] = given
    by_name = given if isinstance(given, dict) else dict(zip(joints, given, strict=False))
    if any(value.dimension is not None for value in by_name.values()):
        _check_units(name, by_name, model)
    return values


def _check_units(name: str, given: dict[str, JointValue], model: Model) -> None:
    """A unit of length on a joint that turns, or of angle on one that slides, is refused."""
    slides = {joint.name: joint.kind == "prismatic" for joint in model.joints}
    for joint, value in given.items():
        if value.dimension is None:
            continue
        is_length = value.dimension in (LENGTH, SPEED)
        if is_length != slides[joint]:
            does = "slides" if slides[joint] else "turns"
            message = f"{name}: {joint} {does}, so {value.dimension.name} does not fit"
            raise QuantityError(
                message, text=float(value), expected="a length" if slides[joint] else "an angle"
            )
