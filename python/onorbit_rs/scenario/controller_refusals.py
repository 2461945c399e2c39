"""Why a controller in Python is refused, whether its source was read or executed."""

from __future__ import annotations

from collections.abc import Iterable

from onorbit_rs.exceptions import ControlError, NotFoundError
from onorbit_rs.names import did_you_mean


def no_python(file: str) -> ControlError:
    """Of a file by its name."""
    return ControlError(f"{file} is not a Python file: its name must end in .py", name="file", got=file)


def no_class(name: str, source: str, classes: Iterable[str]) -> ControlError:
    """Of a file or module that has other classes."""
    known = list(classes)
    hint = did_you_mean(name, known)
    return ControlError(f"{source} has no class {name!r}{hint}", name="class", got=name, expected=known)


def no_update(name: str, source: str) -> ControlError:
    """Of a class that is no controller."""
    return ControlError(
        f"{name} of {source} has no update(t, state): give it one that returns the efforts",
        name="class",
        got=name,
    )


def no_module(name: str) -> NotFoundError:
    """Of a module that Python does not find."""
    return NotFoundError(
        f"no module {name!r} can be imported: install it, or give a 'file' beside the scenario",
        path=name,
        kind="controller",
    )
