"""Forces, torques and momenta as arrows; each kind of arrow has a scale, which its label shows."""

from __future__ import annotations

import math
from dataclasses import dataclass, field
from typing import TYPE_CHECKING

import numpy as np
import rerun as rr

from onorbit_rs._core import COLUMNS
from onorbit_rs.common.coordinates import POSITION, QUATERNION
from onorbit_rs.common.display_units import amount, round_up
from onorbit_rs.common.rotations import matrix_from_quaternion
from onorbit_rs.viewer.colors import LOOPS, MOMENTUM, hues
from onorbit_rs.viewer.frames import FOLLOW, WORLD, put_in
from onorbit_rs.viewer.trace_rows import TIMELINE
from onorbit_rs.viewer.wrenches import centers_of_bodies, forces, net_force, torque_about_center
from onorbit_rs.visuals.geometry import box_around

if TYPE_CHECKING:
    from collections.abc import Iterator

    from numpy.typing import NDArray

    from onorbit_rs.viewer.colors import Color
    from onorbit_rs.viewer.setting import Setting
    from onorbit_rs.viewer.trace_rows import TraceRows
    from onorbit_rs.viewer.viewpoint import Viewpoint

    Floats = NDArray[np.float64]

WORTH_SHOWING = 1e-3
"""Smallest momentum drawn, as a fraction of the momentum of a rigid body with the same kinetic energy."""

ROUNDING = 1e-9
"""Ratio of a net force to the largest force on a body below which the net force is rounding error."""

LEAST_LENGTH = 0.2
"""Smallest length outside the robot of the longest arrow of a kind, in sizes of the robot."""

_FIRST_LINE, _LINE_HEIGHT = 0.5, 0.085
"""Position and line height of the legend, in sizes of the robot."""


@dataclass(frozen=True)
class _Kind:
    """Arrows that share a scale: entity path, name, unit and style."""

    path: str
    name: str
    unit: str
    color: Color
    longest: float = 0.55
    """Largest length of an arrow from its point of application, in sizes of the robot."""
    thickness: float = 1.0

    @classmethod
    def of_moments(cls, path: str, name: str, unit: str, color: Color) -> _Kind:
        """Return the kind of arrow for torques or angular momenta, which are drawn as thin arrows."""
        return cls(path, f"{name} (thin)", unit, color, 0.45, 0.5)


