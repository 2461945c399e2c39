"""Selects the element set of one satellite from a file with several sets."""

from __future__ import annotations

from collections.abc import Iterable
from typing import TypeVar

from onorbit_rs.common.counting import count
from onorbit_rs.common.suggestions import did_you_mean
from onorbit_rs.exceptions import ElementSetError

T = TypeVar("T")


def select_set(sets: Iterable[tuple[str, str, T]], satellite: str, where: str) -> T:
    """Return the element set of a satellite, by its name (case-insensitive) or catalogue number.

    Parameters
    ----------
    sets : iterable of (name, number, set)
        Element sets with the names and catalogue numbers of their satellites.
    satellite : str
        Name or catalogue number of the satellite.
    where : str
        Name of the source in messages.

    Raises
    ------
    ElementSetError
        If there is no set or more than one set of that satellite.
    """
    sets = list(sets)
    wanted = _word(satellite)
    found = [item for name, number, item in sets if wanted in (_word(name), _word(number))]
    if not found:
        hint = did_you_mean(satellite, [name or number for name, number, _ in sets]) or (
            "; give its name or catalogue number as in the file" if sets else ""
        )
        raise ElementSetError(
            f"{where} contains no element set of {satellite!r}{hint}", name="satellite", got=satellite
        )
    if len(found) > 1:
        sets_found = count(len(found), "element set", "element sets")
        numbers = {_word(number) for _, number, _ in sets if number}
        fix = (
            "remove all but one" if wanted in numbers else "remove all but one, or give the catalogue number"
        )
        raise ElementSetError(
            f"{where} contains {sets_found} of {satellite!r}; {fix}",
            name="satellite", got=satellite,
        )  # fmt: skip
    return found[0]


def _word(text: str) -> str:
    """Return a name or number for comparison: in lower case, without surrounding spaces and leading zeros."""
    return text.strip().casefold().lstrip("0")
