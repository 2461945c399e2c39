"""Units as labels tell them: those of joints by their kind."""

from __future__ import annotations

from collections.abc import Iterable
from typing import NamedTuple

OR = " or "
"""Between two units of one label, which take no common prefix."""


class JointUnits(NamedTuple):
    """Of joints: positions and their errors, rates, efforts."""

    position: str
    rate: str
    effort: str


_OF_KINDS = (JointUnits("rad", "rad/s", "N m"), JointUnits("m", "m/s", "N"))


def joint_units(kinds: Iterable[str]) -> JointUnits:
    """Of joints of these kinds: rad, m where they slide, ``rad or m`` where both or none is known."""
    slides = {kind == "prismatic" for kind in kinds} or {False, True}
    found = [_OF_KINDS[index] for index in sorted(slides)]
    return JointUnits(*(OR.join(parts) for parts in zip(*found, strict=True)))
