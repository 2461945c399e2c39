"""Computes the distances of links from other links and from keep-out zones in the rows of a trace."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any

import numpy as np

from onorbit_rs import _core
from onorbit_rs.clearance.intervals import Violation, violations
from onorbit_rs.clearance.sides import (
    Link,
    Models,
    check_carrier,
    links_matching,
    permitted,
    poses,
    shapes_of,
    zone_poses,
)
from onorbit_rs.clearance.watches import KeepOut, MinimumDistance, Watch
from onorbit_rs.exceptions import InputError

if TYPE_CHECKING:
    from numpy.typing import NDArray

    Floats = NDArray[np.float64]

ROWS_AT_ONCE = 4096


@dataclass(frozen=True)
class Clearance:
    """Distance between two groups of links, or from a keep-out zone to links, in every row of a trace.

    Attributes
    ----------
    name : str
        Name of the keep-out zone or minimum distance.
    time : (T,) array
        Times of the rows, s.
    gap : (T,) array
        Least distance, m; the negative depth where links overlap or are in the zone.
    point_a, point_b : (T, 3) arrays
        Nearest points of the nearest pair in W, m; ``point_a`` is on the zone or on the first side.
    normal : (T, 3) array
        Unit vector from the first to the second side, in W.
    pair : (T, 2) array of int
        Nearest pair, as an index into each of the two tuples in ``names``.
    names : (tuple of str, tuple of str)
        Names of both sides: links, or the name of the zone.
    """

    name: str
    time: Floats
    gap: Floats
    point_a: Floats
    point_b: Floats
    normal: Floats
    pair: NDArray[np.int64]
    names: tuple[tuple[str, ...], tuple[str, ...]]

    @property
    def links(self) -> list[tuple[str, str]]:
        """Names of the nearest pair in each row."""
        return [(self.names[0][a], self.names[1][b]) for a, b in self.pair.tolist()]

    @property
    def nearest(self) -> int:
        """Index of the row with the least distance."""
        return int(np.argmin(self.gap))

    @property
    def violations(self) -> list[Violation]:
        """Intervals in which links overlap or are in the zone, in order of time."""
        return list(violations(self.time, self.gap, self.links))


@dataclass(frozen=True)
class Prepared:
    """Keep-out zone or minimum distance, with the links that its patterns match."""

    watch: Watch
    side_a: list[Link]
    """Links of the first side; empty for a keep-out zone."""
    side_b: list[Link]
    permitted: list[list[bool]] = field(repr=False)
    """Whether each pair of a link of ``side_a`` and a link of ``side_b`` is compared."""


def prepare(models: Models, watch: Watch) -> Prepared:
    """Return a keep-out zone or minimum distance with the links that its patterns match.

    Raises
    ------
    FrameError
        If a pattern matches no link with a collision shape, or a zone is fixed to an unknown frame.
    InputError
        If no pair of links is left to compare.
    """
    if isinstance(watch, KeepOut):
        check_carrier(watch, models)
        links = links_matching(models, tuple(watch.links), watch.name)
        return Prepared(watch, [], links, [[True] * len(links)])
    a, b = (links_matching(models, tuple(side), watch.name) for side in (watch.links_a, watch.links_b))
    allowed = permitted(models, a, b)
    if not np.any(allowed):
        message = (
            f"{watch.name!r} compares no two links: the links that match {', '.join(watch.links_a)} and "
            f"those that match {', '.join(watch.links_b)} are on one body or on adjacent bodies; give links "
            "of bodies that no joint connects"
        )
        raise InputError(message, name=watch.name, got=watch.links_b)
    return Prepared(watch, a, b, allowed)


def clearances(models: _core.Model | Models, trace: Any, watches: Sequence[Watch]) -> dict[str, Clearance]:
    """Return the distances that ``watches`` defines, in the rows of a trace.

    The rows are those that all systems have in common; between rows, a distance may be smaller.

    Parameters
    ----------
    models : Model or mapping from str to Model
        Robot of the trace, or the models of all systems by their names.
    trace : Trace or WorldTrace
        Result of a run, which may have been read from a file.
    watches : sequence of KeepOut and MinimumDistance
        Distances to evaluate, with different names.

    Returns
    -------
    dict from str to Clearance

    Raises
    ------
    FrameError, InputError
        If a name or a pattern is unknown, two watches have the same name, no pair of links is left to
        compare, or a zone is fixed to lvlh without an orbit for which this frame is defined.
    """
    named: Models = {"": models} if isinstance(models, _core.Model) else models
    names = [watch.name for watch in watches]
    if twice := next((name for name in names if names.count(name) > 1), None):
        message = f"two entries of 'watches' are named {twice!r}; give each its own name"
        raise InputError(message, name="name", got=twice)
    time, rows, orbit = _rows(named, trace)
    return {watch.name: _evaluated(prepare(named, watch), named, time, rows, orbit) for watch in watches}


def _rows(models: Models, trace: Any) -> tuple[Floats, dict[str, Floats], Any]:
    """Return the common times (T,), the configurations by system, and the states of the orbit, if any."""
    time = np.asarray(trace.time, dtype=np.float64)
    rows: dict[str, Floats] = {}
    orbit = None
    for system in models:
        own = trace[system] if system else trace
        # of two rows at one time, the later one is after an event
        at = np.searchsorted(np.asarray(own.time), time, side="right") - 1 if system else np.arange(len(time))
        rows[system] = np.ascontiguousarray(np.asarray(own.q)[at])
        if orbit is None and "reference_position_eci" in own.columns():
            orbit = tuple(
                np.asarray(column)[at] for column in (own.reference_position_eci, own.reference_velocity_eci)
            )
    return time, rows, orbit


def _evaluated(
    prepared: Prepared, models: Models, time: Floats, rows: Mapping[str, Floats], orbit: Any
) -> Clearance:
    """Return the distances of one keep-out zone or minimum distance."""
    watch, parts = prepared.watch, []
    for first in range(0, len(time), ROWS_AT_ONCE):
        now = slice(first, first + ROWS_AT_ONCE)
        some = {system: q[now] for system, q in rows.items()}
        if isinstance(watch, KeepOut):
            here = None if orbit is None else tuple(column[now] for column in orbit)
            shapes: list[Any] = [watch.shape]
            places = zone_poses(watch, models, some, here)
        else:
            shapes, places = shapes_of(models, prepared.side_a), poses(models, some, prepared.side_a)
        others = poses(models, some, prepared.side_b)
        parts.append(
            _core.least_distances(
                shapes, places, shapes_of(models, prepared.side_b), others, prepared.permitted
            )
        )
    gap, point_a, point_b, normal, pair = (np.concatenate(column) for column in zip(*parts, strict=True))
    own = (watch.name,) if isinstance(watch, KeepOut) else tuple(link.path for link in prepared.side_a)
    names = (own, tuple(link.path for link in prepared.side_b))
    return Clearance(watch.name, time, gap, point_a, point_b, normal, pair.astype(np.int64), names)


__all__ = ["Clearance", "MinimumDistance", "Prepared", "clearances", "prepare"]
