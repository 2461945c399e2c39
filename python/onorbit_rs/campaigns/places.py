"""Entries of a scenario by path, such as ``initial.joints`` or ``robot.links.*.inertia``."""

from __future__ import annotations

import re
from collections.abc import Iterator, Mapping
from dataclasses import dataclass, replace
from fnmatch import fnmatchcase
from functools import cached_property, lru_cache
from typing import TYPE_CHECKING, Annotated, Any

import numpy as np
from pydantic import TypeAdapter

from onorbit_rs.campaigns.link_inertias import link_inertias
from onorbit_rs.common.coordinates import JOINTS_Q
from onorbit_rs.common.suggestions import nearest
from onorbit_rs.scenario.attitude import Attitude
from onorbit_rs.scenario.initial import InitialState
from onorbit_rs.scenario.joint_values import joint_values
from onorbit_rs.scenario.locations import dotted
from onorbit_rs.scenario.part import Part
from onorbit_rs.scenario.robot import PlainRobot
from onorbit_rs.scenario.settings import ControlSettings
from onorbit_rs.scenario.world import WorldScenario

if TYPE_CHECKING:
    from onorbit_rs._core import Model
    from onorbit_rs.scenario.load import AnyScenario
    from onorbit_rs.scenario.yaml_lines import Location


@dataclass(frozen=True)
class Place:
    """An entry of a scenario: its location in the resolved data, and its value."""

    at: Location
    value: Any
    owner: type[Part] | None = None
    """Part whose field ``key`` contains the entry."""
    key: str = ""
    inside: Location = ()
    """Location of the entry in the value of the field."""
    field_value: Any = None
    """Plain value of the whole field."""
    model: Model | None = None
    """Robot, if the entry is a set of joint values or one of them."""

    @property
    def name(self) -> str:
        """Path of the entry as text, such as ``initial.position[0]``."""
        return dotted(self.at)

    @property
    def is_attitude(self) -> bool:
        """True if the entry is an attitude."""
        return self.owner is not None and self.inside == () and _holds(self.owner, self.key, Attitude)

    def inner(self, step: str | int, value: Any) -> Place:
        """Return the entry at the key or index ``step`` inside this entry; its value is ``value``."""
        return replace(self, at=(*self.at, step), value=value, inside=(*self.inside, step))

    def candidate(self, value: Any) -> Any:
        """Return a copy of the plain value of the whole field in which this entry has another value."""
        return _with(self.field_value, self.inside, value)


@lru_cache(maxsize=4096)
def adapter(owner: type[Part], key: str) -> TypeAdapter[Any]:
    """Return the validator of one field of a part."""
    info = owner.model_fields[_names(owner)[key]]
    annotation: Any = info.annotation
    for item in info.metadata:
        annotation = Annotated[annotation, item]
    return TypeAdapter(annotation)


@lru_cache(maxsize=1024)
def _names(owner: type[Part]) -> dict[str, str]:
    """Return the name of each field by its key in the YAML file."""
    return {field.alias or name: name for name, field in owner.model_fields.items()}


def _holds(owner: type[Part], key: str, kind: type[Part]) -> bool:
    return kind.__name__ in str(owner.model_fields[_names(owner)[key]].annotation)


def _with(value: Any, inside: Location, leaf: Any) -> Any:
    """Return a copy of a plain value with one entry replaced."""
    if not inside:
        return leaf
    step, rest = inside[0], inside[1:]
    if isinstance(value, list):
        return [_with(item, rest, leaf) if i == step else item for i, item in enumerate(value)]
    found = dict(value or {})
    return found | {step: _with(found.get(step), rest, leaf)}


