"""Reports the unknown keys of a part of a scenario together with the errors of its other keys."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import Any, TypeVar, get_args

from pydantic import ValidationError
from pydantic_core import ErrorDetails, InitErrorDetails, PydanticCustomError, core_schema

from onorbit_rs.scenario.errors import unknown_key

T = TypeVar("T")
_KINDS = frozenset(get_args(core_schema.ErrorType))
"""Types of error that pydantic can raise again by their names; all others are custom errors."""


def without_unknown_keys(value: Any, unknown: Mapping[Any, str], validate: Callable[[Any], T]) -> T:
    """Return the validated mapping; if it has unknown keys, raise their errors and those of the other keys.

    ``unknown`` contains the end of the message about each unknown key. Errors that an unknown key can have
    caused are omitted: contradictions between keys, and the missing key that it probably stands for.
    """
    if not unknown:
        return validate(value)
    errors = [
        InitErrorDetails(type=unknown_key(str(key), hint), input=value) for key, hint in unknown.items()
    ]
    try:
        validate({key: entry for key, entry in value.items() if key not in unknown})
    except ValidationError as error:
        for details in error.errors(include_url=False):
            at = [step for step in details["loc"] if step in value]
            is_meant = details["type"] == "missing" and any(
                repr(details["loc"][-1]) in hint for hint in unknown.values()
            )
            if (at or details["type"] in ("missing", "unknown_key")) and not is_meant:
                errors.append(_again(details))
    raise ValidationError.from_exception_data("part", errors)


def _again(details: ErrorDetails) -> InitErrorDetails:
    """Return an error in the form in which it can be raised again."""
    kind, context = details["type"], details.get("ctx", {})
    if kind not in _KINDS:
        custom = PydanticCustomError(kind, "{message}", {**context, "message": details["msg"]})
        return InitErrorDetails(type=custom, loc=details["loc"], input=details["input"])
    return InitErrorDetails(type=kind, loc=details["loc"], input=details["input"], ctx=context)
