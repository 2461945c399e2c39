"""Describes a robot as plain data."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from onorbit_rs.common.coordinates import ANGULAR

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from onorbit_rs._core import Model


def describe(model: Model) -> dict[str, Any]:
    """Return the data that ``onorbit info`` prints, in SI and radians; None for a missing limit.

    A body is a link together with all links that are fixed to it. The centre of mass and inertia of a body
    are in the axes of its link; the centre of mass of the whole robot is in base axes, with all joints at
    zero. Inertias and principal moments are about the centre of mass.
    """
    com, moments = _whole_robot(model)
    return {
        "name": model.name, "nq": model.nq, "nv": model.nv,
        "mass_kg": model.mass, "com_m": com, "principal_moments_kg_m2": moments,
        "bodies": [
            {
                "name": body.name, "mass_kg": body.mass, "com_m": list(body.com),
                "inertia_kg_m2": body.inertia, "principal_moments_kg_m2": _moments(np.array(body.inertia)),
            }
            for body in model.bodies
        ],
        "joints": [
            {
                "name": joint.name, "kind": joint.kind, "parent": joint.parent, "child": joint.child,
                "axis": list(joint.axis), "anchor": list(joint.anchor), "pose": joint.pose,
                "lower": joint.lower, "upper": joint.upper,
                "velocity": joint.velocity, "effort": joint.effort, "damping": joint.damping,
                "friction": joint.friction, "static_friction": joint.static_friction,
                "rotor_inertia": joint.rotor_inertia,
                "stiffness": joint.stiffness, "cubic_stiffness": joint.cubic_stiffness,
                "rest_position": joint.rest_position,
                "mimic": joint.mimic and dict(zip(("joint", "ratio", "offset"), joint.mimic, strict=True)),
            }
            for joint in model.joints
        ],
        "frames": [{"name": frame.name, "body": frame.body, "pose": frame.pose} for frame in model.frames],
        "loops": [
            {
                "name": closing.name, "kind": closing.kind, "between": [closing.frame_a, closing.frame_b],
                "poses": [closing.pose_a, closing.pose_b], "length": closing.length,
            }
            for closing in model.loops
        ],
        "warnings": model.warnings,
    }  # fmt: skip


def _moments(inertia: NDArray[np.float64]) -> list[float]:
    """Return the principal moments of inertia, kg m², in ascending order."""
    return [float(moment) for moment in np.linalg.eigvalsh(inertia)]


def _whole_robot(model: Model) -> tuple[list[float], list[float]]:
    """Return the centre of mass in base axes, and the principal moments about it, with joints at zero.

    The inertia follows from the base block of the mass matrix: `I_com = I_origin + m c× c×`, with the mass
    `m` and the cross-product matrix `c×` of the centre of mass.
    """
    q = model.neutral()
    x, y, z = com = np.asarray(model.center_of_mass(q))
    cross = np.array([[0.0, -z, y], [z, 0.0, -x], [-y, x, 0.0]])
    about_com = np.asarray(model.mass_matrix(q))[ANGULAR, ANGULAR] + model.mass * cross @ cross
    return [float(value) for value in com], _moments(about_com)
