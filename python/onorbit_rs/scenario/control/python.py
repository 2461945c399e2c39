"""Controllers written in Python by the user."""

from __future__ import annotations

from pathlib import Path
from typing import Any, ClassVar, Literal

from onorbit_rs import _core
from onorbit_rs.exceptions import ControlError, OnOrbitError
from onorbit_rs.scenario.control.control import TaskControl
from onorbit_rs.scenario.control.law import Law
from onorbit_rs.scenario.user_code import UserClass, create_object, inspect_source


class PythonController(UserClass, Law):
    """User-defined class with ``update(t, state)``; its file or module is executed."""

    role: ClassVar[str] = "controller"
    method: ClassVar[str] = "update(t, state)"
    result: ClassVar[str] = "the efforts"
    error: ClassVar[type[OnOrbitError]] = ControlError

    kind: Literal["python"] = "python"

    def build_law(self, model: _core.Model, tool: str | None, folder: Path, *, runs_code: bool = True) -> Any:
        """Return a new object of the user's class, or a placeholder if ``runs_code`` is False."""
        return create_object(self, folder) if runs_code else inspect_source(self, folder)


class PythonControl(PythonController, TaskControl):
    """User-defined class that returns one effort per joint of a joint group, and may track a tool."""
