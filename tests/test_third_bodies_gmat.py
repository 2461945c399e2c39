"""Negative control for GMAT's case with Sun and Moon in ``onorbit_rs.tools.validation.gravity``."""

from __future__ import annotations

import pytest

from onorbit_rs.tools.validation.gravity import sun_and_moon


@pytest.mark.parametrize("left", ["sun", "moon"])
def test_an_omitted_body_is_detected(left: str) -> None:
    others = tuple(body for body in ("sun", "moon") if body != left)
    assert sun_and_moon(others)[0] > 2.0
