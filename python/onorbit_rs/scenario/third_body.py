"""The pull of Sun and Moon."""

from __future__ import annotations

from pathlib import Path
from typing import Literal

from onorbit_rs import _core
from onorbit_rs.scenario.part import Part


class ThirdBodyEffect(Part):
    """The pull of the Sun or the Moon on robot and reference; needs an orbit and an epoch."""

    kind: Literal["third_body"] = "third_body"
    body: Literal["sun", "moon"]

    def make(self, _model: _core.Model, _beside: Path) -> _core.ThirdBody:
        """The effect of the engine."""
        return _core.ThirdBody(self.body)