@dataclass
class Arrows:
    """Sends arrows, with a legend beside the robot; scales never decrease, so a run can be sent in parts."""

    recording: rr.RecordingStream
    setting: Setting
    viewpoint: Viewpoint
    _scales: dict[str, float] = field(default_factory=dict)

    def send(self, rows: TraceRows) -> None:
        """Send the arrows of momenta, closed loops and effects.

        They are the momenta at the centre of mass, the forces and moments of the closed loops and, if
        recorded, the forces and torques of every effect.
        """
        center = rows["center_of_mass"][:, None, :]
        for kind, vectors in self._momenta(rows):
            self._send(rows, kind, center, vectors[:, None, :])
        self._send_loops(rows)
        if not rows.wrenches:
            return
        centers = centers_of_bodies(rows, self.setting.model)
        (_, force_unit), (_, torque_unit) = COLUMNS["wrenches"].parts.values()
        for effect, hue in hues(rows.wrenches).items():
            wrenches, path, name = (
                rows.wrenches[effect],
                self.setting.entity(f"arrows/{effect}"),
                effect.replace("_", " "),
            )
            if 0.0 < ROUNDING * _peak(forces(wrenches)) > _peak(net_force(wrenches)):
                name = f"differential {name}"  # gravity_mode carried: the common acceleration is removed
            force = _Kind(f"{path}/force", f"{name} force", force_unit, hue.full)
            torque = _Kind.of_moments(f"{path}/torque", f"{name} torque", torque_unit, hue.pale)
            self._send(rows, force, centers, forces(wrenches))
            self._send(rows, torque, center, torque_about_center(rows, centers, wrenches)[:, None, :])

    def _send_loops(self, rows: TraceRows) -> None:
        """Send force and moment of all loops at their points, but no moments that are rounding errors."""
        if not rows.loops:
            return
        path, parts = self.setting.entity("loops"), COLUMNS["loops"].parts
        values = np.stack(list(rows.loops.values()), axis=1)
        points, (at, unit), (about, moment_unit) = (
            values[:, :, parts["point"][0]], parts["force"], parts["moment"]
        )  # fmt: skip
        name = "loop force on the second frame"
        force = _Kind(f"{path}/force", name, unit, LOOPS.full)
        self._send(rows, force, points, values[:, :, at], at_surface=False)
        if _peak(values[:, :, about]) > ROUNDING * _peak(values[:, :, at]) * self.viewpoint.size:
            moment = _Kind.of_moments(f"{path}/moment", "loop moment", moment_unit, LOOPS.pale)
            self._send(rows, moment, points, values[:, :, about], at_surface=False)

    def _momenta(self, rows: TraceRows) -> Iterator[tuple[_Kind, Floats]]:
        """Yield the momenta that are significant relative to the kinetic energy, or that were sent before."""
        mass, energy = self.setting.model.mass, float(rows["kinetic_energy"].max())
        path, hue = self.setting.entity("arrows"), MOMENTUM
        (linear_entries, linear_unit), (angular_entries, angular_unit) = COLUMNS["momentum"].parts.values()
        linear = _Kind(f"{path}/linear_momentum", "linear momentum", linear_unit, hue.full, 0.5)
        angular = _Kind.of_moments(f"{path}/angular_momentum", "angular momentum", angular_unit, hue.pale)
        scale = math.sqrt(2.0 * mass * energy)
        for kind, vectors, at_least in (
            (linear, rows["momentum"][:, linear_entries], scale),
            (angular, rows["momentum"][:, angular_entries], scale * self.viewpoint.size / 4.0),
        ):
            if _peak(vectors) > WORTH_SHOWING * at_least or kind.path in self._scales:
                yield kind, vectors

    def _send(
        self, rows: TraceRows, kind: _Kind, origins: Floats, vectors: Floats, *, at_surface: bool = True
    ) -> None:
        """Send arrows (T, n, 3) at origins (T, n, 3), m, both in W.

        By default, the first arrow begins at the surface of the base.
        """
        path = kind.path
        to_surface = self._to_surface(rows, origins, vectors) if at_surface else np.zeros(vectors.shape)
        room = kind.longest * self.viewpoint.size - np.linalg.norm(to_surface, axis=2, keepdims=True)
        needed = _peak(vectors / np.maximum(room, LEAST_LENGTH * self.viewpoint.size))
        scale = max(round_up(needed), self._scales.get(path, 0.0))
        if scale == 0.0 or not np.isfinite(scale):
            return
        count, each = vectors.shape[:2]
        if scale != self._scales.get(path):
            meaning = f"{path}/scale"
            if path not in self._scales:
                self._introduce(kind, meaning)
            self._scales[path] = scale
            label = rr.Points3D.columns(labels=[f"{kind.name}: 1 m = {amount(scale, kind.unit)}"])
            self.recording.send_columns(
                meaning, [rr.TimeColumn(TIMELINE, duration=rows["time"][:1])], label, strict=True
            )
        columns = rr.Arrows3D.columns(
            vectors=(vectors / scale).reshape(-1, 3), origins=(origins + to_surface).reshape(-1, 3)
        )
        parts = columns.partition([each] * count)
        self.recording.send_columns(path, [rows.times], parts, strict=True)

    def _to_surface(self, rows: TraceRows, origins: Floats, vectors: Floats) -> Floats:
        """Return the offsets (T, n, 3), m, that move the first arrows to the surface of the base."""
        found = np.zeros(vectors.shape)
        origins, vectors = origins[:, :1], vectors[:, :1]
        rot_wb = matrix_from_quaternion(rows["q"][:, QUATERNION])
        lengths = np.linalg.norm(vectors, axis=2, keepdims=True)
        ahead = vectors / np.where(lengths > 0.0, lengths, 1.0)
        origin_b, ahead_b = (origins - rows["q"][:, None, POSITION]) @ rot_wb, ahead @ rot_wb
        way = np.zeros(lengths.shape)
        for shape in self.setting.shapes:
            if shape.link == self.setting.base:
                pose, half = box_around(shape)
                start, along = (origin_b - pose[:3, 3]) @ pose[:3, :3], ahead_b @ pose[:3, :3]
                # start + t along reaches the faces, ±half, at t = (half - start · sign) / |along|.
                to_faces = (half - start * np.sign(along)) / np.maximum(np.abs(along), 1e-12)
                is_inside = (np.abs(start) < half).all(axis=2, keepdims=True)
                way = np.maximum(way, np.where(is_inside, to_faces.min(axis=2, keepdims=True), 0.0))
        way[lengths == 0.0] = 0.0
        found[:, :1] = way * ahead
        return found

    def _introduce(self, kind: _Kind, meaning: str) -> None:
        """Log the style of a kind of arrows, and the position of the label that shows their scale."""
        put_in(self.recording, kind.path, WORLD)
        put_in(self.recording, meaning, self.setting.frame(FOLLOW))
        radius = kind.thickness * self.viewpoint.size / 140.0
        style = rr.Arrows3D.from_fields(colors=[kind.color], radii=[radius])
        self.recording.log(kind.path, style, static=True, strict=True)
        place = self.viewpoint.place(0.79, _FIRST_LINE - _LINE_HEIGHT * len(self._scales))
        line = rr.Points3D.from_fields(positions=[place], colors=[kind.color], radii=[0.0], show_labels=True)
        self.recording.log(meaning, line, static=True, strict=True)


def _peak(vectors: Floats) -> float:
    return float(np.sqrt(np.einsum("...i,...i->...", vectors, vectors).max(initial=0.0)))
