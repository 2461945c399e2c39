"""Draws the axes of the base and of the scene in a corner of a picture."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
from PIL import Image, ImageDraw, ImageFilter, ImageFont

if TYPE_CHECKING:
    from numpy.typing import NDArray

    Floats = NDArray[np.float64]

COLORS = ((255, 105, 92), (96, 222, 118), (112, 168, 255))
"""Colours of x, y and z."""

_FINER = 4
_MARGIN = 0.02
"""Distance of the names from the edge of a triad, as a fraction of its height."""

_SHARE = 0.17
"""Height of a triad, as a fraction of the height of the picture."""


def add_triads(image: Floats, triads: list[tuple[str, Floats]]) -> None:
    """Draw named axes side by side from the lower left corner of a picture (height, width, 3), 0 to 1.

    Each entry has a name, such as ``B``, and the rotation (3, 3) from its axes to those of the camera: right,
    up and backwards.
    """
    side = int(_SHARE * min(image.shape[:2]))
    if side < 24:  # too small to be read
        return
    for index, (name, rotation) in enumerate(triads):
        tile = _tile(name, rotation, side)
        left = int(0.15 * side + 1.15 * side * index)
        if left + side > image.shape[1]:
            return
        part = image[image.shape[0] - side - side // 8 : image.shape[0] - side // 8, left : left + side]
        part += tile[..., 3:] * (tile[..., :3] - part)


def _tile(name: str, rotation: Floats, side: int) -> Floats:
    """Return the picture (side, side, 4), RGBA from 0 to 1, of one triad."""
    finer = _FINER * side
    tile = Image.new("RGBA", (finer, finer), (0, 0, 0, 0))
    draw = ImageDraw.Draw(tile)
    font = ImageFont.load_default(size=finer / 7)
    middle, length = np.array([finer, finer]) / 2.0, 0.30 * finer
    for axis in np.argsort(rotation[2]):  # the axes that point away from the camera first
        tip = middle + length * rotation[:2, axis] * [1.0, -1.0]
        color = COLORS[axis] + (255,)
        draw.line([*middle, *tip], fill=color, width=finer // 32)
        _head(draw, middle, tip, finer, color)
        place = middle + 1.42 * length * rotation[:2, axis] * [1.0, -1.0]
        label = f"{'xyz'[axis]} {name}"
        half = np.array([draw.textlength(label, font=font) / 2.0, finer / 14.0])
        inside = place.clip(half + _MARGIN * finer, finer - half - _MARGIN * finer)
        draw.text(tuple(inside), label, fill=color, font=font, anchor="mm")
    tile = Image.alpha_composite(_halo(tile, finer), tile)
    small = tile.convert("RGBa").resize((side, side), Image.Resampling.BOX).convert("RGBA")
    return np.asarray(small, dtype=np.float64) / 255.0


def _halo(tile: Image.Image, finer: int) -> Image.Image:
    """Return a dark, soft copy of the axes and names, which separates them from a bright background."""
    alpha = tile.getchannel("A").filter(ImageFilter.GaussianBlur(finer / 45))
    halo = Image.new("RGBA", tile.size, (8, 10, 16, 0))
    halo.putalpha(alpha.point(lambda value: min(int(2.2 * value), 215)))
    return halo


def _head(draw: ImageDraw.ImageDraw, start: Floats, tip: Floats, finer: int, color: tuple[int, ...]) -> None:
    """Draw the head of an arrow, unless the arrow points along the line of sight."""
    along = tip - start
    length = float(np.linalg.norm(along))
    if length < finer / 40:
        return
    along *= finer / 16 / length
    aside = 0.5 * along[::-1] * [-1.0, 1.0]
    draw.polygon(
        [tuple(tip + 0.6 * along), tuple(tip - 0.4 * along + aside), tuple(tip - 0.4 * along - aside)],
        fill=color,
    )
