"""Negative controls of NASA's check-cases, which are in ``onorbit_rs.tools.validation.nasa``."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

import onorbit_rs as oo
from onorbit_rs.tools.validation import nasa


def test_the_table_has_the_rows_of_all_runs() -> None:
    assert {run: len(nasa.rows(run)) for run in nasa.RUNS} == {
        "2": 6, "3A": 1, "6A": 1, "6C": 1, "8A": 1, "9A": 1, "9C": 1, "10A": 5, "10C": 4,
    }  # fmt: skip
    for run in nasa.RUNS:
        assert nasa.rows(run)[-1].time == nasa.HOURS_8
        for row in nasa.rows(run):
            np.testing.assert_allclose(row.attitude @ row.attitude.T, np.eye(3), atol=1e-10)


def test_the_initial_pitch_agrees_with_the_table() -> None:
    np.testing.assert_allclose(nasa.pitched(nasa.TYPICAL, -11.6), nasa.rows("2")[0].attitude, atol=1e-15)


# Negative controls


def test_control_wrong_signs_of_the_products_of_inertia_are_detected(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    signs = [[1.02e8, 6.96e6, 5.48e6], [6.96e6, 0.91e8, -5.9e5], [5.48e6, -5.9e5, 1.64e8]]
    monkeypatch.setattr(nasa, "ISS_INERTIA", signs)
    position, _, rate, _ = nasa.errors("2")
    assert rate > 1e-6 and position < 1e-4


def test_control_a_missing_gravity_gradient_is_detected() -> None:
    position, _, rate, _ = nasa.errors("10A", replace(nasa.RUNS["10A"], environment=list))
    assert rate > 1e-6 and position < 1e-4


def test_control_another_gravitational_parameter_is_detected(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(nasa, "MU", oo.MU_EARTH)
    assert 0.1 < nasa.errors("2")[0] < 1.0  # 0.32 m


def test_control_a_field_without_tesseral_terms_is_detected() -> None:
    zonal = replace(nasa.RUNS["3A"], environment=lambda: [oo.GravityField.zonal(4)])
    assert nasa.errors("3A", zonal)[0] > 100.0


@pytest.mark.parametrize(
    ("earth", "least", "most"),
    [
        (lambda: oo.Earth(rotation="about_z", rate=0.0), 60.0, 100.0),  # NASA's number: 80 m
        (lambda: oo.Earth("2007-11-20T00:00:00 UTC", ut1_minus_utc=-0.469), 0.05, 0.12),  # 8 cm
    ],
    ids=["at rest", "about the pole of date"],
)
def test_control_another_rotation_of_the_air_is_detected_by_6a(
    earth: object, least: float, most: float
) -> None:
    assert least < nasa.errors("6A", replace(nasa.RUNS["6A"], earth=earth))[0] < most


def test_control_missing_drag_is_detected_by_6a() -> None:
    assert nasa.errors("6A", replace(nasa.RUNS["6A"], environment=list))[0] > 900.0
