"""How objects of the engine come back from a pickle."""

from __future__ import annotations

from typing import Any


def rebuild(constructor: str, arguments: tuple[Any, ...], keywords: dict[str, Any]) -> Any:
    """Call a constructor of the engine by its name: ``Kepler``, ``Kepler.from_state``, ..."""
    from onorbit_rs import _core

    made: Any = _core
    for name in constructor.split("."):
        made = getattr(made, name)
    return made(*arguments, **keywords)
