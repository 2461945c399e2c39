"""Finds the links that patterns match, and computes the poses of their shapes."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np

from onorbit_rs.common.link_patterns import link_pattern
from onorbit_rs.common.rotations import is_local_frame_defined, local_orbital_axes
from onorbit_rs.common.suggestions import did_you_mean
from onorbit_rs.exceptions import FrameError, InputError

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from onorbit_rs._core import Model, Shape
    from onorbit_rs.clearance.watches import KeepOut

    Floats = NDArray[np.float64]

Models = Mapping[str, "Model"]
"""Model of each system, by the name of the system; the name of a single robot is ``""``."""


@dataclass(frozen=True)
class Link:
    """Link of a system, with the body to which it is fixed."""

    system: str
    name: str
    body: str
    """Body to which the link is fixed."""

    @property
    def path(self) -> str:
        """Path of the link: ``SYSTEM/LINK``, or ``LINK`` if there is only one robot."""
        return f"{self.system}/{self.name}" if self.system else self.name


def links_matching(models: Models, patterns: Sequence[str], watch: str) -> list[Link]:
    """Return the links with collision shapes that the patterns match.

    Raises
    ------
    FrameError
        If a pattern matches no link, or no link with a collision shape.
    """
    known = [
        Link(system, frame.name, frame.body) for system, model in models.items() for frame in model.frames
    ]
    solid = {(system, shape.link) for system, model in models.items() for shape in model.collisions}
    found: dict[Link, None] = {}
    for pattern in patterns:
        matching = [link for link in known if link_pattern(pattern).fullmatch(link.path)]
        if not matching:
            hint = did_you_mean(pattern, [link.path for link in known])
            raise FrameError(f"{watch!r}: no link matches {pattern!r}{hint}", name=pattern, kind="link")
        own = [link for link in matching if (link.system, link.name) in solid]
        if not own:
            raise FrameError(
                f"{watch!r}: no link that matches {pattern!r} has a collision shape; add a <collision> "
                "element to the robot file, or a shape with 'collision' or Model.with_collision",
                name=pattern, kind="link",
            )  # fmt: skip
        found |= dict.fromkeys(own)
    return list(found)


def permitted(models: Models, side_a: Sequence[Link], side_b: Sequence[Link]) -> list[list[bool]]:
    """Return whether each pair (n_a, n_b) is compared; False for links of one body or of adjacent bodies."""
    joined = {
        pair for system, model in models.items() for joint in model.joints
        for pair in ((system, joint.parent, joint.child), (system, joint.child, joint.parent))
    }  # fmt: skip
    return [
        [
            a.system != b.system or (a.body != b.body and (a.system, a.body, b.body) not in joined)
            for b in side_b
        ]
        for a in side_a
    ]


def poses(models: Models, rows: Mapping[str, Floats], links: Sequence[Link]) -> Floats:
    """Return the poses (T, n, 4, 4) of links in W, for configurations (T, nq) of each system."""
    found = [np.asarray(models[link.system].frame_pose(rows[link.system], link.name)) for link in links]
    stacked: Floats = np.stack([one.reshape(-1, 4, 4) for one in found], axis=1)
    return stacked


def check_carrier(zone: KeepOut, models: Models) -> None:
    """Raise a FrameError if the zone is fixed to an unknown frame."""
    if zone.fixed_to in ("world", "lvlh"):
        return
    known = [
        f"{system}/{name}" if system else name
        for system, model in models.items()
        for name in model.frame_names
    ]
    if zone.fixed_to not in known:
        hint = did_you_mean(zone.fixed_to, ["world", "lvlh", *known])
        message = (
            f"{zone.name!r}: fixed_to is {zone.fixed_to!r}; it must be 'world', 'lvlh' or a frame (in "
            f"a world, SYSTEM/FRAME){hint}"
        )
        raise FrameError(message, name=zone.fixed_to, kind="frame")


def zone_poses(zone: KeepOut, models: Models, rows: Mapping[str, Floats], orbit: Any) -> Floats:
    """Return the poses (T, 1, 4, 4) of a zone in W.

    ``orbit`` contains position, m, and velocity, m/s, of the reference orbit in ECI, (T, 3) each, or is None.
    Raises InputError if the zone is fixed to lvlh and there is no orbit for which this frame is defined.
    """
    own, count = np.asarray(zone.pose, dtype=np.float64), len(next(iter(rows.values())))
    if zone.fixed_to == "world":
        return np.broadcast_to(own, (count, 1, 4, 4)).copy()
    if zone.fixed_to != "lvlh":
        system, _, frame = zone.fixed_to.rpartition("/")
        carrier = np.asarray(models[system].frame_pose(rows[system], frame)).reshape(-1, 4, 4)
        carried: Floats = np.matmul(carrier, own)
        return carried[:, None]
    if orbit is None or not is_local_frame_defined(*orbit):
        message = (
            f"{zone.name!r} is fixed to lvlh, which requires a reference orbit with a velocity that is "
            "neither zero nor parallel to the position; add or correct the orbit, or use 'world'"
        )
        raise InputError(message, name="fixed_to", got="lvlh")
    turned = np.tile(np.eye(4), (count, 1, 1))
    turned[:, :3, :3] = local_orbital_axes(*orbit)
    placed: Floats = np.matmul(turned, own)
    return placed[:, None]


def shapes_of(models: Models, links: Sequence[Link]) -> list[tuple[Model, str] | Shape]:
    """Return links as arguments of ``least_distances``: the model and the name of each link."""
    return [(models[link.system], link.name) for link in links]
