"""Constant force and torque on one body."""

from __future__ import annotations

from collections.abc import Collection
from pathlib import Path
from typing import Literal, Self

import numpy as np
from pydantic import Field, model_validator

from onorbit_rs import _core
from onorbit_rs.common.numbers import shortest
from onorbit_rs.common.suggestions import did_you_mean, nearest
from onorbit_rs.exceptions import FrameError
from onorbit_rs.scenario.environment.paths import split_link
from onorbit_rs.scenario.errors import invalid
from onorbit_rs.scenario.fields import Force3, Time, Torque3
from onorbit_rs.scenario.part import Part


class BodyWrenchEffect(Part):
    """Force and torque on one body, constant in body axes, from ``start`` to ``end``."""

    kind: Literal["body_wrench"] = "body_wrench"
    body: str
    """Link on which the wrench acts; with several systems ``SYSTEM/LINK``."""
    force: Force3 = Field(default_factory=lambda: [0.0, 0.0, 0.0])
    torque: Torque3 = Field(default_factory=lambda: [0.0, 0.0, 0.0])
    start: Time = 0.0
    end: Time | None = None
    """Simulated time at which the wrench ends, s. Default: the end of the run."""

    @model_validator(mode="after")
    def _ends_after_start(self) -> BodyWrenchEffect:
        if self.end is not None and self.end <= self.start:
            raise invalid(
                f"end is {shortest(self.end)} s; it must be later than start, {shortest(self.start)} s"
            )
        return self

    @property
    def paths(self) -> list[tuple[tuple[str, ...], str]]:
        """Location (key) and value of the entry that names the link on which the wrench acts."""
        return [(("body",), self.body)]

    def of_system(self, name: str, systems: Collection[str]) -> Self | None:
        """Return the wrench for the scenario of the system ``name`` alone; None if it acts on another system.

        In that scenario, ``body`` is the name of the link without the name of the system.
        """
        system, link = split_link(self.body, systems)
        return self.model_copy(update={"body": link}) if system == name else None

    def build(self, model: _core.Model | None, _folder: Path) -> _core.BodyWrench:
        """Return the engine's effect object.

        Raises FrameError if ``model`` is given and has no such body.
        """
        bodies = [self.body] if model is None else list(model.body_names)
        if self.body not in bodies:
            raise FrameError(
                f"no body is named {self.body!r}{did_you_mean(self.body, bodies)}",
                name=self.body, kind="body", known=bodies, suggestion=nearest(self.body, bodies),
            )  # fmt: skip
        times = {"start": self.start} | ({} if self.end is None else {"end": self.end})
        return _core.BodyWrench(self.body, force=np.array(self.force), torque=np.array(self.torque), **times)
