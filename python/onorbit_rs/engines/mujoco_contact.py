"""Collision geometry of the contacts of a world in a MuJoCo model."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np

from onorbit_rs._core import Contact, HuntCrossley, ImpactLaw, SpringDashpot
from onorbit_rs.common.counting import count
from onorbit_rs.common.link_patterns import link_pattern
from onorbit_rs.exceptions import EngineError

if TYPE_CHECKING:
    from collections.abc import Mapping
    from types import ModuleType

    from numpy.typing import NDArray

    from onorbit_rs._core import Friction, Model, Visual

    Floats = NDArray[np.float64]

IMPEDANCE = 1e-4
"""Impedance of contacts (``solimp``), the least that MuJoCo accepts: the regularization ``R`` of a normal row
is 10⁴ times its apparent inverse mass, so its force hardly depends on the accelerations."""

FRICTION_TO_NORMAL = 1e8
"""``impratio``: friction rows have ``R/10⁸``, which is the stiffest friction of MuJoCo (impedance 0.9999)."""


@dataclass(frozen=True)
class Touch:
    """Contact of a world, with the names of MuJoCo's geoms that may touch, those of the first side first."""

    name: str
    law: HuntCrossley | SpringDashpot
    friction: Friction | None
    pairs: tuple[tuple[str, str], ...]

    def elastic(self, depth: Floats) -> Floats:
        """Return the elastic force, N, at the depths, m."""
        exponent = self.law.exponent if isinstance(self.law, HuntCrossley) else 1.0
        force: Floats = self.law.stiffness * np.maximum(depth, 0.0) ** exponent
        return force

    def force(self, depth: Floats, rate: Floats) -> Floats:
        """Return the normal force, N, ≥ 0, at depths, m, that increase at rates, m/s; 0 without overlap."""
        if isinstance(self.law, HuntCrossley):
            force = self.elastic(depth) * (1.0 + self.law.dissipation * rate)
        else:
            force = self.elastic(depth) + self.law.damping * rate
        return np.where(depth > 0.0, np.maximum(force, 0.0), 0.0)


def add_contacts(
    mujoco: ModuleType,
    spec: Any,
    bodies: Mapping[str, tuple[Model, Mapping[str, Any]]],
    contacts: Sequence[Contact],
    time_step: float,
) -> list[Touch]:
    """Add the collision shapes of the contacts with forces and the pairs that may touch; return the contacts.

    Only declared pairs touch: the geoms have no collision class. ``bodies`` are the model and MuJoCo's bodies
    of each system by its name.

    Raises
    ------
    EngineError
        If MuJoCo cannot represent a contact.
    """
    made: dict[tuple[str, int], str] = {}
    touches = []
    for contact in _with_forces(contacts):
        sides = [
            [_geom(mujoco, spec, bodies, one, made) for one in _pieces(bodies, contact.name, links)]
            for links in (contact.links_a, contact.links_b)
        ]
        pairs = [(a, b) for link_a, a in sides[0] for link_b, b in sides[1] if link_a != link_b]
        for a, b in pairs:
            _add_pair(spec, a, b, contact.friction, time_step)
        assert isinstance(contact.normal, (HuntCrossley, SpringDashpot))
        touches.append(Touch(contact.name, contact.normal, contact.friction, tuple(pairs)))
    if touches:
        spec.option.jacobian = mujoco.mjtJacobian.mjJAC_DENSE
        spec.option.cone = mujoco.mjtCone.mjCONE_ELLIPTIC
        spec.option.impratio = FRICTION_TO_NORMAL
        spec.option.ccd_tolerance, spec.option.ccd_iterations = 1e-12, 200
    return touches


def _with_forces(contacts: Sequence[Contact]) -> list[Contact]:
    """Return the contacts that have a normal force; raise EngineError for a wrong type or law."""
    wrong = (
        [one for one in contacts if not isinstance(one, Contact)]
        if isinstance(contacts, Sequence)
        else [contacts]
    )
    if wrong:
        kind = type(wrong[0]).__name__
        verb = "contains" if isinstance(contacts, Sequence) else "is"
        raise EngineError(
            f"contacts {verb} a value of type {kind}; give a list such as [oo.Contact(...)]",
            name="contacts", got=kind,
        )  # fmt: skip
    found = [contact for contact in contacts if contact.normal is not None]
    for contact in found:
        _check(contact)
    return found


def _check(contact: Contact) -> None:
    """Raise EngineError if MuJoCo cannot represent the law of a contact."""
    if isinstance(contact.normal, ImpactLaw):
        raise EngineError(
            f"contact '{contact.name}' has an impact law, but MuJoCo's contacts are compliant; use a "
            "HuntCrossley or a SpringDashpot, or use engine: native",
            name="normal", got="ImpactLaw", expected="HuntCrossley or SpringDashpot",
        )  # fmt: skip
    if contact.friction is not None and contact.friction.torsional > 0.0:
        raise EngineError(
            f"contact '{contact.name}' has torsional friction ({contact.friction.torsional:g} m), but MuJoCo "
            "limits the friction force and the torsional moment together, instead of each by itself; set "
            "torsional to 0, or use engine: native",
            name="torsional", got=contact.friction.torsional, expected=0.0,
        )  # fmt: skip


