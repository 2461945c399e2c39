"""The planet's gravity field beside that of its point mass."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated, Literal

from pydantic import Field, SerializationInfo, field_serializer

from onorbit_rs import _core
from onorbit_rs.scenario.fields import Whole, beside
from onorbit_rs.scenario.part import Part


class GravityFieldEffect(Part):
    """``egm2008``, ``jgm3``, ``zonal``, or a ``.gfc`` file beside the scenario; turns as ``earth`` says."""

    kind: Literal["gravity_field"] = "gravity_field"
    model: str = "egm2008"
    degree: Annotated[Whole, Field(ge=2)] | None = None
    """36 for a bundled model, 6 for ``zonal``, the file's own for a file, where not given."""
    order: Annotated[Whole, Field(ge=0)] | None = None
    """That of the degree where not given."""

    @field_serializer("model", when_used="json")
    def _file(self, model: str, info: SerializationInfo) -> str:
        return beside(model, info) if self.is_file else model

    @property
    def is_file(self) -> bool:
        """Whether ``model`` is a path."""
        return self.model.endswith(".gfc")

    def make(self, _model: _core.Model, folder: Path) -> _core.GravityField:
        """The engine's."""
        degree = {} if self.degree is None else {"degree": self.degree}
        if self.is_file:
            return _core.GravityField.from_gfc(folder / self.model, order=self.order, **degree)
        if self.model == "zonal" and not self.order:
            return _core.GravityField.zonal(**degree)
        return _core.GravityField(self.model, order=self.order, **degree)
