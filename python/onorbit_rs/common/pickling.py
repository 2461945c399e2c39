"""Creates objects of the engine from a pickle."""

from __future__ import annotations

from typing import Any


def rebuild(constructor: str, arguments: tuple[Any, ...], keywords: dict[str, Any]) -> Any:
    """Return the result of an engine constructor, given by its name, such as ``Kepler.from_state``."""
    from onorbit_rs import _core

    function: Any = _core
    for name in constructor.split("."):
        function = getattr(function, name)
    return function(*arguments, **keywords)
