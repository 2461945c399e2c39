"""Transforms between the frames of a run: inertial axes, reference orbit, systems and their links.

Poses are arrays (T, frames, 7): position, m, and quaternion xyzw of each frame in its parent frame.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from onorbit_rs.common.coordinates import BASE_Q, JOINTS_Q
from onorbit_rs.common.rotations import product, quaternion_from_matrix
from onorbit_rs.ros2.names import frame_names

if TYPE_CHECKING:
    from collections.abc import Mapping

    from numpy.typing import NDArray

    from onorbit_rs._core import Model
    from onorbit_rs.ros2.rows import Rows

    Floats = NDArray[np.float64]

ECI, WORLD, LVLH, BASE = "eci", "world", "lvlh", "base"


class Link(NamedTuple):
    """A frame and its parent frame."""

    parent: str
    child: str


def frames_of(prefix: str, model: Model) -> dict[str, str]:
    """Return the name in ``/tf``, without the prefix, of each link and frame of a robot.

    ``base`` is reserved for the root link; without a prefix, so are ``eci``, ``world`` and ``lvlh`` for the
    orbit.
    """
    reserved = {BASE} - {model.body_names[0]} | (set() if prefix else {ECI, WORLD, LVLH})
    return frame_names([*model.body_names, *(frame.name for frame in model.frames)], reserved)


class OrbitFrames:
    """Frames of the reference orbit.

    ``world`` has the axes of ``eci`` and its origin on the reference orbit; ``lvlh`` has x radial and z along
    the angular momentum, with the same origin.
    """

    links = (Link(ECI, WORLD), Link(WORLD, LVLH))

    def poses(self, rows: Rows) -> Floats:
        """Return the poses (T, 2, 7) of ``world`` and ``lvlh``."""
        found = np.zeros((len(rows), 2, 7))
        found[:, 0, :3], found[:, 0, 6] = rows["reference_position_eci"], 1.0
        found[:, 1, 3:] = rows.orbit_attitude
        return found


class SystemFrames:
    """Frames of a system: its base, whose parent is ``world``, and its moving links."""

    def __init__(self, prefix: str, model: Model, names: Mapping[str, str]) -> None:
        """Store the prefix of the frames, such as ``chaser/``, and their names in ``/tf`` without it."""
        joints = model.joints
        moving = (Link(prefix + names[joint.parent], prefix + names[joint.child]) for joint in joints)
        self.links = (Link(WORLD, prefix + BASE), *moving)
        pose = np.array([joint.pose for joint in joints]).reshape(-1, 4, 4)
        axis = np.array([joint.axis for joint in joints]).reshape(-1, 3)
        self._turns = np.array([joint.kind == "revolute" for joint in joints], dtype=bool)
        self._rotation, self._position = pose[:, :3, :3], pose[:, :3, 3]
        self._anchor = np.array([joint.anchor for joint in joints]).reshape(-1, 3)
        self._attitude = quaternion_from_matrix(self._rotation)
        self._slide = np.where(self._turns[:, None], 0.0, np.einsum("jik,jk->ji", self._rotation, axis))
        # q = q₀ (u sin θ/2, cos θ/2) is linear in sin θ/2 and cos θ/2
        self._sine = product(
            self._attitude, np.pad(np.where(self._turns[:, None], axis, 0.0), ((0, 0), (0, 1)))
        )
        self._axis = axis

    def poses(self, rows: Rows) -> Floats:
        """Return the poses (T, 1 + n, 7) of the base and of the child links of the n joints.

        The pose of a child link in its parent is `T₀ trans(c) exp(q) trans(−c)` at joint position `q`: `T₀`
        is the pose at zero, `trans` a translation, and `exp(q)` the motion about or along the axis through
        the anchor `c`.
        """
        q = rows["q"][:, JOINTS_Q]
        found = np.empty((len(q), 1 + q.shape[1], 7))
        found[:, 0] = rows["q"][:, BASE_Q]
        half = np.where(self._turns, 0.5 * q, 0.0)[..., None]
        found[:, 1:, 3:] = np.cos(half) * self._attitude + np.sin(half) * self._sine
        found[:, 1:, :3] = self._position + q[..., None] * self._slide
        if self._anchor.any():
            found[:, 1:, :3] += self._shift(q)
        return found

    def _shift(self, q: Floats) -> Floats:
        """Return the displacement, m, of each child link that turns about an anchor, in parent axes."""
        u, c = self._axis, np.where(self._turns[:, None], self._anchor, 0.0)
        across = np.cross(u, c)
        # c − exp(θ u) c = −sin θ u × c − (1 − cos θ) u × (u × c)
        moved = -np.sin(q)[..., None] * across - (1.0 - np.cos(q))[..., None] * np.cross(u, across)
        shift: Floats = np.einsum("jik,tjk->tji", self._rotation, moved)
        return shift


def fixed_frames(prefix: str, model: Model, names: Mapping[str, str]) -> tuple[list[Link], Floats]:
    """Return the frames that are fixed to links, with their poses (k, 7).

    The first frame is the root link in ``base``, unless the root link itself has this name.
    """
    bodies = set(model.body_names)
    root = model.body_names[0]
    links = [] if root == BASE else [Link(prefix + BASE, prefix + names[root])]
    poses = [np.eye(4)] * len(links)
    for frame in model.frames:
        if frame.name not in bodies:
            links.append(Link(prefix + names[frame.body], prefix + names[frame.name]))
            poses.append(np.array(frame.pose))
    pose = np.array(poses).reshape(-1, 4, 4)
    return links, np.concatenate([pose[:, :3, 3], quaternion_from_matrix(pose[:, :3, :3])], axis=1)
