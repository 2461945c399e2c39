"""Camera position from which all systems are visible."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np

from onorbit_rs.common.coordinates import POSITION, QUATERNION
from onorbit_rs.common.decimate import evenly_spaced
from onorbit_rs.common.rotations import matrix_from_quaternion
from onorbit_rs.viewer.viewpoint import TO_EYE, Viewpoint
from onorbit_rs.visuals.geometry import corners_of

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from onorbit_rs.viewer.world_rows import WorldRows

    Floats = NDArray[np.float64]

NEAR = 8.0
"""Largest size of a scene, in sizes of its largest system, at which all systems are well visible."""

_SAMPLES = 12
_ABOVE = 0.4
"""Ratio of the camera's height above the line between two systems to its distance from that line."""
_WIDE, _HIGH = 0.65, 1.05
"""Factors by which the half width and the half height of a scene are multiplied to get half its size."""


def common_viewpoint(world: WorldRows) -> Viewpoint:
    """Return the viewpoint on all systems, relative to their common centre of mass, in axes of L or of W."""
    parts, shared = [], world.all_times
    for name, rows in world.systems.items():
        setting = world.setting.systems[name]
        for row in evenly_spaced(len(rows), _SAMPLES):
            at = np.searchsorted(shared["time"], rows["time"][row])
            place = corners_of(setting.model, setting.shapes, rows["q"][row : row + 1]) - world.center[at]
            parts.append(place if rows.rot_wl is None else place @ rows.rot_wl[row])
    points = np.concatenate(parts)
    center = (points.min(axis=0) + points.max(axis=0)) / 2.0
    first = world.first
    quat = first["q"][0, QUATERNION] if first.quat_lb is None else first.quat_lb[0]
    rot_fb = matrix_from_quaternion(quat)
    seen = Viewpoint(1.0, center, rot_fb, _from_beside(world, rot_fb))
    right, up, _ = np.abs((points - center) @ seen.sight().T).max(axis=0)
    return replace(seen, size=2.0 * float(max(_WIDE * right, _HIGH * up)))


def _from_beside(world: WorldRows, rot_fb: Floats) -> Floats:
    """Return the direction (3,), in base axes, to a camera in whose picture two systems are side by side."""
    setting = world.setting
    a, b = setting.connections[0].systems if setting.connections else setting.names[:2]
    line = world[b]["q"][0, POSITION] - world[a]["q"][0, POSITION]
    if world.first.rot_wl is not None:
        line = line @ world.first.rot_wl[0]
    up = np.array([0.0, 0.0, 1.0])
    beside = np.cross(line @ rot_fb, up)
    length = float(np.linalg.norm(beside))
    if length < _ABOVE * float(np.linalg.norm(line)):
        return TO_EYE
    beside *= np.copysign(1.0 / length, beside @ TO_EYE)
    to_eye: Floats = beside + _ABOVE * up
    return to_eye


def is_near(common: Viewpoint, alone: dict[str, Viewpoint]) -> bool:
    """Return True if a view of all systems is at most :data:`NEAR` times as large as the largest system."""
    return common.size <= NEAR * max(viewpoint.size for viewpoint in alone.values())
