"""Errors of controllers written in Python, raised when their source is inspected or executed."""

from __future__ import annotations

from collections.abc import Iterable

from onorbit_rs.common.suggestions import did_you_mean
from onorbit_rs.exceptions import ControlError, NotFoundError


def no_python(file: str) -> ControlError:
    """Return the error for a file whose name does not end in ``.py``."""
    return ControlError(f"{file} is not a Python file: its name must end in .py", name="file", got=file)


def no_class(name: str, source: str, classes: Iterable[str]) -> ControlError:
    """Return the error for a file or module that does not define the class ``name``."""
    known = list(classes)
    hint = did_you_mean(name, known)
    return ControlError(f"{source} has no class {name!r}{hint}", name="class", got=name, expected=known)


def no_update(name: str, source: str) -> ControlError:
    """Return the error for a class without the method ``update``."""
    return ControlError(
        f"{name} of {source} has no method update(t, state), which must return the efforts; add it",
        name="class",
        got=name,
    )


def no_module(name: str) -> NotFoundError:
    """Return the error for a module that cannot be found."""
    return NotFoundError(
        f"module {name!r} cannot be found; install it, or give the path of a Python file as 'file' instead",
        path=name,
        kind="controller",
    )
