"""Part of a scenario that names a class written in Python by the user."""

from __future__ import annotations

from typing import Any, ClassVar

from pydantic import Field, model_validator

from onorbit_rs.exceptions import OnOrbitError
from onorbit_rs.scenario.errors import invalid
from onorbit_rs.scenario.fields import FilePath
from onorbit_rs.scenario.part import Part


class UserClass(Part):
    """Part that names a user-defined class, whose file or module is executed."""

    role: ClassVar[str]
    """Word for an object of the class in messages: ``controller`` or ``effect``."""
    method: ClassVar[str]
    """Method that the class must define, with its arguments."""
    result: ClassVar[str]
    """Description of the value that this method must return, for messages."""
    error: ClassVar[type[OnOrbitError]]
    """Class of the error that is raised if the file, the module or the class is invalid."""

    file: FilePath | None = None
    """Python file, relative to the scenario."""
    module: str | None = None
    """Name of a Python module to import, as an alternative to ``file``."""
    class_: str = Field(alias="class")
    """Name of the class in the file or module."""
    arguments: dict[str, Any] = Field(default_factory=dict)
    """Keyword arguments of the constructor of the class."""

    @property
    def method_name(self) -> str:
        """Name of the method that the class must define."""
        return self.method.partition("(")[0]

    @model_validator(mode="after")
    def _has_one_source(self) -> UserClass:
        if (self.file is None) == (self.module is None):
            given = "none" if self.file is None else "both"
            raise invalid(
                f"give exactly one of 'file' (relative to the scenario) and 'module'; given: {given}"
            )
        return self
