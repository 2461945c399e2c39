"""Forces, torques and momenta as arrows, each kind on a scale of its own that its label states."""

from __future__ import annotations

import math
from dataclasses import dataclass, field
from typing import TYPE_CHECKING

import numpy as np
import rerun as rr

from onorbit_rs.units import amount
from onorbit_rs.viewer.frames import FOLLOW, WORLD, put_in
from onorbit_rs.viewer.rows import TIMELINE
from onorbit_rs.viewer.wrenches import centers_of_bodies, torque_about_center

if TYPE_CHECKING:
    from collections.abc import Iterator

    from numpy.typing import NDArray

    from onorbit_rs.viewer.rows import Rows
    from onorbit_rs.viewer.setting import Setting
    from onorbit_rs.viewer.stage import Stage

    Floats = NDArray[np.float64]

WORTH_SHOWING = 1e-3
"""Least momentum, as a share of what the kinetic energy would give to one rigid body, to be drawn."""

_COLORS = {
    "gravity": (150, 135, 255),
    "gravity_gradient": (225, 130, 245),
    "drag": (80, 220, 230),
    "radiation_pressure": (255, 225, 90),
}
_OTHER_COLOR, _MOMENTUM_COLOR = (255, 150, 190), (255, 190, 60)


@dataclass
class Arrows:
    """Sends arrows and beside the robot what they mean. Scales only grow, so that a run may come in parts."""

    recording: rr.RecordingStream
    setting: Setting
    stage: Stage
    _scales: dict[str, float] = field(default_factory=dict)

    def send(self, rows: Rows) -> None:
        """Momenta at the centre of mass and, where they are recorded, forces and torques of every effect."""
        for name, vectors, unit in self._momenta(rows):
            origins = rows["center_of_mass"][:, None, :]
            path = f"world/arrows/{name.replace(' ', '_')}"
            self._send(rows, path, name, unit, _MOMENTUM_COLOR, origins, vectors[:, None, :], 0.6)
        if not rows.wrenches:
            return
        centers = centers_of_bodies(rows, self.setting.model)
        for effect, wrenches in rows.wrenches.items():
            color, name = _COLORS.get(effect, _OTHER_COLOR), effect.replace("_", " ")
            force = wrenches[:, :, :3]
            path = f"world/arrows/{effect}"
            self._send(rows, f"{path}/force", name, "N", color, centers, force, 0.7)
            total = torque_about_center(rows, centers, wrenches)[:, None, :]
            origin = rows["center_of_mass"][:, None, :]
            self._send(rows, f"{path}/torque", f"{name} torque", "N m", color, origin, total, 0.6)

    def _momenta(self, rows: Rows) -> Iterator[tuple[str, Floats, str]]:
        """Those that are more than rounding and the pull of tides beside the motion of the joints."""
        mass, energy = self.setting.model.mass, float(rows["kinetic_energy"].max())
        radius = self.stage.size / 4.0
        scale = math.sqrt(2.0 * mass * energy)
        for name, vectors, unit, at_least in (
            ("linear momentum", rows["momentum"][:, :3], "N s", scale),
            ("angular momentum", rows["momentum"][:, 3:], "N m s", scale * radius),
        ):
            peak = _peak(vectors)
            if peak > WORTH_SHOWING * at_least or f"world/arrows/{name.replace(' ', '_')}" in self._scales:
                yield name, vectors, unit

    def _send(
        self,
        rows: Rows,
        path: str,
        name: str,
        unit: str,
        color: tuple[int, int, int],
        origins: Floats,
        vectors: Floats,
        longest: float,
    ) -> None:
        """Arrows (T, n, 3) at origins (T, n, 3), W, the longest so many times the robot's size."""
        peak = _peak(vectors)
        scale = max(_round_up(peak / (longest * self.stage.size)), self._scales.get(path, 0.0))
        if scale == 0.0 or not np.isfinite(scale):
            return
        count, each = vectors.shape[:2]
        if scale != self._scales.get(path):
            meaning = f"{path}/scale"
            if path not in self._scales:
                self._introduce(path, meaning, color)
            self._scales[path] = scale
            label = rr.Points3D.columns(labels=[f"{name}: 1 m = {amount(scale, unit)}"])
            self.recording.send_columns(
                meaning, [rr.TimeColumn(TIMELINE, duration=rows["time"][:1])], label, strict=True
            )
        columns = rr.Arrows3D.columns(
            vectors=(vectors / scale).reshape(-1, 3), origins=origins.reshape(-1, 3)
        )
        parts = columns.partition([each] * count)
        self.recording.send_columns(path, [rows.times], parts, strict=True)

    def _introduce(self, path: str, meaning: str, color: tuple[int, int, int]) -> None:
        """The look of arrows, and the place of the line that tells their scale."""
        put_in(self.recording, path, WORLD)
        put_in(self.recording, meaning, FOLLOW)
        look = rr.Arrows3D.from_fields(colors=[color], radii=[self.stage.size / 160.0])
        self.recording.log(path, look, static=True, strict=True)
        place = self.stage.place(0.86, 0.42 - 0.09 * len(self._scales))
        line = rr.Points3D.from_fields(positions=[place], colors=[color], radii=[0.0], show_labels=True)
        self.recording.log(meaning, line, static=True, strict=True)


def _peak(vectors: Floats) -> float:
    return float(np.sqrt(np.einsum("...i,...i->...", vectors, vectors).max(initial=0.0)))


def _round_up(value: float) -> float:
    """To 1, 2 or 5 times a power of ten; what has no such number above it stays as it is."""
    if not 0.0 < value < math.inf:
        return 0.0 if value <= 0.0 else value
    power = 10.0 ** math.floor(math.log10(value))
    steps = (step * power for step in (1.0, 2.0, 5.0, 10.0))
    return next((step for step in steps if value * (1.0 - 1e-12) <= step < math.inf), value)
