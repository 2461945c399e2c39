"""Errors of classes written in Python, raised when their source is inspected or executed."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from typing import TYPE_CHECKING

from onorbit_rs.common.suggestions import did_you_mean
from onorbit_rs.exceptions import NotFoundError, OnOrbitError

if TYPE_CHECKING:
    from onorbit_rs.scenario.user_code.part import UserClass


def no_python(part: UserClass, file: str) -> OnOrbitError:
    """Return the error for a file whose name does not end in ``.py``."""
    return part.error(f"{file} is not a Python file: its name must end in .py", name="file", got=file)


def no_class(part: UserClass, source: str, classes: Iterable[str]) -> OnOrbitError:
    """Return the error for a file or module that does not define the class."""
    known = list(classes)
    hint = did_you_mean(part.class_, known) or "; add it, or correct 'class'"
    message = f"{source} has no class {part.class_!r}{hint}"
    return part.error(message, name="class", got=part.class_, expected=known)


def no_method(part: UserClass, source: str) -> OnOrbitError:
    """Return the error for a class without the method that it must define."""
    return part.error(
        f"{part.class_} of {source} has no method {part.method}, which must return {part.result}; add it",
        name="class",
        got=part.class_,
    )


def is_abstract(part: UserClass, source: str, missing: Sequence[str]) -> OnOrbitError:
    """Return the error for a class that lacks abstract methods of its bases, named ``missing``."""
    return part.error(
        f"{part.class_} of {source} is abstract: it does not define {', '.join(missing)}; define what is "
        "missing, or give another class",
        name="class",
        got=part.class_,
    )


def no_module(part: UserClass) -> NotFoundError:
    """Return the error for a module that cannot be found."""
    return NotFoundError(
        f"module {part.module!r} cannot be found; install it, or give the path of a Python file as 'file' "
        "instead",
        path=part.module,
        kind=part.role,
    )
