"""Inertial properties of each link of a robot, which are dispersed by ``robot.links.LINK``."""

from __future__ import annotations

import warnings
from typing import TYPE_CHECKING

import numpy as np

from onorbit_rs.exceptions import ModelError
from onorbit_rs.scenario.robot import LinkValues

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from onorbit_rs._core import Body, Model

    Floats = NDArray[np.float64]

_MASSLESS = 1e-12
"""Fraction of the mass of its body below which a link counts as massless."""


def link_inertias(model: Model) -> dict[str, LinkValues]:
    """Return mass, kg, centre of mass, m, and inertia, kg m², of every link.

    The inertia is about the centre of mass; both are in axes of the link. A massless link has no values.

    A body is a link together with all links that are fixed to it. For a link that shares a body, the values
    follow from the change of the body when the values of the link are replaced.
    """
    links: dict[str, list[str]] = {body.name: [body.name] for body in model.bodies}
    for frame in model.frames:
        if frame.name not in links[frame.body] and _is_link(model, frame.name):
            links[frame.body].append(frame.name)
    found: dict[str, LinkValues] = {}
    for body in model.bodies:
        if len(links[body.name]) == 1:
            found[body.name] = _values(body.mass, np.array(body.com), np.array(body.inertia))
            continue
        for link in links[body.name]:
            found[link] = _share(model, body, link)
    return found


def _is_link(model: Model, name: str) -> bool:
    """Return True if a frame is a link of the robot."""
    try:
        _replaced(model, name, mass=1.0, com=np.zeros(3), inertia=np.eye(3))
    except (ModelError, KeyError):
        return False
    return True


def _replaced(model: Model, link: str, *, mass: float, com: Floats, inertia: Floats) -> Model:
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        return model.with_link(link, mass=mass, com=com, inertia=inertia)


def _values(mass: float, com: Floats, inertia: Floats) -> LinkValues:
    if mass <= 0.0:
        return LinkValues()
    return LinkValues.model_construct(mass=float(mass), com=com.tolist(), inertia=inertia.tolist())


def _share(model: Model, body: Body, link: str) -> LinkValues:
    """Return mass, centre of mass and inertia of a link that shares its body with other links.

    If the values `m`, `c` and `I` of the link are replaced by `m₀ = 1 kg`, `c₀ = 0` and `I₀ = 1 kg m²`, the
    mass of the body changes by `m₀ − m`, its first moment of mass by `R (m₀ c₀ − m c) + (m₀ − m) p`, and its
    inertia about the body's origin correspondingly. `R` and `p` are the pose of the link in the body.
    """
    poses = {frame.name: np.array(frame.pose) for frame in model.frames}
    pose = poses.get(link, np.eye(4))
    rot, p = pose[:3, :3], pose[:3, 3]
    other = _replaced(model, link, mass=1.0, com=np.zeros(3), inertia=np.eye(3))
    after = next(candidate for candidate in other.bodies if candidate.name == body.name)
    mass = 1.0 - (after.mass - body.mass)
    if mass < _MASSLESS * body.mass:
        return LinkValues()
    # first moment of the link about the body's origin: that of the body minus that of the rest
    rest = after.mass * np.array(after.com) - p
    com_b = (body.mass * np.array(body.com) - rest) / mass
    about_rest = _about_origin(after) - (rot @ rot.T + _parallel(1.0, p))
    inertia_b = _about_origin(body) - about_rest - _parallel(mass, com_b)
    inertia = rot.T @ inertia_b @ rot
    return _values(mass, rot.T @ (com_b - p), 0.5 * (inertia + inertia.T))


def _about_origin(body: Body) -> Floats:
    """Return the inertia (3, 3), kg m², of a body about its origin, `I + m (c² 1 − c cᵀ)`."""
    return np.array(body.inertia) + _parallel(body.mass, np.array(body.com))


def _parallel(mass: float, com: Floats) -> Floats:
    """Return the term (3, 3), kg m², of the parallel-axis theorem, `m (c² 1 − c cᵀ)`."""
    result: Floats = mass * (com @ com * np.eye(3) - np.outer(com, com))
    return result
