"""Gravity of the Sun and the Moon."""

from __future__ import annotations

from pathlib import Path
from typing import Literal

from onorbit_rs import _core
from onorbit_rs.scenario.part import Part


class ThirdBodyEffect(Part):
    """Gravity of the Sun or the Moon, as a perturbation of the motion around the Earth.

    It requires an orbit and an epoch.
    """

    kind: Literal["third_body"] = "third_body"
    body: Literal["sun", "moon"]

    def build(self, _model: _core.Model | None, _folder: Path) -> _core.ThirdBody:
        """Return the engine's effect object."""
        return _core.ThirdBody(self.body)
