"""The air that drag is of."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated, Literal

from pydantic import BeforeValidator, Field

from onorbit_rs import _core
from onorbit_rs.scenario.fields import Angle, Density, FilePath, Length, NotNegative, Number, Positive
from onorbit_rs.scenario.part import Part, of_kind
from onorbit_rs.scenario.refusals import wrong
from onorbit_rs.scenario.units import NUMBER, parse_quantity


class ConstantAir(Part):
    """The same density everywhere."""

    kind: Literal["constant"] = "constant"
    density: Annotated[Density, NotNegative]

    def make(self, beside: Path) -> _core.Atmosphere:
        """The engine's."""
        return _core.ConstantAtmosphere(self.density)


class ExponentialAir(Part):
    """One layer, or Vallado's table where nothing is given."""

    kind: Literal["exponential"] = "exponential"
    density: Annotated[Density, Positive] | None = None
    altitude: Length | None = None
    scale_height: Annotated[Length, Positive] | None = None

    def make(self, beside: Path) -> _core.Atmosphere:
        """The engine's."""
        return _core.ExponentialAtmosphere(
            density=self.density, altitude=self.altitude, scale_height=self.scale_height
        )


class HarrisPriesterAir(Part):
    """A bulge that follows the Sun; needs an epoch."""

    kind: Literal["harris_priester"] = "harris_priester"
    exponent: Number = 4.0
    lag: Angle | None = None

    def make(self, beside: Path) -> _core.Atmosphere:
        """The engine's."""
        lag = {} if self.lag is None else {"lag": self.lag}
        return _core.HarrisPriester(exponent=self.exponent, **lag)


def _ap(value: object) -> float | list[float]:
    if not isinstance(value, list):
        return parse_quantity(value, NUMBER)
    if len(value) != 7:
        raise wrong(f"ap is one number or seven, not {len(value)}")
    return [parse_quantity(entry, NUMBER) for entry in value]


GeomagneticIndex = Annotated[float | list[float], BeforeValidator(_ap)]


class Nrlmsise00Air(Part):
    """NRLMSISE-00 under constant indices or those of a table; needs an epoch."""

    kind: Literal["nrlmsise00"] = "nrlmsise00"
    f107: Number | None = None
    f107a: Number | None = None
    ap: GeomagneticIndex | None = None
    """One number, or seven: the day's, then the means of the hours before, as NRLMSISE-00 has them."""
    table: FilePath | None = None
    """A CSV beside the scenario."""
    three_hourly: bool = True

    def make(self, beside: Path) -> _core.Atmosphere:
        """The engine's."""
        table = None if self.table is None else beside / self.table
        return _core.Nrlmsise00(
            f107=self.f107, f107a=self.f107a, ap=self.ap, table=table, three_hourly=self.three_hourly
        )


AnyAir = ConstantAir | ExponentialAir | HarrisPriesterAir | Nrlmsise00Air
Air = Annotated[AnyAir, Field(discriminator="kind"), of_kind(AnyAir)]
