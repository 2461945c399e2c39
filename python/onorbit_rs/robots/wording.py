"""Names of options in messages: those of Python, the command line or, for robot files, the scenario."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from contextvars import ContextVar
from dataclasses import dataclass


@dataclass(frozen=True)
class Wording:
    """Name of the option for folders of ROS packages, and format of the option for a xacro argument."""

    packages: str
    _argument: str

    def argument(self, name: str) -> str:
        """Return the option that sets the xacro argument ``name``, for messages."""
        return self._argument.replace("NAME", name)


PYTHON = Wording("package_paths=", "xacro_arguments={'NAME': ...}")
COMMAND_LINE = Wording("--package-path", "--arg NAME=VALUE")

_current: ContextVar[Wording] = ContextVar("wording", default=PYTHON)


def wording() -> Wording:
    """Return the wording for the current caller; the default is the wording for Python."""
    return _current.get()


def option(command_line: str, python: str) -> str:
    """Return the name of an option for the current caller: on the command line, or as a Python argument."""
    return command_line if wording() is COMMAND_LINE else python


@contextmanager
def worded(by: Wording) -> Iterator[None]:
    """Use this wording for messages within the block."""
    token = _current.set(by)
    try:
        yield
    finally:
        _current.reset(token)
