"""Pictures of a scene, drawn in software: no screen and no graphics driver is required."""

from __future__ import annotations

from onorbit_rs.pictures.picture import draw_picture
from onorbit_rs.pictures.scene import Scene

__all__ = ["Scene", "draw_picture"]
