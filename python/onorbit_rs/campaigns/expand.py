"""Finds the entries that ``vary`` names, and checks distributions against them."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from itertools import pairwise
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
from pydantic import ValidationError

from onorbit_rs.campaigns.dispersions import (
    ChoiceDispersion,
    DirectionDispersion,
    Dispersion,
    FactorDispersion,
    NumberDispersion,
    RotationDispersion,
    changed,
)
from onorbit_rs.campaigns.distributions import Amount, Change, Distribution, amount
from onorbit_rs.campaigns.places import Place, Places, adapter
from onorbit_rs.exceptions import OnOrbitError, QuantityError
from onorbit_rs.scenario import units
from onorbit_rs.scenario.attitude import quaternion_of
from onorbit_rs.scenario.errors import shortened
from onorbit_rs.scenario.joint_values import joint_values
from onorbit_rs.scenario.locations import dotted, scenario_error
from onorbit_rs.scenario.part import Part
from onorbit_rs.scenario.units import parse_quantity
from onorbit_rs.scenario.validation_errors import first_error
from onorbit_rs.scenario.yaml_lines import Lines, line_of

if TYPE_CHECKING:
    from onorbit_rs.scenario.load import AnyScenario
    from onorbit_rs.scenario.yaml_lines import Location

_SAMPLE = 0.37
"""Cumulative probability of the sample value that is validated for every dispersed entry."""


class Expander:
    """Converts the changes of a campaign to dispersions of the entries of its scenario."""

    def __init__(self, scenario: AnyScenario, file: Path | None, lines: Lines) -> None:
        """Store the scenario, and the file and lines of the campaign for messages."""
        self.places = Places(scenario)
        self.file, self.lines = file, lines

    def expand(self, vary: dict[str, Change]) -> list[Dispersion]:
        """Return the dispersions of all entries, in the order of the file.

        Raises
        ------
        ScenarioError
            If a path names no entry, an entry is varied twice, or a change does not fit an entry.
        """
        found = [
            (path, dispersion)
            for path, change in vary.items()
            for place in self._places(path, change)
            for dispersion in self._of_place(path, place, change)
        ]
        self._check_apart([(dispersion.at, path) for path, dispersion in found])
        return [dispersion for _, dispersion in found]

    def _places(self, path: str, change: Change) -> list[Place]:
        places = self.places.find(path)
        if not places:
            known = self.places.known(path)
            near = self.places.nearest(path)
            few = f"; known entries: {', '.join(known)}" if 0 < len(known) <= 16 else ""
            raise self.error(path, f"the scenario has no such entry{_hint(near) or few}")
        if "*" in path:
            given = [place for place in places if place.value is not None]
            if not given:
                raise self.error(
                    path,
                    "no matching entry has a value in the scenario; give the path of one entry, without '*', "
                    "and use 'set'",
                )
            return given
        if places[0].value is None and change.how != "set" and not places[0].is_attitude:
            raise self.error(
                path, f"the entry has no value in the scenario that '{change.how}' could change; use 'set'"
            )
        return places

    def _check_apart(self, found: list[tuple[Location, str]]) -> None:
        """Raise an error if two dispersions change the same entry, or one changes a part of the other's."""
        ordered = sorted(found, key=lambda one: tuple(map(str, one[0])))
        for (outer, first), (inner, second) in pairwise(ordered):
            if inner[: len(outer)] == outer:
                which = f"'{first}' and '{second}'" if first != second else f"'{first}' twice"
                raise self.error(second, f"{dotted(inner)} is varied by {which}; keep one of them")

    def error(self, path: str, message: str) -> OnOrbitError:
        """Return an error located at a path of ``vary``."""
        at = ("campaign", "vary", path)
        return scenario_error(message, self.file, line_of(at, self.lines), dotted(at))

    def _of_place(self, path: str, place: Place, change: Change) -> Iterator[Dispersion]:
        """Yield the dispersions of one entry."""
        how, distribution, value = change.how, change.distribution, place.value
        if how == "set" and distribution.choice is not None:
            choice = [self._valid(path, place, entry) for entry in distribution.choice]
            yield ChoiceDispersion(place.at, (place.name,), Distribution(choice=choice))
        elif place.is_attitude:
            yield self._attitude(path, place, change)
        elif _is_matrix(value):
            yield self._inertia(path, place, change)
        elif isinstance(value, Part):
            keys = ", ".join(type(value).yaml_keys())
            raise self.error(path, f"the entry is a section; vary one of its entries: {keys}")
        elif isinstance(value, (list, dict)):
            yield from self._vector(path, place, change)
        elif value is None or _is_number(value):
            yield self._number(path, place, change)
        else:
            raise self.error(
                path,
                f"the entry is {shortened(value)}, not a number; only 'set: {{choice: [...]}}' applies to it",
            )

    def _vector(self, path: str, place: Place, change: Change) -> Iterator[Dispersion]:
        """Yield one dispersion per component, or one for the whole vector."""
        value = place.value
        entries = list(value.items() if isinstance(value, dict) else enumerate(value))
        if not entries:
            raise self.error(
                path,
                "the entry is empty in the scenario; give it values there, or vary it with "
                "'set: {choice: [...]}'",
            )
        if not all(_is_number(entry) for _, entry in entries):
            raise self.error(
                path,
                f"the entry is {shortened(value)}, not a vector of numbers; vary one of its entries, or "
                "vary it with 'set: {choice: [...]}'",
            )
        leaves = [place.inner(step, entry) for step, entry in entries]
        if change.vector == "components":
            for leaf in leaves:
                yield self._number(path, leaf, change)
            return
        if isinstance(value, dict):
            raise self.error(
                path, "'vector: direction' applies only to lists, but the entry is a mapping; omit 'vector'"
            )
        if len(value) != 3 and change.how != "scale":
            raise self.error(
                path,
                f"'vector: direction' with '{change.how}' requires three components, but the entry has "
                f"{len(value)}; omit 'vector', or use 'scale'",
            )
        names = tuple(leaf.name for leaf in leaves)
        distribution = self._numeric(path, change)
        if change.how == "scale":
            yield FactorDispersion(place.at, (place.name,), distribution, list(value))
            return
        for leaf in leaves:
            self._check_units(path, leaf, change)
        yield DirectionDispersion(place.at, names, distribution, change.how, tuple(map(float, value)))

    def _number(self, path: str, place: Place, change: Change) -> Dispersion:
        how, nominal = change.how, float(place.value or 0.0)
        distribution = self._numeric(path, change)
        self._check_units(path, place, change)
        values = list(distribution.choice or [*(distribution.bounds or ()), distribution.value(_SAMPLE)])
        for value in values:
            self._valid(path, place, changed(how, nominal, float(value)))
        return NumberDispersion(place.at, (place.name,), distribution, how, nominal)

    def _inertia(self, path: str, place: Place, change: Change) -> Dispersion:
        """Return the dispersion of an inertia by one factor, which keeps the inertia physical."""
        if change.how != "scale":
            raise self.error(
                path,
                f"{_without_choice(change)} does not apply to an inertia; use 'scale', which keeps it "
                "physical, or 'set' with 'choice'",
            )
        distribution = self._numeric(path, change)
        for bound in distribution.choice or distribution.bounds or ():
            if float(bound) <= 0.0:
                raise self.error(path, f"the factor of an inertia is {float(bound):g}; it must be above zero")
        return FactorDispersion(place.at, (place.name,), distribution, place.value)

    def _attitude(self, path: str, place: Place, change: Change) -> Dispersion:
        if change.how != "add":
            raise self.error(
                path,
                f"{_without_choice(change)} does not apply to an attitude; use 'add' with a distribution of "
                "the angle about each body axis, or 'set' with 'choice'",
            )
        distribution = self._numeric(path, change)
        for number in [*distribution.amounts, *(distribution.choice or ())]:
            self._parsed(path, number, units.ANGLE)
        names = tuple(f"{place.name}[{axis}]" for axis in range(3))
        quat = tuple(map(float, quaternion_of(place.value)))
        return RotationDispersion(place.at, names, distribution, quat, change.vector == "direction")

    def _numeric(self, path: str, change: Change) -> Distribution:
        """Return the distribution of a change; check that ``choice`` has numbers and factors have no unit."""
        distribution = change.distribution
        if distribution.choice is not None:
            try:
                numbers = [amount(value) for value in distribution.choice]
            except QuantityError as error:
                raise self.error(path, f"'{change.how}' requires numbers: {error}") from None
            distribution = Distribution(choice=numbers)
        if change.how == "scale":
            for number in [*distribution.amounts, *(distribution.choice or ())]:
                self._parsed(path, number, units.NUMBER)
        return distribution

    def _parsed(self, path: str, number: Amount, dimension: units.Dimension) -> None:
        try:
            parse_quantity(number.written if number.unit else float(number), dimension)
        except QuantityError as error:
            raise self.error(path, str(error)) from None

    def _check_units(self, path: str, place: Place, change: Change) -> None:
        """Raise an error if a unit of the distribution does not fit the entry."""
        if change.how == "scale":
            return
        distribution = change.distribution
        numbers = [*distribution.amounts, *(amount(value) for value in distribution.choice or ())]
        first = {number.unit: number for number in reversed(numbers) if number.unit}
        for number in first.values():
            self._validated(path, place, number.written, is_about=_is_about_units)

    def _valid(self, path: str, place: Place, value: Any) -> Any:
        """Return a value of an entry in SI after validating it; raise ScenarioError if it is invalid."""
        found = self._validated(path, place, value)
        for step in place.inside:
            found = found[step]
        return found

    def _validated(
        self, path: str, place: Place, value: Any, is_about: Callable[[Exception], bool] = lambda _: True
    ) -> Any:
        """Validate the field of an entry with a new value of the entry; return the plain value of the field.

        If ``is_about`` returns False for all causes of a ValidationError, the error is ignored, and the value
        is returned without validation.
        """
        owner, candidate = place.owner, place.candidate(value)
        assert owner is not None
        fields = adapter(owner, place.key)
        at = ("campaign", "vary", path)
        try:
            found = fields.validate_python(candidate)
            if place.model is not None:
                zeros = np.zeros(len(place.model.joint_names))
                joint_values(place.key, found, zeros, place.model)
        except ValidationError as error:
            causes = [details.get("ctx", {}).get("error", error) for details in error.errors()]
            if any(map(is_about, causes)):
                raise first_error(error, candidate, self.file, self.lines, lambda *_: at) from None
            return candidate
        except OnOrbitError as error:
            raise self.error(path, str(error)) from None
        return fields.dump_python(found, mode="json", by_alias=True, exclude_none=True)


def _without_choice(change: Change) -> str:
    """Return the name of a change for messages about entries for which only ``choice`` can be set."""
    return "'set' without 'choice'" if change.how == "set" else f"'{change.how}'"


def _is_about_units(error: Exception) -> bool:
    """Return True for an error about the dimension of a quantity, not about its value."""
    return isinstance(error, QuantityError) and str(error.expected).startswith(("a ", "an "))


def _hint(near: str | None) -> str:
    return f"; did you mean {near!r}?" if near else ""


def _is_number(value: Any) -> bool:
    return isinstance(value, (int, float)) and not isinstance(value, bool)


def _is_matrix(value: Any) -> bool:
    return isinstance(value, list) and len(value) == 3 and all(isinstance(row, list) for row in value)
