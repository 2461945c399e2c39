"""Creates robots from a pickle."""

from __future__ import annotations

import warnings
from typing import TYPE_CHECKING, Any

from onorbit_rs.common.pickling import rebuild
from onorbit_rs.exceptions import ModelError
from onorbit_rs.robots.fingerprint import has_changed

if TYPE_CHECKING:
    from onorbit_rs._core import Model


def rebuild_robot(
    constructor: str, arguments: tuple[Any, ...], keywords: dict[str, Any], fingerprint: str
) -> Model:
    """Return the pickled robot, read again from its description.

    Raises
    ------
    ModelError
        If the description has changed since the robot was pickled.
    NotFoundError, ReadError
        If the file of the description does not exist or cannot be read.
    """
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")  # these warnings were issued when the description was first read
        model: Model = rebuild(constructor, arguments, keywords)
    if has_changed(model, fingerprint):
        path = keywords.get("path")
        raise ModelError(
            f"{path or 'the description'} no longer describes the pickled robot; undo its changes and "
            "those of the files that it includes, or load the robot again and pickle the new one",
            path=path and str(path),
        )
    return model
