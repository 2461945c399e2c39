"""Connections that the events of a scenario can make between its systems."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING, NamedTuple

from onorbit_rs.scenario.contact import touching_systems
from onorbit_rs.scenario.events import Latch, split_path

if TYPE_CHECKING:
    from onorbit_rs._core import Model
    from onorbit_rs.scenario.world import WorldScenario


class Connection(NamedTuple):
    """Connection of two systems by a capture; ``by`` captures ``of``, both given as (system, frame)."""

    name: str
    by: tuple[str, str]
    of: tuple[str, str]
    latch: Latch | None = None
    releases: tuple[str, ...] = ()

    @property
    def systems(self) -> tuple[str, str]:
        """Names of the two systems, the capturing one first."""
        return self.by[0], self.of[0]

    @property
    def frames(self) -> tuple[str, str]:
        """Paths ``SYSTEM/FRAME`` of the two frames, the capturing one first."""
        return "/".join(self.by), "/".join(self.of)


def connections(scenario: WorldScenario) -> tuple[Connection, ...]:
    """Return the connections of a scenario, in the order of its captures."""
    found = []
    for event in scenario.events:
        if event.do.capture is not None:
            by, of = map(split_path, event.do.capture)
            releases = tuple(other.name for other in scenario.events if other.do.release == event.name)
            found.append(Connection(event.name, by, of, event.when.latch, releases))
    return tuple(found)


def touching(scenario: WorldScenario, models: Mapping[str, Model]) -> tuple[tuple[str, ...], ...]:
    """Return, for each contact of a scenario, the names of the systems whose links it may involve."""
    return tuple(tuple(touching_systems(contact, models)) for contact in scenario.contacts)


def connected_groups(
    systems: Sequence[str], found: Sequence[Connection], touch: Sequence[Sequence[str]] = ()
) -> list[list[str]]:
    """Return the groups of two or more systems that may interact, in the order of ``systems``.

    Both connections and contacts join systems; ``touch`` contains the systems of each contact.
    """
    groups = [{name} for name in systems]
    for together in [*(connection.systems for connection in found), *touch]:
        joined = [group for group in groups if group & set(together)]
        groups = [group for group in groups if group not in joined] + [set().union(*joined)]
    groups = [group for group in groups if group]
    order = list(systems).index
    large = [sorted(group, key=order) for group in groups if len(group) > 1]
    return sorted(large, key=lambda group: order(group[0]))
