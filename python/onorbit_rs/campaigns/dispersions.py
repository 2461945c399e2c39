"""Dispersions, which change entries in the data of a scenario according to random numbers."""

from __future__ import annotations

import math
from abc import ABC, abstractmethod
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any, Literal

import numpy as np

from onorbit_rs.campaigns.distributions import Distribution
from onorbit_rs.common.rotations import product
from onorbit_rs.scenario.yaml_lines import Location

How = Literal["set", "add", "scale"]


@dataclass(frozen=True)
class Dispersion(ABC):
    """Base class of the dispersions, each of which changes one entry of the scenario.

    ``at`` is the location of the entry in the data of the scenario, and ``names`` are the names of its
    dispersed values in the results.
    """

    at: Location
    names: tuple[str, ...]
    distribution: Distribution

    @property
    def draws(self) -> int:
        """Number of independent random numbers per case."""
        return 1

    @property
    def draw_names(self) -> tuple[str, ...]:
        """Names of the random numbers; each number depends on its name, the seed and the case."""
        return self.names

    @abstractmethod
    def apply(self, data: dict[str, Any], us: Sequence[float]) -> tuple[Any, ...]:
        """Change the data of a case; return the dispersed values, in the order of ``names``.

        ``us`` are the random numbers, in (0, 1).
        """


def changed(how: How, nominal: float, drawn: float) -> float:
    """Return the value of an entry whose nominal value is replaced, increased or multiplied by ``drawn``."""
    return drawn if how == "set" else nominal + drawn if how == "add" else nominal * drawn


def put(data: Any, at: Location, value: Any) -> None:
    """Set one entry of plain data; create the mappings that contain it if they are missing."""
    for step in at[:-1]:
        data = data[step] if isinstance(step, int) else data.setdefault(step, {})
    data[at[-1]] = value


@dataclass(frozen=True)
class NumberDispersion(Dispersion):
    """Dispersion of a number, or of one component of a vector."""

    how: How
    nominal: float

    def apply(self, data: dict[str, Any], us: Sequence[float]) -> tuple[Any, ...]:
        """Change the number; the dispersed value is the new one."""
        value = changed(self.how, self.nominal, self.distribution.value(us[0]))
        put(data, self.at, value)
        return (value,)


@dataclass(frozen=True)
class ChoiceDispersion(Dispersion):
    """Dispersion that replaces an entry by one of several values of any kind."""

    def apply(self, data: dict[str, Any], us: Sequence[float]) -> tuple[Any, ...]:
        """Replace the entry; the dispersed value is the new one."""
        value = self.distribution.pick(us[0])
        put(data, self.at, value)
        return (value,)


@dataclass(frozen=True)
class FactorDispersion(Dispersion):
    """Dispersion that multiplies all components of a vector or an inertia by one factor.

    A positive factor preserves the direction of a vector, and the principal axes of an inertia and the
    triangle inequality of its principal moments. The mass and the centre of mass of a link whose inertia is
    scaled do not change.
    """

    nominal: Any

    def apply(self, data: dict[str, Any], us: Sequence[float]) -> tuple[Any, ...]:
        """Scale the entry; the dispersed value is the factor."""
        factor = self.distribution.value(us[0])
        put(data, self.at, (np.array(self.nominal, dtype=np.float64) * factor).tolist())
        return (factor,)


@dataclass(frozen=True)
class DirectionDispersion(Dispersion):
    """Dispersion by a vector with a drawn magnitude and a direction uniformly distributed on the sphere."""

    how: How
    nominal: tuple[float, ...]

    @property
    def draws(self) -> int:
        """Three random numbers per case: for the magnitude, and the height and longitude of the direction."""
        return 3

    @property
    def draw_names(self) -> tuple[str, ...]:
        """Names of the random numbers for the magnitude, the height and the longitude."""
        base = self.names[0].removesuffix("[0]")
        return (f"{base}/magnitude", f"{base}/height", f"{base}/longitude")

    def apply(self, data: dict[str, Any], us: Sequence[float]) -> tuple[Any, ...]:
        """Set the vector, or add to it; the dispersed values are the new components.

        The height `z = 2 u − 1` of a point that is uniformly distributed on the sphere is uniformly
        distributed (Archimedes).
        """
        size = self.distribution.value(us[0])
        z, longitude = 2.0 * us[1] - 1.0, 2.0 * math.pi * us[2]
        flat = math.sqrt(max(0.0, 1.0 - z * z))
        drawn = (size * flat * math.cos(longitude), size * flat * math.sin(longitude), size * z)
        values = tuple(changed(self.how, old, new) for old, new in zip(self.nominal, drawn, strict=True))
        put(data, self.at, list(values))
        return values


@dataclass(frozen=True)
class RotationDispersion(Dispersion):
    """Dispersion that turns an attitude by a rotation vector in body axes."""

    nominal: tuple[float, ...]
    """Unit quaternion xyzw."""
    is_direction: bool

    @property
    def draws(self) -> int:
        """Three random numbers per case: components of a rotation vector, or its magnitude and direction."""
        return 3

    def apply(self, data: dict[str, Any], us: Sequence[float]) -> tuple[Any, ...]:
        """Turn the attitude, `q = q₀ exp(δ/2)`; the dispersed values are the components of `δ`, rad."""
        if self.is_direction:
            inner: dict[str, Any] = {}
            zero = (0.0, 0.0, 0.0)
            delta = DirectionDispersion(("x",), ("x",) * 3, self.distribution, "set", zero).apply(inner, us)
        else:
            delta = tuple(self.distribution.value(u) for u in us)
        angle = math.sqrt(sum(part * part for part in delta))
        factor = 0.5 if angle == 0.0 else math.sin(0.5 * angle) / angle
        turn = np.array([*(factor * part for part in delta), math.cos(0.5 * angle)])
        quat = product(np.array(self.nominal), turn)
        quat /= np.linalg.norm(quat)
        put(data, self.at, {"quaternion_xyzw": quat.tolist()})
        return tuple(delta)
