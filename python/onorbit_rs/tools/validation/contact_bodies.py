"""Bodies for the contact cases: collision shapes, an immovable floor, and rotors that turn a load."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import ArrayLike

import onorbit_rs as oo

IMMOVABLE = 1e15
"""Mass of bodies that a contact does not move, kg, and their moment of inertia, kg m²."""

RADIUS = 0.1  # of a sphere, m
SPHERE = f'<sphere radius="{RADIUS}"/>'
BLOCK = '<box size="10 10 2"/>'

ROTOR = (1e-4, 1e-7)
"""Mass of a rotor, kg, and its moment of inertia, kg m²."""


def body(shape: str, mass: float, inertia: ArrayLike, *, rotors: str = "") -> oo.Model:
    """Return a rigid body with one collision shape and one or three principal moments of inertia, kg m².

    ``rotors`` is an axis such as ``0 0 1``, about which the links ``left`` and ``right`` turn freely.
    """
    x, y, z = np.broadcast_to(np.asarray(inertia, dtype=float), 3)
    joints = "".join(_rotor(name, rotors) for name in ("left", "right")) if rotors else ""
    return oo.Model.from_urdf_string(
        f'<robot name="body"><link name="body">{_inertial(mass, (x, y, z))}'
        f"<collision><geometry>{shape}</geometry></collision></link>{joints}</robot>"
    )


def _inertial(mass: float, moments: Sequence[float]) -> str:
    x, y, z = map(float, moments)
    return (
        f'<inertial><mass value="{mass}"/>'
        f'<inertia ixx="{x}" iyy="{y}" izz="{z}" ixy="0" ixz="0" iyz="0"/></inertial>'
    )


def _rotor(name: str, axis: str) -> str:
    mass, moment = ROTOR
    return (
        f'<joint name="{name}" type="continuous"><parent link="body"/><child link="{name}"/>'
        f'<axis xyz="{axis}"/></joint>'
        f'<link name="{name}">{_inertial(mass, (moment, moment, moment))}</link>'
    )


def solid_sphere(mass: float = 1.0) -> oo.Model:
    """Return a uniform sphere."""
    return body(SPHERE, mass, 0.4 * mass * RADIUS**2)


def at(name: str, model: oo.Model, place: ArrayLike, velocity: ArrayLike = (0, 0, 0, 0, 0, 0)) -> oo.System:
    """Return a system without joints at a place (3,), m, with a velocity (6,), m/s and rad/s."""
    return oo.System(
        name, model, [*np.asarray(place, dtype=float), 0, 0, 0, 1], np.asarray(velocity, dtype=float)
    )


def floor() -> oo.System:
    """Return an immovable block whose upper face is the plane z = 0."""
    return at("floor", body(BLOCK, IMMOVABLE, IMMOVABLE), [0.0, 0.0, -1.0])


def oscillating(system: str, force: float, axis: ArrayLike) -> list[oo.BodyWrench]:
    """Return two forces of half the magnitude ``force``, N, on the rotors of a system.

    The rotors turn in opposite directions. The sum of both forces is therefore along ``axis`` (3,), which
    must be normal to the axis of the rotors, and varies as a sine of time.
    """
    half = 0.5 * force * np.asarray(axis, dtype=float)
    return [oo.BodyWrench(f"{system}/{rotor}", force=half) for rotor in ("left", "right")]


def turning(name: str, model: oo.Model, place: ArrayLike, rate: float) -> oo.System:
    """Return a system at rest whose rotors turn at ``rate``, rad/s; :func:`oscillating` loads start at 0."""
    quarter = 0.5 * np.pi
    q = [*np.asarray(place, dtype=float), 0, 0, 0, 1, -quarter, quarter]
    return oo.System(name, model, q, [0, 0, 0, 0, 0, 0, rate, -rate])
