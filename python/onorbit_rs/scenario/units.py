"""Quantities: ``"6778 km"`` is 6778000.0 m; a number without a unit is in SI.

A unit is a product of names with integer powers: ``km^3/s^2``, ``rev/min``, ``kg m^2``, ``N·m``. Angle is a
dimension here, although it is a pure number in physics, so that degrees instead of metres are an error.
"""

from __future__ import annotations

import math
import re
from dataclasses import dataclass

from onorbit_rs.common.suggestions import nearest
from onorbit_rs.exceptions import QuantityError
from onorbit_rs.scenario.errors import shortened

Powers = tuple[int, int, int, int]
"""Powers of mass (kg), length (m), time (s) and angle (rad)."""


@dataclass(frozen=True)
class Dimension:
    """Dimension of a quantity, and its SI unit."""

    name: str
    powers: Powers
    si: str
    also: tuple[str, ...] = ()
    """Additional compound units that messages suggest."""


NUMBER = Dimension("a plain number", (0, 0, 0, 0), "")
MASS = Dimension("a mass", (1, 0, 0, 0), "kg")
LENGTH = Dimension("a length", (0, 1, 0, 0), "m")
AREA = Dimension("an area", (0, 2, 0, 0), "m^2")
DENSITY = Dimension("a density", (1, -3, 0, 0), "kg/m^3")
TIME = Dimension("a time", (0, 0, 1, 0), "s")
ANGLE = Dimension("an angle", (0, 0, 0, 1), "rad")
SPEED = Dimension("a speed", (0, 1, -1, 0), "m/s", ("km/s", "mm/s"))
ACCELERATION = Dimension("an acceleration", (0, 1, -2, 0), "m/s^2")
ANGULAR_RATE = Dimension("an angular rate", (0, 0, -1, 1), "rad/s", ("deg/s",))
ANGULAR_ACCELERATION = Dimension("an angular acceleration", (0, 0, -2, 1), "rad/s^2", ("deg/s^2",))
RATE = Dimension("a rate", (0, 0, -1, 0), "1/s")
STIFFNESS = Dimension("a stiffness per mass", (0, 0, -2, 0), "1/s^2")
FLUX = Dimension("a flux of energy", (1, 0, -3, 0), "W/m^2")
FORCE = Dimension("a force", (1, 1, -2, 0), "N")
TORQUE = Dimension("a torque", (1, 2, -2, 0), "N m")
IMPULSE = Dimension("an impulse", (1, 1, -1, 0), "N s")
ANGULAR_IMPULSE = Dimension("an angular impulse", (1, 2, -1, 0), "N m s")
INERTIA = Dimension("a moment of inertia", (1, 2, 0, 0), "kg m^2")
LINEAR_STIFFNESS = Dimension("a stiffness", (1, 0, -2, 0), "N/m")
ANGULAR_STIFFNESS = Dimension("an angular stiffness", (1, 2, -2, -1), "N m/rad")
LINEAR_CUBIC_STIFFNESS = Dimension("a cubic stiffness", (1, -2, -2, 0), "N/m^3")
ANGULAR_CUBIC_STIFFNESS = Dimension("an angular cubic stiffness", (1, 2, -2, -3), "N m/rad^3")
DISSIPATION = Dimension("a dissipation", (0, -1, 1, 0), "s/m")
LINEAR_DAMPING = Dimension("a damping coefficient", (1, 0, -1, 0), "N s/m")
ANGULAR_DAMPING = Dimension("an angular damping coefficient", (1, 2, -1, -1), "N m s/rad")
GRAVITY = Dimension("a gravitational parameter", (0, 3, -2, 0), "m^3/s^2", ("km^3/s^2",))

_DAY = 86_400.0
_UNITS: dict[str, tuple[float, Powers]] = {
    "kg": (1.0, MASS.powers),
    "g": (1e-3, MASS.powers),
    "t": (1e3, MASS.powers),
    "m": (1.0, LENGTH.powers),
    "km": (1e3, LENGTH.powers),
    "cm": (1e-2, LENGTH.powers),
    "mm": (1e-3, LENGTH.powers),
    "au": (149_597_870_700.0, LENGTH.powers),
    "s": (1.0, TIME.powers),
    "ms": (1e-3, TIME.powers),
    "us": (1e-6, TIME.powers),
    "min": (60.0, TIME.powers),
    "h": (3600.0, TIME.powers),
    "day": (_DAY, TIME.powers),
    "days": (_DAY, TIME.powers),
    "rad": (1.0, ANGLE.powers),
    "mrad": (1e-3, ANGLE.powers),
    "deg": (math.pi / 180.0, ANGLE.powers),
    "arcmin": (math.pi / 10_800.0, ANGLE.powers),
    "arcsec": (math.pi / 648_000.0, ANGLE.powers),
    "rev": (2.0 * math.pi, ANGLE.powers),
    "rpm": (2.0 * math.pi / 60.0, ANGULAR_RATE.powers),
    "N": (1.0, FORCE.powers),
    "mN": (1e-3, FORCE.powers),
    "kN": (1e3, FORCE.powers),
    "W": (1.0, (1, 2, -3, 0)),
    "kW": (1e3, (1, 2, -3, 0)),
    "Nm": (1.0, TORQUE.powers),
    "mNm": (1e-3, TORQUE.powers),
    "Hz": (1.0, RATE.powers),
    "1": (1.0, NUMBER.powers),
}

