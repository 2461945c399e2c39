"""Data of a run with several systems that the viewer requires in addition to the rows of the trace."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import TYPE_CHECKING

from onorbit_rs.scenario.connections import Connection, connected_groups, connections, touching
from onorbit_rs.viewer.setting import Setting

if TYPE_CHECKING:
    from onorbit_rs.scenario.build_world import BuiltWorld


@dataclass(frozen=True)
class WorldSetting:
    """The systems by name, all on one reference orbit, and the connections that events can make."""

    systems: Mapping[str, Setting]
    connections: tuple[Connection, ...] = ()
    name: str = ""
    touching: tuple[tuple[str, ...], ...] = ()
    """Systems of each contact."""
    contacts: tuple[str, ...] = ()
    """Names of the contacts with a force."""

    @classmethod
    def of(cls, built: BuiltWorld) -> WorldSetting:
        """Return the setting of a scenario with several systems that was built."""
        found = connections(built.scenario)
        systems = {
            name: Setting.of(alone, name, grasps_of(name, found)) for name, alone in built.systems.items()
        }
        models = {name: alone.model for name, alone in built.systems.items()}
        forces = tuple(contact.label for contact in built.scenario.contacts if contact.normal is not None)
        return cls(systems, found, built.scenario.name, touching(built.scenario, models), forces)

    @property
    def names(self) -> list[str]:
        """Names of the systems."""
        return list(self.systems)

    @property
    def first(self) -> Setting:
        """Setting of the first system, whose orbit and Earth apply to all systems."""
        return next(iter(self.systems.values()))

    @property
    def groups(self) -> list[list[str]]:
        """Names of the systems in each group that connections can join or that can touch."""
        return connected_groups(self.names, self.connections, self.touching)

    @property
    def pairs(self) -> tuple[Connection, ...]:
        """Connections without those that repeat the frames of an earlier connection."""
        return tuple({connection.frames: connection for connection in reversed(self.connections)}.values())[
            ::-1
        ]


def grasps_of(system: str, found: tuple[Connection, ...]) -> tuple[str, ...]:
    """Return the frames of a system that capture or are captured, without duplicates."""
    ends = (end for connection in found for end in (connection.by, connection.of))
    return tuple(dict.fromkeys(frame for name, frame in ends if name == system))
