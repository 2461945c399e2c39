"""Keep-out zones and least distances of a scenario."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

from pydantic import BeforeValidator, Field

from onorbit_rs import _core
from onorbit_rs.clearance.evaluate import prepare
from onorbit_rs.clearance.watches import KeepOut, MinimumDistance, Watch
from onorbit_rs.exceptions import InputError
from onorbit_rs.scenario.errors import inconsistent, invalid, shortened
from onorbit_rs.scenario.events import ItsName
from onorbit_rs.scenario.faults import Faults
from onorbit_rs.scenario.locations import located
from onorbit_rs.scenario.part import Part
from onorbit_rs.scenario.pose import Pose
from onorbit_rs.scenario.shape import Shape

if TYPE_CHECKING:
    from onorbit_rs.scenario.document import Document
    from onorbit_rs.scenario.yaml_lines import Location


def _side(value: object) -> object:
    """Return one or several patterns as a list."""
    found = value if isinstance(value, list) else [value]
    if not found or not all(isinstance(link, str) for link in found):
        raise invalid(
            "must be a link or a pattern, such as gripper*, or a list with at least one of them, not "
            f"{shortened(value)}"
        )
    return found


Links = Annotated[list[str], BeforeValidator(_side)]


class KeepOutZone(Part):
    """Zone that links must not enter; no force acts."""

    name: ItsName
    shape: Shape
    links: Links
    """Links that must stay outside: paths ``SYSTEM/LINK``, or names of links in a scenario with one robot;
    ``*`` stands for any text."""
    fixed_to: str = "world"
    """Frame of the zone: ``world``, ``lvlh`` (local frame of the reference orbit), or a frame of a robot."""
    pose: Pose | None = None
    """Pose of the shape in ``fixed_to``. Default: the frames coincide."""

    def build(self, folder: Path) -> Watch:
        """Return the zone; relative paths start at ``folder``."""
        pose = None if self.pose is None else self.pose.transform()
        return KeepOut(self.name, self.shape.build(folder), self.links, self.fixed_to, pose)


class LeastDistance(Part):
    """Least distance between two sets of links, which is recorded; overlaps are reported."""

    name: ItsName
    between: Annotated[list[Links], Field(min_length=2, max_length=2)]
    """Both sides, each a link or a list of links, written as for a keep-out zone. Links of one body or of
    neighbouring bodies are not compared."""

    def build(self, folder: Path) -> Watch:
        """Return the declaration of the distance, which is evaluated on the rows of a trace."""
        return MinimumDistance(self.name, *self.between)


def check_names(scenario: Document) -> None:
    """Raise an error if two zones or distances have the same name."""
    names: list[str] = []
    for at, part in _parts(scenario):
        if part.name in names:
            message = f"two zones or distances are named {part.name!r}; names must be unique"
            raise inconsistent((*at, "name"), message)
        names.append(part.name)


def _parts(scenario: Document) -> Iterator[tuple[Location, KeepOutZone | LeastDistance]]:
    """Yield zones and distances with their locations."""
    for index, zone in enumerate(scenario.keep_out):
        yield ("keep_out", index), zone
    for index, distance in enumerate(scenario.distances):
        yield ("distances", index), distance


def build_watches(scenario: Document, models: Mapping[str, _core.Model]) -> list[Watch]:
    """Return zones and distances, after checking that their links exist.

    ``models`` contains the robot of each system by name; the key of a single robot is ``""``.

    Raises
    ------
    OnOrbitError
        For unknown links or frames, a distance without a pair of links to compare, and a zone in ``lvlh``
        without an orbit; the message contains the location of the entry.
    """
    found, faults = [], Faults()
    for at, part in _parts(scenario):
        with faults.kept(), located(scenario, *at):
            found.append(part.build(scenario.folder))
            prepare(models, found[-1])
            if getattr(part, "fixed_to", "") == "lvlh" and scenario.orbit is None:
                message = "lvlh requires an orbit; add 'orbit', or use fixed_to: world"
                raise InputError(message, name="fixed_to", got="lvlh")
    faults.check()
    return found