_QUANTITY = re.compile(r"\s*([+-]?(?:\d[\d_]*\.?\d*|\.\d+)(?:[eE][+-]?\d+)?)\s*(.*?)\s*", re.DOTALL)
_FACTOR = re.compile(r"\s*([*·/]?)\s*([A-Za-z]+|1)\s*(?:(?:\^|\*\*)\s*([+-]?\d+))?")


def parse_quantity(value: object, *allowed: Dimension) -> float:
    """Return the value of a quantity in SI.

    Parameters
    ----------
    value : float or str
        Number in SI or text with a unit, such as ``0.5``, ``"6778 km"``, ``"2 rev/min"`` or ``"1e-3"``.
    *allowed : Dimension
        Dimensions that are accepted.

    Returns
    -------
    float

    Raises
    ------
    QuantityError
        If the value is not a finite number, or its unit is unknown or has another dimension; the message
        lists accepted units.
    """
    if isinstance(value, bool) or not isinstance(value, (int, float, str)):
        raise _refused(value, f"is not {_any_of(allowed)}", allowed)
    if isinstance(value, str):
        number = _from_text(value, allowed)
    else:
        try:
            number = float(value)
        except OverflowError:
            number = math.inf
    if not math.isfinite(number):
        raise _refused(value, "is not a finite number", allowed)
    return number


def split_quantity(value: object) -> tuple[float, str]:
    """Return the value of a quantity of any dimension in SI, and its unit as written; empty without a unit.

    Raises
    ------
    QuantityError
        If the value is neither a finite number nor text with a number and a known unit.
    """
    match = _QUANTITY.fullmatch(value) if isinstance(value, str) else None
    if match is None or not match[2]:
        if isinstance(value, str) and match is None:
            raise QuantityError(
                f"{shortened(value)} is not a number, with or without a unit; write a value such as 0.5 "
                "or '0.5 deg'",
                text=value, expected="a number",
            )  # fmt: skip
        return parse_quantity(value, NUMBER), ""
    unit = match[2]
    factor, _ = _parse_unit(unit, str(value), ())
    return float(match[1].replace("_", "")) * factor, unit


def _from_text(text: str, allowed: tuple[Dimension, ...]) -> float:
    match = _QUANTITY.fullmatch(text)
    if match is None:
        raise _refused(text, f"is not {_any_of(allowed)}", allowed)
    number = float(match[1].replace("_", ""))
    if not match[2]:
        return number
    factor, powers = _parse_unit(match[2], text, allowed)
    if all(powers != dimension.powers for dimension in allowed):
        raise _refused(text, f"is not {_any_of(allowed)}", allowed)
    return number * factor


def _parse_unit(unit: str, text: str, allowed: tuple[Dimension, ...]) -> tuple[float, Powers]:
    """Return the factor that converts a compound unit such as ``km^3/s^2`` to SI, and its dimension."""
    factor, powers, at = 1.0, NUMBER.powers, 0
    while at < len(unit):
        match = _FACTOR.match(unit, at)
        if match is None:
            raise _refused(text, f"has an invalid unit {unit!r}", allowed)
        operator, name, power = match[1], match[2], int(match[3] or 1)
        if name not in _UNITS:
            fitting = [
                known for known, (_, own) in _UNITS.items() if any(own == one.powers for one in allowed)
            ]
            near = nearest(name, fitting or _UNITS)
            hint = f" (did you mean {near!r}?)" if near else ""
            raise _refused(text, f"has the unknown unit {name!r}{hint}", allowed)
        if abs(power) > 9:
            raise _refused(text, f"has a power above 9 or below -9 in its unit {unit!r}", allowed)
        signed = -power if operator == "/" else power
        scale, own = _UNITS[name]
        factor *= scale**signed
        powers = (
            powers[0] + signed * own[0],
            powers[1] + signed * own[1],
            powers[2] + signed * own[2],
            powers[3] + signed * own[3],
        )
        at = match.end()
    return factor, powers


def _any_of(allowed: tuple[Dimension, ...]) -> str:
    return " or ".join(dimension.name for dimension in allowed)


def _example_units(dimension: Dimension) -> str:
    """Return the units of a dimension for messages, such as ``m, km``; the SI unit is first."""
    same = [name for name, (_, powers) in _UNITS.items() if powers == dimension.powers and name != "1"]
    return ", ".join(dict.fromkeys([dimension.si, *dimension.also, *same])) if dimension.si else ""


def _refused(value: object, why: str, allowed: tuple[Dimension, ...]) -> QuantityError:
    units = "; ".join(filter(None, (_example_units(dimension) for dimension in allowed)))
    si = " or ".join(dict.fromkeys(dimension.si for dimension in allowed if dimension.si))
    if not allowed:
        fix = "give a number, with or without a known unit such as m, kg, s or deg"
    elif not units:
        fix = "give a number without a unit"
    elif units == si:
        fix = f"give a number, with or without the unit {si}"
    else:
        fix = f"give a number in {si}, or a number with a unit ({units})"
    return QuantityError(f"{shortened(value)} {why}; {fix}", text=value, expected=_any_of(allowed))
