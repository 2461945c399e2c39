"""Shaded surfaces in 3-D figures."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
from mpl_toolkits.mplot3d.art3d import Poly3DCollection  # type: ignore[import-untyped]  # ships no types
from mpl_toolkits.mplot3d.axes3d import Axes3D  # type: ignore[import-untyped]  # ships no types

if TYPE_CHECKING:
    from numpy.typing import NDArray

    Floats = NDArray[np.float64]

DARKEST = 0.15
"""Smallest colour component that is drawn: a black surface would show no shading."""

LIGHT = np.array([0.3, -0.7, 0.65])
"""Unit vector towards the light source, in axes of W."""


def add_surfaces(axes: Axes3D, faces: Floats, colors: Floats) -> None:
    """Draw faces (n, 4, 3) with colours (n, 3); the visible side is lit from above and from the front.

    Each edge has the colour of its face, so that no gaps are visible between faces.
    """
    # the diagonals of a face give its normal even if two corners coincide, as at a pole
    normals = np.cross(faces[:, 2] - faces[:, 0], faces[:, 3] - faces[:, 1])
    normals /= np.maximum(np.linalg.norm(normals, axis=1, keepdims=True), 1e-30)
    seen_from_behind = normals @ _direction_to_viewer(axes) < 0.0
    brightness = (normals @ LIGHT) * np.where(seen_from_behind, -1.0, 1.0)
    shaded = np.clip(np.maximum(colors, DARKEST) * (0.66 + 0.34 * brightness)[:, None], 0.0, 1.0)
    axes.add_collection3d(
        Poly3DCollection(faces, facecolors=shaded, edgecolors=shaded, linewidths=0.2, zorder=1)
    )


def _direction_to_viewer(axes: Axes3D) -> Floats:
    """Return the unit vector (3,) from the scene to the viewer."""
    elevation, azimuth = np.radians([axes.elev, axes.azim])
    return np.array(
        [np.cos(elevation) * np.cos(azimuth), np.cos(elevation) * np.sin(azimuth), np.sin(elevation)]
    )