class Places:
    """Finds the entries of a scenario by path."""

    def __init__(self, scenario: AnyScenario) -> None:
        """Store the scenario; robots are built when links or joints are named."""
        self.scenario = scenario
        self._links: dict[str, dict[str, Any]] = {}

    @cached_property
    def models(self) -> dict[str, Model]:
        """Robots by the name of their system; the robot of a scenario with one robot has the name ``""``."""
        if isinstance(self.scenario, WorldScenario):
            return {name: alone.robot.build(alone) for name, alone in self.scenario.scenarios.items()}
        return {"": self.scenario.robot.build(self.scenario)}

    def find(self, path: str) -> list[Place]:
        """Return the entries that a path names; empty if there is none."""
        return list(self._matches(Place((), self.scenario), self._steps(path)))

    def _steps(self, path: str) -> list[str]:
        """Return the keys of a path; if the scenario has only one system, without ``systems.NAME``.

        Control settings of that system are in ``simulation``.
        """
        steps = _steps(path)
        if isinstance(self.scenario, WorldScenario) or steps[:1] != ["systems"] or len(steps) < 3:
            return steps
        if self.scenario.location("robot")[:1] != ("systems",):
            return steps
        if not fnmatchcase(str(self.scenario.location("robot")[1]), steps[1]):
            return steps
        return ["simulation", *steps[2:]] if steps[2] in ControlSettings.model_fields else steps[2:]

    def known(self, path: str) -> list[str]:
        """Return the names of all entries at the deepest level to which the path leads."""
        return [
            f"{place.name}[{key}]" if key.isdecimal() else f"{place.name}.{key}".removeprefix(".")
            for place in self._deepest(self._steps(path))[0]
            for key in self._children(place)
        ]

    def nearest(self, path: str) -> str | None:
        """Return the path to which a misspelt path probably refers, or None."""
        steps = self._steps(path)
        parents, depth = self._deepest(steps)
        near = nearest(steps[depth], [key for place in parents for key in self._children(place)])
        if near is None:
            return None
        shorter = [*steps[:depth], near]
        meant = ".".join([*shorter, *steps[depth + 1 :]])
        found = meant if self.find(meant) else ".".join(shorter)
        return re.sub(r"\.(\d+)(?=\.|$)", r"[\1]", found)

    def _deepest(self, steps: list[str]) -> tuple[list[Place], int]:
        """Return the deepest entries with children to which the steps lead, and the number of these steps."""
        for depth in range(len(steps) - 1, -1, -1):
            found = list(self._matches(Place((), self.scenario), steps[:depth]))
            if any(self._children(place) for place in found):
                return found, depth
        return [], 0

    def _matches(self, place: Place, steps: list[str]) -> Iterator[Place]:
        if not steps:
            yield place
            return
        seen: set[Location] = set()
        for key, child in self._children(place).items():
            for length in range(1, len(steps) + 1):  # a name may contain a full stop
                if child.at not in seen and fnmatchcase(key, ".".join(steps[:length])):
                    for match in self._matches(child, steps[length:]):
                        seen.add(child.at)
                        yield match

    def _children(self, place: Place) -> dict[str, Place]:
        value = place.value
        if isinstance(value, Part):
            return self._of_part(place, value)
        if isinstance(value, Mapping):
            return {str(key): place.inner(key, entry) for key, entry in value.items()}
        if isinstance(value, (list, tuple)):
            found = {str(i): place.inner(i, entry) for i, entry in enumerate(value)}
            named = {str(entry.name): place.inner(i, entry) for i, entry in enumerate(value)
                     if isinstance(getattr(entry, "name", None), str)}  # fmt: skip
            return found | named
        return {}

    def _of_part(self, place: Place, part: Part) -> dict[str, Place]:
        """Return the fields of a part by key.

        The values of joints and links cover all joints and links of the robot. ``links`` of a bus or an arm
        is left out.
        """
        plain = part.model_dump(mode="json", by_alias=True)
        found = {}
        for key, name in _names(type(part)).items():
            value = getattr(part, name)
            at = (*place.at, key)
            if isinstance(part, InitialState) and key in ("joints", "joint_rates"):
                found[key] = self._joints(part, key, at)
                continue
            if isinstance(part, PlainRobot) and key == "links" and part.rigid_body is None:
                if place.at[-1:] != ("robot",):  # a bus, or an arm
                    continue
                value = self._all_links(_system(at))
            found[key] = Place(at, value, type(part), key, (), plain.get(key))
        return found

    def _joints(self, initial: InitialState, key: str, at: Location) -> Place:
        """Return the entry that contains the values of all joints of an initial state, by joint name."""
        model = self.models[_system(at)]
        default = np.array(model.neutral(), dtype=np.float64)[JOINTS_Q]
        default = default if key == "joints" else np.zeros_like(default)
        values = joint_values(key, getattr(initial, key), default, model)
        by_name = dict(zip(model.joint_names, map(float, values), strict=True))
        return Place(at, by_name, InitialState, key, (), by_name, model)

    def _all_links(self, system: str) -> dict[str, Any]:
        if system not in self._links:
            self._links[system] = link_inertias(self.models[system])
        return self._links[system]


def _system(at: Location) -> str:
    """Return the name of the system that contains an entry; ``""`` for a scenario with one robot."""
    return str(at[1]) if at[0] == "systems" else ""


def _steps(path: str) -> list[str]:
    """Return the keys of a path; an index in brackets is a key: ``a[0].b`` gives ``a``, ``0`` and ``b``."""
    text = re.sub(r"\[(\d+|\*)\]", r".\1", path)
    return [step for step in text.split(".") if step]
