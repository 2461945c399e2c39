"""Key ``gravity_mode``: whether a robot moves along with a reference orbit that is not in free fall."""

from __future__ import annotations

from typing import Annotated, Literal

from pydantic import BeforeValidator

GravityMode = Annotated[
    Literal["true", "carried"],
    BeforeValidator(lambda value: "true" if value is True else value),  # YAML reads true as a boolean
]
"""``true``: the robot falls freely, so it drifts from a reference that does not; ``carried``: the robot moves
with the reference."""
