"""What GMAT's two days with Sun and Moon must see; the case is in ``onorbit_rs.validation.gravity``."""

from __future__ import annotations

import pytest

from onorbit_rs.validation.gravity import sun_and_moon


@pytest.mark.parametrize("left", ["sun", "moon"])
def test_leaving_one_out_is_noticed(left: str) -> None:
    others = tuple(body for body in ("sun", "moon") if body != left)
    assert sun_and_moon(others)[0] > 2.0
