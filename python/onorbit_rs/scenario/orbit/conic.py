"""Orbits defined by a conic: two-body motion, and numerical integration from the conic's initial state."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated, Any, ClassVar, Literal, Self

import numpy as np
from pydantic import model_validator

from onorbit_rs import _core
from onorbit_rs.common.numbers import shortest
from onorbit_rs.scenario.errors import invalid
from onorbit_rs.scenario.fields import (
    Angle,
    GravitationalParameter,
    Length,
    Length3,
    NotNegative,
    Number,
    Positive,
    Speed3,
    Time,
)
from onorbit_rs.scenario.part import Part

SIZES = ("semi_major_axis", "semi_latus_rectum")
SECULAR = ("secular_j2", "j2", "radius")
PHASES = ("mean_anomaly", "true_anomaly", "periapsis_time")


class ConicOrbit(Part):
    """Conic that is defined by orbital elements or by a state.

    Elements: a size (``semi_major_axis``, negative for a hyperbola, or ``semi_latus_rectum``, required for a
    parabola), and ``eccentricity``, three angles and one phase, which are zero by default. State:
    ``position`` and ``velocity`` at the start, in inertial axes.
    """

    synonyms: ClassVar = {
        "a": "semi_major_axis", "sma": "semi_major_axis",
        "p": "semi_latus_rectum",
        "e": "eccentricity", "ecc": "eccentricity", "i": "inclination", "inc": "inclination",
        "node": "raan", "right_ascension": "raan", "argp": "argument_of_periapsis",
        "aop": "argument_of_periapsis", "argument_of_perigee": "argument_of_periapsis",
        "m": "mean_anomaly", "ma": "mean_anomaly", "nu": "true_anomaly", "ta": "true_anomaly",
        "r": "position", "v": "velocity",
    }  # fmt: skip

    semi_major_axis: Length | None = None
    semi_latus_rectum: Annotated[Length, Positive] | None = None
    eccentricity: Annotated[Number, NotNegative] | None = None
    inclination: Angle | None = None
    raan: Angle | None = None
    argument_of_periapsis: Angle | None = None
    mean_anomaly: Angle | None = None
    true_anomaly: Angle | None = None
    periapsis_time: Time | None = None
    position: Length3 | None = None
    velocity: Speed3 | None = None
    mu: Annotated[GravitationalParameter, Positive] = _core.MU_EARTH
    """Gravitational parameter, m³/s²; default: the Earth's."""

    @classmethod
    def _hint(cls, key: str, free: list[str]) -> str:
        if key == "altitude":
            return "; give 'semi_major_axis', the mean radius of the planet plus the mean altitude"
        return super()._hint(key, free)

    def build(self, _folder: Path) -> _core.Orbit:
        """Return the conic as an orbit object of the engine."""
        given = self._given()
        if self.position is None:
            return _core.Kepler(**given)
        position, velocity = given.pop("position"), given.pop("velocity")
        return _core.Kepler.from_state(np.array(position), np.array(velocity), **given)

    def _given(self) -> dict[str, Any]:
        return self.model_dump(exclude_none=True, exclude={"kind"})

    @model_validator(mode="after")
    def _is_one_orbit(self) -> Self:
        given = [name for name in self._given() if name not in ("mu", *SECULAR)]
        if self.position is not None or self.velocity is not None:
            others = [name for name in given if name not in ("position", "velocity")]
            if self.position is None or self.velocity is None:
                missing = "position" if self.position is None else "velocity"
                raise invalid(f"{missing!r} is missing; an initial state requires 'position' and 'velocity'")
            if others:
                raise invalid(
                    f"'position' and 'velocity' define the orbit; omit {' and '.join(map(repr, others))}"
                )
            return self
        sizes = [name for name in SIZES if name in given]
        if len(sizes) != 1:
            raise invalid(f"give exactly one of {_listed(SIZES)}; given: {', '.join(sizes) or 'none'}")
        phases = [name for name in PHASES if name in given]
        if len(phases) > 1:
            raise invalid(f"give at most one of {_listed(PHASES)}; given: {', '.join(phases)}")
        self._check_signs()
        self._set_defaults(has_phase=bool(phases))
        return self

    def _set_defaults(self, *, has_phase: bool) -> None:
        """Set the eccentricity, the angles and, if no phase is given, the true anomaly to zero by default."""
        for name in ("eccentricity", "inclination", "raan", "argument_of_periapsis"):
            if getattr(self, name) is None:
                setattr(self, name, 0.0)
        if not has_phase:
            self.true_anomaly = 0.0

    def _check_signs(self) -> None:
        a, e = self.semi_major_axis, self.eccentricity or 0.0
        if a is None:
            return
        if e == 1.0:
            raise invalid(
                "a parabola (eccentricity 1) has no semi-major axis; replace 'semi_major_axis' by "
                "'semi_latus_rectum'"
            )
        if (a > 0.0) != (e < 1.0):
            right = (
                "positive below eccentricity 1" if e < 1.0 else "negative above eccentricity 1 (a hyperbola)"
            )
            raise invalid(
                f"semi_major_axis {shortest(a)} m contradicts eccentricity {shortest(e)}; it must be {right}"
            )


class KeplerOrbit(ConicOrbit):
    """Two-body motion; with ``secular_j2``, node, periapsis and mean anomaly drift due to oblateness."""

    kind: Literal["kepler"] = "kepler"
    secular_j2: bool | None = None
    j2: Number | None = None
    radius: Annotated[Length, Positive] | None = None
    """Reference radius of ``j2``, m; the defaults of ``j2`` and ``radius`` are the Earth's values."""

    @model_validator(mode="after")
    def _has_secular_j2(self) -> KeplerOrbit:
        given = [name for name in SECULAR[1:] if getattr(self, name) is not None]
        if given and not self.secular_j2:
            verb, what = ("has", "it") if len(given) == 1 else ("have", "them")
            raise invalid(
                f"{' and '.join(map(repr, given))} {verb} no effect without 'secular_j2: true'; omit {what}, "
                "or add 'secular_j2: true'"
            )
        return self


class NumericalOrbit(ConicOrbit):
    """Free fall in the gravity of the scenario's environment, integrated from the state of the conic."""

    kind: Literal["numerical"] = "numerical"

    @staticmethod
    def integrate(
        conic: _core.Orbit, effects: list[_core.Effect], earth: _core.Earth | None
    ) -> _core.Numerical:
        """Return the orbit that starts at the state of a conic, integrated in the gravity of ``effects``."""
        gravity = [effect for effect in effects if isinstance(effect, (_core.GravityField, _core.ThirdBody))]
        return _core.Numerical.from_orbit(conic, environment=gravity, earth=earth)


def _listed(names: tuple[str, ...]) -> str:
    return ", ".join(repr(name) for name in names)
