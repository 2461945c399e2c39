"""Surfaces and lines of a run at one time, in axes of L or W with the origin at the base of a robot."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any

import numpy as np

from onorbit_rs.common.coordinates import POSITION, QUATERNION
from onorbit_rs.common.rotations import (
    is_local_frame_defined,
    local_orbital_axes,
    matrix_from_quaternion,
    product,
)
from onorbit_rs.visuals.geometry import Shape, corners_of
from onorbit_rs.visuals.shapes import collision_shapes, shapes
from onorbit_rs.visuals.solids import box_faces, robot_polygons

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from onorbit_rs._core import Earth, Model, Trace
    from onorbit_rs.scenario.targets import PathFrame, Target

    Floats = NDArray[np.float64]

NEARBY = 8.0
"""Distance, in sizes of the largest robot, up to which a robot is included in the picture by default."""

_AROUND = 48
"""Number of faces around a round body."""

_TARGET = (0.80, 0.67, 0.35)


@dataclass(frozen=True)
class Member:
    """A robot with its trace, the targets of its references, and the frame in which its path is drawn."""

    model: Model
    trace: Trace
    targets: tuple[Target, ...] = ()
    path_frame: PathFrame = "world"


@dataclass
class Scene:
    """Robots at one time; positions are in m, relative to the base of the first robot.

    Attributes
    ----------
    members : sequence of Member
        The robots.
    time : float
        Simulation time, s.
    earth : Earth or None
        Rotation of the Earth and position of the Sun.
    about_earth : bool
        Whether the robots orbit the Earth, which is then drawn.
    """

    members: list[Member]
    time: float
    earth: Earth | None = None
    about_earth: bool = False
    rot_ws: Floats = field(init=False)
    """Rotation from axes of the scene to W: those of L if it is defined, otherwise the identity."""
    origin: Floats = field(init=False)

    def __post_init__(self) -> None:
        """Determine axes and origin from the row of the first robot."""
        first, row = self.members[0].trace, self._row(self.members[0])
        self.origin = np.asarray(first.q)[row, POSITION]
        self.rot_ws = np.eye(3)
        if self.has_orbit and (rotation := _local_axes(first)) is not None:
            self.rot_ws = rotation[row]

    @property
    def has_orbit(self) -> bool:
        """Whether the run has a reference orbit."""
        return _has(self.members[0].trace, "reference_position_eci")

    @property
    def is_local(self) -> bool:
        """Whether the axes of the scene are those of L."""
        return self.has_orbit and _local_axes(self.members[0].trace) is not None

    @property
    def place_eci(self) -> Floats:
        """Position (3,) of the scene's origin relative to the centre of the planet, in inertial axes, m."""
        place: Floats = np.asarray(self.members[0].trace.position_eci)[self._row(self.members[0])]
        return place

    @property
    def rot_sb(self) -> Floats:
        """Rotation (3, 3) from the base axes of the first robot to axes of the scene."""
        q = np.asarray(self.members[0].trace.q)[self._row(self.members[0])]
        rotation: Floats = self.rot_ws.T @ matrix_from_quaternion(q[QUATERNION])
        return rotation

    def surfaces(self) -> tuple[Floats, Floats]:
        """Return faces (n, 4, 3), m, and their colours (n, 3) of all robots, and of targets of known size."""
        found = [self._drawn(member, shapes(member.model)) for member in self.members]
        found += [
            _target(self, target) for member in self.members for target in member.targets if target.size
        ]
        return np.concatenate([faces for faces, _ in found]), np.concatenate([colors for _, colors in found])

    def collision_faces(self) -> Floats:
        """Return the faces (n, 4, 3), m, of the collision shapes of all robots."""
        return np.concatenate(
            [self._drawn(member, collision_shapes(member.model), 16)[0] for member in self.members]
        )

    def corners(self) -> Floats:
        """Return corners (k, 3), m, of boxes around the first robot, and around what is near it.

        These are other robots, and paths of tools that are not much longer than the robots.
        """
        boxes = []
        for member in self.members:
            q = np.asarray(member.trace.q)[self._row(member)]
            boxes.append(self.seen_from(corners_of(member.model, shapes(member.model), q[None])))
        size = max(float(np.linalg.norm(np.ptp(box, axis=0))) for box in boxes)
        paths = [points[np.isfinite(points).all(axis=1)] for _, points in self.paths()]
        boxes += [path for path in paths if len(path) and np.linalg.norm(np.ptp(path, axis=0)) < 1.5 * size]
        near = [box for box in boxes if np.linalg.norm(box.mean(axis=0)) < NEARBY * size]
        return np.concatenate(near)

    def paths(self) -> list[tuple[str, Floats]]:
        """Return the whole desired path and the obtained path so far, (k, 3), m, of each tool, with names."""
        found = []
        for member in self.members:
            for name, column in (("desired", "reference_pose"), ("obtained", "tool_pose")):
                if _has(member.trace, column):
                    points = self._path(member, np.asarray(getattr(member.trace, column))[:, :3, 3])
                    found.append((name, points if name == "desired" else points[: self._row(member) + 1]))
        return found

    def seen_from(self, points_w: Floats) -> Floats:
        """Convert points (..., 3), m, from W to the axes and the origin of the scene."""
        seen: Floats = (points_w - self.origin) @ self.rot_ws
        return seen

    def _path(self, member: Member, points_w: Floats) -> Floats:
        """Convert a path (T, 3), m, from W to the scene; it keeps its shape in the frame of the path."""
        row, trace = self._row(member), member.trace
        if member.path_frame == "base":
            rot_wb = matrix_from_quaternion(np.asarray(trace.q)[:, QUATERNION])
            base = np.asarray(trace.q)[:, POSITION]
            in_base = np.einsum("tji,tj->ti", rot_wb, points_w - base)
            return self.seen_from(in_base @ rot_wb[row].T + base[row])
        if member.path_frame == "lvlh" and self.is_local:
            rot_wl = _local_axes(trace)
            assert rot_wl is not None
            in_scene: Floats = np.einsum("tji,tj->ti", rot_wl, points_w) - self.origin @ self.rot_ws
            return in_scene
        return self.seen_from(points_w)

    def _drawn(self, member: Member, drawn: list[Shape], around: int = _AROUND) -> tuple[Floats, Floats]:
        q = np.asarray(member.trace.q)[self._row(member)]
        faces, colors = robot_polygons(member.model, q[None], drawn, around)[0]
        return self.seen_from(faces), colors

    def _row(self, member: Member) -> int:
        """Return the index of the last row of a robot that is not later than the time of the scene."""
        times = np.asarray(member.trace.time)
        return max(int(np.searchsorted(times, self.time * (1.0 + 1e-12), side="right")) - 1, 0)


def _has(trace: Any, column: str) -> bool:
    return getattr(trace, column, None) is not None


def _local_axes(trace: Trace) -> Floats | None:
    """Return the rotations (T, 3, 3) from L to W; None if L is undefined."""
    r, v = np.asarray(trace.reference_position_eci), np.asarray(trace.reference_velocity_eci)
    return local_orbital_axes(r, v) if is_local_frame_defined(r, v) else None


def _target(scene: Scene, target: Target) -> tuple[Floats, Floats]:
    """Return the faces (n, 4, 3), m, of the box of a target, and their colours (n, 3)."""
    rate = float(np.linalg.norm(target.spin))
    axis = target.spin / rate if rate > 0.0 else np.array([0.0, 0.0, 1.0])
    half = rate * scene.time / 2.0
    turned = product(np.append(np.sin(half) * axis, np.cos(half)), target.quat_xyzw)
    place = target.position_at(np.array([scene.time]))[0]
    faces = box_faces(np.array(target.size)) @ matrix_from_quaternion(turned).T + place
    return scene.seen_from(faces), np.tile(_TARGET, (len(faces), 1))
