"""Options of ``onorbit show --picture``, and the file that it writes."""

from __future__ import annotations

import math
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any

from onorbit_rs.common.files import replacing
from onorbit_rs.common.numbers import shortest
from onorbit_rs.exceptions import InputError

if TYPE_CHECKING:
    from onorbit_rs.output.read import SavedRun

LARGEST = 8192
"""Largest width and height of a picture, pixels."""


@dataclass(frozen=True)
class View:
    """Options of a picture, each None if it was not given.

    ``at`` is the time, s, ``size`` the width and height in pixels, ``eye`` the position of the camera and
    ``look_at`` the point in the middle, m, both relative to the base of the first robot. ``has_collisions``
    is never None.
    """

    at: float | None
    size: tuple[int, int] | None
    eye: tuple[float, ...] | None
    look_at: tuple[float, ...] | None
    has_collisions: bool

    @classmethod
    def of(
        cls, at: float | None, size: str | None, eye: str | None, look_at: str | None, *, is_collision: bool
    ) -> View:
        """Return the options, parsed from the texts on the command line.

        Raises
        ------
        InputError
            If a size or a point is malformed, or ``eye`` and ``look_at`` are the same point.
        """
        view = cls(at, _size(size), _point("eye", eye), _point("look_at", look_at), is_collision)
        if view.eye is not None and view.eye == view.look_at:
            raise InputError(
                f"--eye and --look-at are both {eye}; give two different points", name="look_at", got=look_at
            )
        return view

    def check_unused(self) -> None:
        """Raise InputError if an option of a picture is given without ``--picture``."""
        given = {
            "at": self.at, "size": self.size, "eye": self.eye, "look-at": self.look_at,
            "collision": self.has_collisions or None,
        }  # fmt: skip
        for option, value in given.items():
            if value is not None:
                raise InputError(
                    f"--{option} applies only to a picture; add --picture FILE.png",
                    name=option.replace("-", "_"), got=value,
                )  # fmt: skip

    def check_time(self, end_s: float) -> None:
        """Raise InputError for a time outside a run that ends at ``end_s``."""
        at_s = self.at or 0.0
        if not (math.isfinite(at_s) and 0.0 <= at_s <= end_s):
            raise InputError(
                f"--at {shortest(at_s)} is outside the run; give a time from 0 to {shortest(end_s)}, in s",
                name="at", got=at_s, expected=f"0 to {shortest(end_s)} s",
            )  # fmt: skip


def save_picture(saved: SavedRun, summary: dict[str, Any], picture: Path, view: View) -> None:
    """Draw the scene of a run, and write it to a PNG file.

    Raises
    ------
    OnOrbitError
        If the trace, the scenario or a robot cannot be read, or the robot has changed since the run.
    OutputFolderError
        If the file cannot be written.
    """
    import numpy as np

    from onorbit_rs.pictures import draw_picture
    from onorbit_rs.pictures.picture import SIZE
    from onorbit_rs.report.scene import scene_of_run

    scene = scene_of_run(saved, summary, view.at or 0.0)
    points = [None if point is None else np.array(point) for point in (view.eye, view.look_at)]
    content = draw_picture(
        scene, view.size or SIZE, eye=points[0], look_at=points[1], has_collisions=view.has_collisions
    )
    with replacing(picture) as file:
        file.write_bytes(content)


def _size(text: str | None) -> tuple[int, int] | None:
    """Return width and height in pixels of a text such as ``1280x720``."""
    if text is None:
        return None
    width, _, height = text.lower().partition("x")
    if width.isdecimal() and height.isdecimal() and all(1 <= int(one) <= LARGEST for one in (width, height)):
        return int(width), int(height)
    raise InputError(
        f"--size {text!r} is not valid; write WIDTHxHEIGHT in pixels, each from 1 to {LARGEST}, such as "
        "1280x720",
        name="size", got=text, expected=f"1x1 to {LARGEST}x{LARGEST}",
    )  # fmt: skip


def _point(name: str, text: str | None) -> tuple[float, ...] | None:
    """Return the coordinates of a text such as ``3,-4,2.5``."""
    if text is None:
        return None
    try:
        point = tuple(float(part) for part in text.split(","))
    except ValueError:
        point = ()
    if len(point) == 3 and all(map(math.isfinite, point)):
        return point
    option = f"--{name.replace('_', '-')}"
    raise InputError(
        f"{option} {text!r} is not a point; write three finite numbers in m, such as {option}=3,-4,2.5",
        name=name, got=text, expected="X,Y,Z",
    )  # fmt: skip
