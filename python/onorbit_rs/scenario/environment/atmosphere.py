"""Models of the atmosphere."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated, Literal

from pydantic import BeforeValidator, Field

from onorbit_rs import _core
from onorbit_rs.common.counting import count
from onorbit_rs.scenario.errors import invalid
from onorbit_rs.scenario.fields import Angle, Density, FilePath, Length, NotNegative, Number, Positive
from onorbit_rs.scenario.part import Part, of_kind
from onorbit_rs.scenario.units import NUMBER, parse_quantity


class ConstantAir(Part):
    """Atmosphere of constant density."""

    kind: Literal["constant"] = "constant"
    density: Annotated[Density, NotNegative]

    def build(self, folder: Path) -> _core.Atmosphere:
        """Return the engine's atmosphere object."""
        return _core.ConstantAtmosphere(self.density)


class ExponentialAir(Part):
    """Exponential atmosphere: one layer, or by default Vallado's table of layers."""

    kind: Literal["exponential"] = "exponential"
    density: Annotated[Density, Positive] | None = None
    altitude: Length | None = None
    scale_height: Annotated[Length, Positive] | None = None

    def build(self, folder: Path) -> _core.Atmosphere:
        """Return the engine's atmosphere object."""
        return _core.ExponentialAtmosphere(
            density=self.density, altitude=self.altitude, scale_height=self.scale_height
        )


class HarrisPriesterAir(Part):
    """Harris-Priester model with a diurnal bulge. It requires an epoch."""

    kind: Literal["harris_priester"] = "harris_priester"
    exponent: Number = 4.0
    lag: Angle | None = None

    def build(self, folder: Path) -> _core.Atmosphere:
        """Return the engine's atmosphere object."""
        lag = {} if self.lag is None else {"lag": self.lag}
        return _core.HarrisPriester(exponent=self.exponent, **lag)


def _ap(value: object) -> float | list[float]:
    if not isinstance(value, list):
        return parse_quantity(value, NUMBER)
    if len(value) != 7:
        entries = count(len(value), "entry", "entries")
        raise invalid(
            f"ap is a list with {entries}; give the daily value as one number, or NRLMSISE-00's list of "
            "seven values"
        )
    return [parse_quantity(entry, NUMBER) for entry in value]


GeomagneticIndex = Annotated[float | list[float], BeforeValidator(_ap)]


class Nrlmsise00Air(Part):
    """NRLMSISE-00 model with constant indices or with a table of indices. It requires an epoch."""

    kind: Literal["nrlmsise00"] = "nrlmsise00"
    f107: Number | None = None
    f107a: Number | None = None
    ap: GeomagneticIndex | None = None
    """Geomagnetic index ap: the daily value, or the seven values of NRLMSISE-00, which are the daily value
    and values of the preceding hours."""
    table: FilePath | None = None
    """CSV file with the indices; a relative path starts at the folder of the scenario."""
    three_hourly: bool = True

    def build(self, folder: Path) -> _core.Atmosphere:
        """Return the engine's atmosphere object."""
        table = None if self.table is None else folder / self.table
        return _core.Nrlmsise00(
            f107=self.f107, f107a=self.f107a, ap=self.ap, table=table, three_hourly=self.three_hourly
        )


AnyAir = ConstantAir | ExponentialAir | HarrisPriesterAir | Nrlmsise00Air
Air = Annotated[AnyAir, Field(discriminator="kind"), of_kind(AnyAir)]
