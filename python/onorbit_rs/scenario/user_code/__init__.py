"""Classes written in Python by the user, which a scenario names by file or module."""

from __future__ import annotations

from onorbit_rs.scenario.user_code.object import create_object
from onorbit_rs.scenario.user_code.part import UserClass
from onorbit_rs.scenario.user_code.source import Placeholder, inspect_source, source_of

__all__ = ["Placeholder", "UserClass", "create_object", "inspect_source", "source_of"]
