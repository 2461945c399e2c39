"""Key ``gravity_mode``: whether a robot moves along with a reference orbit that is not in free fall."""

from __future__ import annotations

from typing import Annotated, Literal

from pydantic import BeforeValidator

GravityMode = Annotated[
    Literal["true", "carried"],
    BeforeValidator(lambda value: "true" if value is True else value),  # YAML reads true as a boolean
]
"""Gravity mode. With ``true``, the robot falls freely and therefore drifts from a reference orbit that is not
in free fall; with ``carried``, the robot moves with the reference orbit."""
