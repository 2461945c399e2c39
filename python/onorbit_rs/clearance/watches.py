"""Declarations of the distances to evaluate: keep-out zones and minimum distances."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from onorbit_rs.exceptions import InputError

if TYPE_CHECKING:
    from collections.abc import Sequence

    from numpy.typing import ArrayLike, NDArray

    from onorbit_rs._core import Shape


def _patterns(links: str | Sequence[str], name: str) -> tuple[str, ...]:
    """Return one or several patterns as a tuple; raise an InputError if there is none, or one is not text."""
    found = (links,) if isinstance(links, str) or not isinstance(links, Iterable) else tuple(links)
    if not found or not all(isinstance(link, str) for link in found):
        message = (
            f"{name} is {links!r}; expected the name of a link, such as 'chaser/gripper*', or a list of names"
        )
        raise InputError(message, name=name, got=links)
    return found


def _pose(given: ArrayLike, zone: str) -> NDArray[np.float64]:
    """Return the pose of a zone as a (4, 4) array; raise an InputError if it is not a rigid motion."""
    try:
        pose = np.array(given, dtype=np.float64)
    except (TypeError, ValueError):
        message = (
            f"the pose of the zone {zone!r} is {given!r:.60}; expected a (4, 4) array of numbers, with the "
            "translation in m"
        )
        raise InputError(message, name="pose", got=given) from None
    if pose.shape != (4, 4):
        message = f"the pose of the zone {zone!r} has shape {pose.shape}; expected (4, 4)"
        raise InputError(message, name="pose", got=pose.shape)
    if not np.isfinite(pose).all():
        message = f"the pose of the zone {zone!r} contains infinity or NaN; give finite numbers"
        raise InputError(message, name="pose", got=zone)
    rotation = pose[:3, :3]
    if not np.allclose(rotation @ rotation.T, np.eye(3), atol=1e-6) or np.linalg.det(rotation) < 0.0:
        message = (
            f"the upper left 3 x 3 block of the pose of the zone {zone!r} is not a rotation; give an "
            "orthogonal matrix with determinant 1"
        )
        raise InputError(message, name="pose", got=zone)
    if not np.allclose(pose[3], (0.0, 0.0, 0.0, 1.0), atol=1e-6):
        last = ", ".join(f"{part:g}" for part in pose[3])
        message = (
            f"the last row of the pose of the zone {zone!r} is ({last}), not (0, 0, 0, 1); a translation "
            "belongs in the last column"
        )
        raise InputError(message, name="pose", got=zone)
    return pose


@dataclass(frozen=True)
class KeepOut:
    """Zone that links must not enter; an entry is a violation, but no force acts.

    Attributes
    ----------
    name : str
        Name in results.
    shape : Shape
        Shape of the zone, such as ``Shape.cone(1.0, 3.0)``.
    links : str or sequence of str
        Links that must stay outside: ``SYSTEM/LINK`` in a world, ``LINK`` for one robot; ``*`` stands for any
        text.
    fixed_to : str
        ``world`` (W), ``lvlh`` (L, at the origin of W), or a frame with which the zone moves,
        ``SYSTEM/FRAME`` in a world or ``FRAME`` for one robot.
    pose : (4, 4) array or None
        Pose of the shape in ``fixed_to``, m; None for the identity.

    Raises
    ------
    InputError
        If no link is given, or the pose is not a finite (4, 4) array with a rotation and the last row
        (0, 0, 0, 1).
    """

    name: str
    shape: Shape
    links: str | Sequence[str]
    fixed_to: str = "world"
    pose: ArrayLike | None = None

    def __post_init__(self) -> None:
        """Check the arguments, and store the links as a tuple and the pose as an array."""
        object.__setattr__(self, "links", _patterns(self.links, "links"))
        object.__setattr__(self, "pose", np.eye(4) if self.pose is None else _pose(self.pose, self.name))


@dataclass(frozen=True)
class MinimumDistance:
    """Least distance between two sets of links; an overlap is a violation, but no force acts.

    Links of one body, and links of bodies that a joint connects, are not compared with each other, so both
    sets may be all links of a robot.

    Attributes
    ----------
    name : str
        Name in results.
    links_a, links_b : str or sequence of str
        Links of both sides: ``SYSTEM/LINK`` in a world, ``LINK`` for one robot; ``*`` stands for any text.

    Raises
    ------
    InputError
        If a side has no links.
    """

    name: str
    links_a: str | Sequence[str]
    links_b: str | Sequence[str]

    def __post_init__(self) -> None:
        """Check the patterns and store each side as a tuple."""
        object.__setattr__(self, "links_a", _patterns(self.links_a, "links_a"))
        object.__setattr__(self, "links_b", _patterns(self.links_b, "links_b"))


Watch = KeepOut | MinimumDistance
