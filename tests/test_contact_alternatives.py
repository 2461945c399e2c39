"""The wrong methods that serve as controls err as theory predicts."""

from __future__ import annotations

import math

import contact_alternatives
import pytest

from onorbit_rs.tools.validation import contact_grasp


def test_equal_steps_have_order_four_for_flat_pads_and_two_and_a_half_for_spheres() -> None:
    assert contact_alternatives.order(1.0, 1e5) > 3.5
    assert contact_alternatives.order(1.5, 1e7) == pytest.approx(2.5, abs=0.1)


def test_smooth_friction_creeps_at_the_speed_of_its_law_and_lugre_only_under_oscillating_loads() -> None:
    load = contact_grasp.LOAD
    creep = contact_alternatives.SLOW * math.atanh(load / (2.0 * contact_grasp.MU * 12.0))
    assert contact_alternatives.smooth(12.0, load, 0.0, 0.1) == pytest.approx(creep, rel=1e-6)
    assert contact_alternatives.lugre(12.0, load, 0.0, 1.0) < 1e-12
    assert contact_alternatives.lugre(12.0, load, contact_grasp.SWING, 1.0) > 1e-7
    assert contact_alternatives.lugre(12.0, load, contact_grasp.LARGE_SWING, 1.0) > 1e-5
