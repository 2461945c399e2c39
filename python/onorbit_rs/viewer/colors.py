"""Colours of the viewer: arrows have one hue per effect, full for forces and pale for torques.

Any two colours in a legend of up to six effects differ by at least 25 in CIE 1976 L*a*b*; a difference of 2.3
is just noticeable.
"""

from __future__ import annotations

from collections.abc import Iterable
from typing import NamedTuple

Color = tuple[int, int, int]


class Hue(NamedTuple):
    """Two colours of one hue: red, green, blue, 0 to 255."""

    full: Color
    """Colour of forces and of linear momentum."""
    pale: Color
    """Colour of torques and of angular momentum."""


BACKGROUND: Color = (28, 31, 38)
ROBOT: Color = (255, 220, 120)
"""Colour of the spacecraft in the view of the orbit."""
TARGET: Color = (205, 170, 90)

MOMENTUM = Hue((230, 135, 40), (253, 206, 165))

LOOPS = Hue((0, 165, 255), (140, 190, 255))

LINES: tuple[Color, ...] = (
    (85, 155, 250), (240, 130, 50), (70, 200, 120), (220, 140, 190), (240, 190, 50), (130, 210, 245),
    (180, 180, 180), (245, 235, 100),
)  # fmt: skip
"""Colours of the lines of a plot; spacecraft have the same colours in the same order."""

_OF_EFFECTS = {
    "gravity": Hue((150, 112, 222), (222, 212, 255)),
    "gravity_gradient": Hue((235, 40, 230), (250, 150, 245)),
    "drag": Hue((20, 160, 170), (140, 245, 255)),
    "radiation_pressure": Hue((175, 165, 20), (255, 244, 125)),
}
_OF_OTHERS = (Hue((250, 55, 130), (250, 158, 188)), Hue((60, 150, 80), (165, 245, 175)))


def hues(effects: Iterable[str]) -> dict[str, Hue]:
    """Return a hue for each effect; custom effects get the remaining hues in order, which may repeat."""
    names = list(effects)
    left = [*_OF_OTHERS, *(hue for name, hue in _OF_EFFECTS.items() if name not in names)]
    others = [name for name in names if name not in _OF_EFFECTS]
    taken = {name: left[index % len(left)] for index, name in enumerate(others)}
    return {name: _OF_EFFECTS.get(name) or taken[name] for name in names}


def of_systems(names: Iterable[str]) -> dict[str, Color]:
    """Return a colour for each spacecraft; the colours repeat after eight."""
    return {name: LINES[index % len(LINES)] for index, name in enumerate(names)}
