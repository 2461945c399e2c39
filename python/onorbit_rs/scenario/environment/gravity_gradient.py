"""Torque of the gravity gradient."""

from __future__ import annotations

from pathlib import Path
from typing import Literal

from onorbit_rs import _core
from onorbit_rs.scenario.part import Part


class GravityGradientEffect(Part):
    """Gravity-gradient torque on every body about its centre of mass. It requires an orbit."""

    kind: Literal["gravity_gradient"] = "gravity_gradient"

    def build(self, _model: _core.Model | None, _folder: Path) -> _core.GravityGradient:
        """Return the engine's effect object."""
        return _core.GravityGradient()
