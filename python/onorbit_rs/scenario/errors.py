"""Validation errors of the parts of a scenario."""

from __future__ import annotations

from typing import TYPE_CHECKING

from pydantic_core import PydanticCustomError

if TYPE_CHECKING:
    from onorbit_rs.scenario.yaml_lines import Location


def invalid(message: str) -> PydanticCustomError:
    """Return a validation error for the part of the scenario that is being validated."""
    return PydanticCustomError("invalid", "{message}", {"message": message})


def unknown_key(key: str, hint: str) -> PydanticCustomError:
    """Return the error for an unknown key in the part of the scenario that is being validated."""
    return PydanticCustomError("unknown_key", "unknown key{hint}", {"key": key, "hint": hint})


def inconsistent(at: str | Location, message: str) -> PydanticCustomError:
    """Return the error for an invalid entry, or for contradictory entries; ``at`` is the entry to correct."""
    where = (at,) if isinstance(at, str) else at
    return PydanticCustomError("inconsistent", "{message}", {"message": message, "at": where})


def shortened(value: object) -> str:
    """Return a value as one line of at most 60 characters for messages; ``nothing`` for an empty entry."""
    if value is None:
        return "nothing"
    text = repr(value)
    return text if len(text) <= 60 else f"{text[:57]}..."
