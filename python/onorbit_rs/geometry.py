"""What a robot looks like: its visual geometry, or the box that has the inertia of a plain body."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from onorbit_rs._core import Model

    Floats = NDArray[np.float64]

GREY = (0.72, 0.73, 0.75, 1.0)


@dataclass(frozen=True)
class Shape:
    """One visible body.

    ``kind`` is box (``size`` x, y, z), cylinder or capsule (radius, length along z), sphere (radius) or mesh;
    ``pose`` (4, 4) is in the axes of ``link``; lengths in m; ``rgba`` from 0 to 1.
    """

    link: str
    pose: Floats
    kind: str
    size: tuple[float, ...]
    filename: Path | None
    scale: tuple[float, float, float]
    rgba: tuple[float, float, float, float]


def shapes(model: Model) -> list[Shape]:
    """Everything there is to draw of a robot; a model without geometry becomes one box."""
    found = [
        Shape(
            link=visual.link,
            pose=np.asarray(visual.pose, dtype=np.float64),
            kind=visual.kind,
            size=tuple(visual.size or ()),
            filename=Path(visual.filename) if visual.filename else None,
            scale=_three(visual.scale),
            rgba=_color(visual.rgba),
        )
        for visual in model.visuals
    ]
    return found or [_inertia_box(model)]


def _three(scale: Sequence[float] | None) -> tuple[float, float, float]:
    x, y, z = scale or (1.0, 1.0, 1.0)
    return x, y, z


def _color(rgba: Sequence[float] | None) -> tuple[float, float, float, float]:
    red, green, blue, alpha = rgba or GREY
    return red, green, blue, alpha


def _inertia_box(model: Model) -> Shape:
    """The uniform box with the mass and principal moments of the whole robot in its neutral configuration.

    `I_x = m (b² + c²) / 12` and its like give `a² = 6 (I_y + I_z - I_x) / m`.
    """
    matrix = np.asarray(model.mass_matrix(model.neutral()))
    mass = matrix[0, 0]
    # The base rows of M are [m 1, -m [c]; m [c], I_origin], with c the centre of mass in base axes.
    lever = matrix[3:6, :3] / mass
    center = np.array([lever[2, 1], lever[0, 2], lever[1, 0]])
    inertia = matrix[3:6, 3:6] - mass * (center @ center * np.eye(3) - np.outer(center, center))
    moments, axes = np.linalg.eigh(inertia)
    axes[:, 2] *= np.sign(np.linalg.det(axes))
    sides = np.sqrt(np.maximum(6.0 * (moments.sum() - 2.0 * moments) / mass, 1e-4))
    pose = np.eye(4)
    pose[:3, :3], pose[:3, 3] = axes, center
    return Shape(model.body_names[0], pose, "box", tuple(sides), None, (1.0, 1.0, 1.0), GREY)
