"""Gravity field of the planet beyond its point mass."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated, Literal

from pydantic import Field, SerializationInfo, field_serializer

from onorbit_rs import _core
from onorbit_rs.scenario.fields import Whole, resolved_path
from onorbit_rs.scenario.part import Part


class GravityFieldEffect(Part):
    """Gravity field, whose axes rotate with the planet as the key ``earth`` defines."""

    kind: Literal["gravity_field"] = "gravity_field"
    model: str = "egm2008"
    """Model: ``egm2008``, ``jgm3``, ``zonal``, or the path of a ``.gfc`` file relative to the scenario."""
    degree: Annotated[Whole, Field(ge=2)] | None = None
    """Highest degree. Default: 36 for a bundled model, 6 for ``zonal``, the degree of the file for a file."""
    order: Annotated[Whole, Field(ge=0)] | None = None
    """Highest order. Default: the degree, or 0 for ``zonal``."""

    @field_serializer("model", when_used="json")
    def _file(self, model: str, info: SerializationInfo) -> str:
        return resolved_path(model, info) if self.is_file else model

    @property
    def is_file(self) -> bool:
        """True if ``model`` is the path of a ``.gfc`` file."""
        return self.model.endswith(".gfc")

    def build(self, _model: _core.Model | None, folder: Path) -> _core.GravityField:
        """Return the engine's effect object."""
        degree = {} if self.degree is None else {"degree": self.degree}
        if self.is_file:
            return _core.GravityField.from_gfc(folder / self.model, order=self.order, **degree)
        if self.model == "zonal" and not self.order:
            return _core.GravityField.zonal(**degree)
        return _core.GravityField(self.model, order=self.order, **degree)
