"""Refactoring keeps the bits: every trace column of every bundled scenario is the one that was recorded."""

from __future__ import annotations

import json

import pytest
import recorded_bits

ADDED_LATER = {"reference_position_eci", "reference_velocity_eci"}
"""Columns that did not exist when the bits were recorded."""


@pytest.fixture(scope="module")
def found() -> dict[str, dict[str, str]]:
    return recorded_bits.in_baseline()


def test_every_column_of_every_bundled_scenario_has_its_recorded_bits(
    found: dict[str, dict[str, str]],
) -> None:
    recorded = json.loads(recorded_bits.RECORDED.read_text())
    if found["libm"] != recorded["libm"]:
        pytest.skip(
            "sine and cosine of this machine's C library have other last bits than those of the recording"
        )
    changed = [
        f"{name}.{column}"
        for name in recorded.keys() | found.keys()
        for column in (recorded.get(name, {}).keys() | found.get(name, {}).keys()) - ADDED_LATER
        if recorded.get(name, {}).get(column) != found.get(name, {}).get(column)
    ]
    assert changed == []


def test_another_process_finds_the_same_and_a_changed_number_does_not(
    found: dict[str, dict[str, str]],
) -> None:
    assert recorded_bits.in_baseline() == found
    assert recorded_bits._digest([1.0, 2.0]) != recorded_bits._digest([1.0, 2.0 + 4e-16])
    assert recorded_bits._digest([[1.0, 2.0]]) != recorded_bits._digest([1.0, 2.0])
