"""Forces, torques and momenta as arrows, each kind on a scale of its own that its label states."""

from __future__ import annotations

import math
from dataclasses import dataclass, field
from typing import TYPE_CHECKING

import numpy as np
import rerun as rr

from onorbit_rs.geometry import box_around
from onorbit_rs.rotations import matrix_from_quaternion
from onorbit_rs.units import amount, round_up
from onorbit_rs.viewer.colors import MOMENTUM, hues
from onorbit_rs.viewer.frames import FOLLOW, WORLD, put_in
from onorbit_rs.viewer.rows import TIMELINE
from onorbit_rs.viewer.wrenches import centers_of_bodies, torque_about_center

if TYPE_CHECKING:
    from collections.abc import Iterator

    from numpy.typing import NDArray

    from onorbit_rs.viewer.colors import Color
    from onorbit_rs.viewer.rows import Rows
    from onorbit_rs.viewer.setting import Setting
    from onorbit_rs.viewer.stage import Stage

    Floats = NDArray[np.float64]

WORTH_SHOWING = 1e-3
"""Least momentum, as a share of what the kinetic energy would give to one rigid body, to be drawn."""

ROUNDING = 1e-9
"""A net force below it, in units of the largest on a body, is none."""

LEAST_LENGTH = 0.2
"""Of the longest arrow of a kind outside a robot that is one solid, in sizes of the robot."""

_FIRST_LINE, _LINE_HEIGHT = 0.5, 0.085
"""Of the legend, in sizes of the robot."""


@dataclass(frozen=True)
class _Kind:
    """Arrows that share a scale: where they are logged, their name, unit and look."""

    path: str
    name: str
    unit: str
    color: Color
    longest: float = 0.55
    """How far it reaches from where it acts, in sizes of the robot."""
    thickness: float = 1.0

    @classmethod
    def of_turning(cls, path: str, name: str, unit: str, color: Color) -> _Kind:
        """Of moments: thin, which the legend says."""
        return cls(path, f"{name} (thin)", unit, color, 0.45, 0.5)


@dataclass
class Arrows:
    """Sends arrows and beside the robot what they mean. Scales only grow, so that a run may come in parts."""

    recording: rr.RecordingStream
    setting: Setting
    stage: Stage
    _scales: dict[str, float] = field(default_factory=dict)

    def send(self, rows: Rows) -> None:
        """Momenta at the centre of mass and, where they are recorded, forces and torques of every effect."""
        center = rows["center_of_mass"][:, None, :]
        for kind, vectors in self._momenta(rows):
            self._send(rows, kind, center, vectors[:, None, :])
        if not rows.wrenches:
            return
        centers = centers_of_bodies(rows, self.setting.model)
        for effect, hue in hues(rows.wrenches).items():
            wrenches, path, name = rows.wrenches[effect], f"world/arrows/{effect}", effect.replace("_", " ")
            if 0.0 < ROUNDING * _peak(wrenches[:, :, :3]) > _peak(wrenches[:, :, :3].sum(axis=1)):
                name = f"differential {name}"  # of a robot that is carried: less what all bodies share
            force = _Kind(f"{path}/force", f"{name} force", "N", hue.full)
            torque = _Kind.of_turning(f"{path}/torque", f"{name} torque", "N m", hue.pale)
            self._send(rows, force, centers, wrenches[:, :, :3])
            self._send(rows, torque, center, torque_about_center(rows, centers, wrenches)[:, None, :])

    def _momenta(self, rows: Rows) -> Iterator[tuple[_Kind, Floats]]:
        """Those that are more than rounding and the pull of tides beside the motion of the joints."""
        mass, energy = self.setting.model.mass, float(rows["kinetic_energy"].max())
        path, hue = "world/arrows", MOMENTUM
        linear = _Kind(f"{path}/linear_momentum", "linear momentum", "N s", hue.full, 0.5)
        angular = _Kind.of_turning(f"{path}/angular_momentum", "angular momentum", "N m s", hue.pale)
        scale = math.sqrt(2.0 * mass * energy)
        for kind, vectors, at_least in (
            (linear, rows["momentum"][:, :3], scale),
            (angular, rows["momentum"][:, 3:], scale * self.stage.size / 4.0),
        ):
            if _peak(vectors) > WORTH_SHOWING * at_least or kind.path in self._scales:
                yield kind, vectors

    def _send(self, rows: Rows, kind: _Kind, origins: Floats, vectors: Floats) -> None:
        """Arrows (T, n, 3) at origins (T, n, 3), W."""
        path, to_surface = kind.path, self._to_surface(rows, origins, vectors)
        room = kind.longest * self.stage.size - np.linalg.norm(to_surface, axis=2, keepdims=True)
        needed = _peak(vectors / np.maximum(room, LEAST_LENGTH * self.stage.size))
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

    def _to_surface(self, rows: Rows, origins: Floats, vectors: Floats) -> Floats:
        """(T, n, 3) from where arrows start to where they leave the base, which would hide the first; m."""
        found = np.zeros(vectors.shape)
        origins, vectors = origins[:, :1], vectors[:, :1]
        rot_wb = matrix_from_quaternion(rows["q"][:, 3:7])
        lengths = np.linalg.norm(vectors, axis=2, keepdims=True)
        ahead = vectors / np.where(lengths > 0.0, lengths, 1.0)
        origin_b, ahead_b = (origins - rows["q"][:, None, :3]) @ rot_wb, ahead @ rot_wb
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
        """The look of arrows, and the place of the line that tells their scale."""
        put_in(self.recording, kind.path, WORLD)
        put_in(self.recording, meaning, FOLLOW)
        radius = kind.thickness * self.stage.size / 140.0
        look = rr.Arrows3D.from_fields(colors=[kind.color], radii=[radius])
        self.recording.log(kind.path, look, static=True, strict=True)
        place = self.stage.place(0.79, _FIRST_LINE - _LINE_HEIGHT * len(self._scales))
        line = rr.Points3D.from_fields(positions=[place], colors=[kind.color], radii=[0.0], show_labels=True)
        self.recording.log(meaning, line, static=True, strict=True)


def _peak(vectors: Floats) -> float:
    return float(np.sqrt(np.einsum("...i,...i->...", vectors, vectors).max(initial=0.0)))
