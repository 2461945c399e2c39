"""How a part of a scenario says what is wrong with it."""

from __future__ import annotations

from typing import TYPE_CHECKING

from pydantic_core import PydanticCustomError

if TYPE_CHECKING:
    from onorbit_rs.scenario.yaml_lines import Location


def wrong(message: str) -> PydanticCustomError:
    """A complaint about the part that is being checked."""
    return PydanticCustomError("wrong", "{message}", {"message": message})


def unknown_key(key: str, hint: str) -> PydanticCustomError:
    """A complaint about a key of the part that is being checked."""
    return PydanticCustomError("unknown_key", "unknown key{hint}", {"key": key, "hint": hint})


def misfit(at: str | Location, message: str) -> PydanticCustomError:
    """A complaint about parts that do not fit each other, at the place that is to be mended."""
    where = (at,) if isinstance(at, str) else at
    return PydanticCustomError("misfit", "{message}", {"message": message, "at": where})


def shown(value: object) -> str:
    """What was found, on one line and not a long one; an entry that is left empty is nothing."""
    if value is None:
        return "nothing"
    text = repr(value)
    return text if len(text) <= 60 else f"{text[:57]}..."
