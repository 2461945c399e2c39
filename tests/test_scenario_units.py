"""Quantities with units: conversion factors, and errors for everything else."""

from __future__ import annotations

import math

import pytest
from hypothesis import given
from hypothesis import strategies as st

from onorbit_rs.exceptions import OnOrbitError, QuantityError
from onorbit_rs.scenario import units
from onorbit_rs.scenario.units import Dimension, parse_quantity


@pytest.mark.parametrize(
    ("text", "dimension", "si"),
    [
        ("6778 km", units.LENGTH, 6.778e6),
        ("51.6 deg", units.ANGLE, math.radians(51.6)),
        ("2 rev/min", units.ANGULAR_RATE, 4.0 * math.pi / 60.0),
        ("2 rpm", units.ANGULAR_RATE, 4.0 * math.pi / 60.0),
        ("1 ms", units.TIME, 1e-3),
        ("1e-3", units.TIME, 1e-3),
        ("1.5h", units.TIME, 5400.0),
        ("398600.4418 km^3/s^2", units.GRAVITY, 3.986004418e14),
        ("3 kg m^2", units.INERTIA, 3.0),
        ("3 kg*m**2", units.INERTIA, 3.0),
        ("5 mN", units.FORCE, 5e-3),
        ("5 N m", units.TORQUE, 5.0),
        ("5 N·cm", units.TORQUE, 0.05),
        ("5 Nm", units.TORQUE, 5.0),
        ("100 1/s^2", units.STIFFNESS, 100.0),
        ("7.6 km/s", units.SPEED, 7600.0),
        (" -3600 arcsec ", units.ANGLE, -math.pi / 180.0),
    ],
)
def test_units_convert_to_si(text: str, dimension: Dimension, si: float) -> None:
    assert parse_quantity(text, dimension) == pytest.approx(si, rel=1e-15)  # at most two roundings


@given(st.floats(allow_nan=False, allow_infinity=False))
def test_bare_number_is_si_unchanged(value: float) -> None:
    assert parse_quantity(value, units.LENGTH) == value
    assert parse_quantity(repr(value), units.LENGTH) == value


@pytest.mark.parametrize(
    ("value", "dimension", "says"),
    [
        ("51.6 def", units.ANGLE, "did you mean 'deg'"),
        ("51.6 deg", units.LENGTH, "is not a length"),
        ("6778 km", units.ANGLE, "is not an angle"),
        ("5 N", units.TORQUE, "is not a torque"),
        ("1 s", units.NUMBER, "is not a plain number"),
        ("fast", units.SPEED, "is not a speed"),
        ("", units.SPEED, "is not a speed"),
        ("1 m//s", units.SPEED, "invalid unit"),
        ("1 m^99", units.LENGTH, "a power above 9"),
        (math.nan, units.LENGTH, "not a finite number"),
        (math.inf, units.LENGTH, "not a finite number"),
        ("1e999 m", units.LENGTH, "not a finite number"),
        (10**400, units.LENGTH, "not a finite number"),
        (True, units.NUMBER, "is not a plain number"),
        (None, units.LENGTH, "is not a length"),
        ([1.0], units.LENGTH, "is not a length"),
    ],
)
def test_invalid_quantities_are_rejected(value: object, dimension: Dimension, says: str) -> None:
    with pytest.raises(QuantityError, match=says) as caught:
        parse_quantity(value, dimension)
    assert isinstance(caught.value, OnOrbitError)
    assert isinstance(caught.value, ValueError)
    assert caught.value.text is value


@given(st.text(max_size=30))
def test_no_text_raises_another_error(text: str) -> None:
    try:
        assert math.isfinite(parse_quantity(text, units.LENGTH, units.ANGLE))
    except QuantityError as error:
        assert "\n" not in str(error)
