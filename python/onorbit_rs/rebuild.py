"""How objects of the engine come back from a pickle."""

from __future__ import annotations

import warnings
from typing import TYPE_CHECKING, Any

from onorbit_rs.exceptions import ModelError
from onorbit_rs.robots.fingerprint import is_another

if TYPE_CHECKING:
    from onorbit_rs._core import Model


def rebuild(constructor: str, arguments: tuple[Any, ...], keywords: dict[str, Any]) -> Any:
    """Call a constructor of the engine by its name: ``Kepler``, ``Kepler.from_state``, ..."""
    from onorbit_rs import _core

    made: Any = _core
    for name in constructor.split("."):
        made = getattr(made, name)
    return made(*arguments, **keywords)


def rebuild_robot(
    constructor: str, arguments: tuple[Any, ...], keywords: dict[str, Any], fingerprint: str
) -> Model:
    """The robot of this fingerprint; raises ``ModelError`` where its file is that of another by now."""
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")  # what the description is like was told when it was first read
        model: Model = rebuild(constructor, arguments, keywords)
    if is_another(model, fingerprint):
        path = keywords.get("path")
        raise ModelError(
            f"{path or 'the description'} is no longer that of the pickled robot: it, or a file it includes,"
            " was changed since; put it back, or load the robot from it anew and send that",
            path=path and str(path),
        )
    return model