def _pieces(
    bodies: Mapping[str, tuple[Model, Mapping[str, Any]]], contact: str, links: Sequence[str]
) -> list[tuple[str, int]]:
    """Return the system and the index of every collision shape of the links that match the patterns."""
    patterns = [link_pattern(link) for link in links]
    found = [
        (system, index)
        for system, (model, _) in bodies.items()
        for index, shape in enumerate(model.collisions)
        if any(pattern.fullmatch(f"{system}/{shape.link}") for pattern in patterns)
    ]
    if not found:
        systems = [system for system in bodies if system]
        known = f"{count(len(systems), 'system', 'systems')} ({', '.join(systems)})"
        known = known if systems else "a single robot, but no named systems"
        raise EngineError(
            f"contact '{contact}': no link with a collision shape matches {', '.join(links)}; this engine "
            f"has {known}; correct the names of the links, add a collision shape to one of them, or add the "
            "missing system to 'model' of Mujoco",
            name="contacts", got=contact,
        )  # fmt: skip
    return found


def _geom(
    mujoco: ModuleType,
    spec: Any,
    bodies: Mapping[str, tuple[Model, Mapping[str, Any]]],
    piece: tuple[str, int],
    made: dict[tuple[str, int], str],
) -> tuple[str, str]:
    """Return the link of a collision shape and the name of its geom, which is added unless it exists."""
    system, index = piece
    model, of_system = bodies[system]
    shape = model.collisions[index]
    link = f"{system}/{shape.link}"
    if piece not in made:
        frame = next(frame for frame in model.frames if frame.name == shape.link)
        pose = np.array(frame.pose) @ np.array(shape.pose)
        geom = of_system[frame.body].add_geom()
        geom.name = made[piece] = f"shape {index} of {link}"
        geom.pos, geom.quat = pose[:3, 3], np.empty(4)
        mujoco.mju_mat2Quat(geom.quat, pose[:3, :3].ravel())
        geom.contype = geom.conaffinity = 0
        geom.mass = 0.0
        _set_shape(mujoco, spec, geom, shape)
    return link, made[piece]


def _set_shape(mujoco: ModuleType, spec: Any, geom: Any, shape: Visual) -> None:
    kinds = mujoco.mjtGeom
    if shape.kind in ("mesh", "hull"):
        mesh = spec.add_mesh()
        mesh.name, mesh.scale = geom.name, shape.scale
        if shape.kind == "mesh":
            mesh.file = shape.filename
        else:
            mesh.uservert = np.ravel(shape.points)
        mesh.inertia = mujoco.mjtMeshInertia.mjMESH_INERTIA_CONVEX
        geom.type, geom.meshname = kinds.mjGEOM_MESH, mesh.name
        return
    known = {"box": kinds.mjGEOM_BOX, "cylinder": kinds.mjGEOM_CYLINDER, "capsule": kinds.mjGEOM_CAPSULE,
             "sphere": kinds.mjGEOM_SPHERE}  # fmt: skip
    if shape.kind not in known:
        raise EngineError(
            f"the collision shape of link '{shape.link}' is of the kind '{shape.kind}', which is not "
            "supported with MuJoCo; use boxes, cylinders, capsules, spheres or meshes, or engine: native",
            name=shape.link, got=shape.kind, expected=", ".join(known),
        )  # fmt: skip
    geom.type = known[shape.kind]
    if shape.kind == "box":
        size = [edge / 2.0 for edge in shape.size]
    else:  # radius, and half the length unless it is a sphere
        size = [shape.size[0], *(length / 2.0 for length in shape.size[1:]), 0.0, 0.0][:3]
    geom.size = np.array(size)


def _add_pair(spec: Any, a: str, b: str, friction: Friction | None, time_step: float) -> None:
    """Permit two geoms to touch, with the friction of their contact."""
    pair = spec.add_pair()
    pair.geomname1, pair.geomname2 = a, b
    pair.condim = 1 if friction is None else 3
    pair.solimp = np.array([IMPEDANCE, IMPEDANCE, 1.0, 0.5, 1.0])
    # a_ref = −B v across the normal, with the time constant of two time steps; MuJoCo divides B by the
    # impedance. Along the normal, a_ref follows from the law.
    pair.solref = pair.solreffriction = np.array([-1.0, -IMPEDANCE / time_step])
    pair.friction = np.full(5, 0.0 if friction is None else friction.static)
