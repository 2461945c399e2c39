"""Controllers written in Python by the user."""

from __future__ import annotations

from pathlib import Path
from typing import Any, Literal

from pydantic import Field, model_validator

from onorbit_rs import _core
from onorbit_rs.scenario.control.control import TaskControl
from onorbit_rs.scenario.control.law import Law
from onorbit_rs.scenario.control.python_object import create_controller
from onorbit_rs.scenario.control.python_source import inspect_source
from onorbit_rs.scenario.errors import invalid
from onorbit_rs.scenario.fields import FilePath


class PythonController(Law):
    """User-defined class with ``update(t, state)``; its file or module is executed."""

    kind: Literal["python"] = "python"
    file: FilePath | None = None
    """Python file, relative to the scenario."""
    module: str | None = None
    """Name of a Python module to import, as an alternative to ``file``."""
    class_: str = Field(alias="class")
    """Name of the controller class in the file or module."""
    arguments: dict[str, Any] = Field(default_factory=dict)
    """Keyword arguments of the constructor of the class."""

    @model_validator(mode="after")
    def _has_one_source(self) -> PythonController:
        if (self.file is None) == (self.module is None):
            given = "none" if self.file is None else "both"
            raise invalid(
                f"give exactly one of 'file' (relative to the scenario) and 'module'; given: {given}"
            )
        return self

    def build_law(self, model: _core.Model, tool: str | None, folder: Path, *, runs_code: bool = True) -> Any:
        """Return a new object of the user's class, or a placeholder if ``runs_code`` is False."""
        return create_controller(self, folder) if runs_code else inspect_source(self, folder)


class PythonControl(PythonController, TaskControl):
    """User-defined class that returns one effort per joint of a joint group, and may track a tool."""
