"""Effects written in Python by the user."""

from __future__ import annotations

from collections.abc import Collection
from pathlib import Path
from typing import ClassVar, Literal

import numpy as np
from numpy.typing import NDArray

from onorbit_rs import _core
from onorbit_rs.exceptions import EffectError, OnOrbitError
from onorbit_rs.scenario.user_code import UserClass, create_object, inspect_source


class PythonEffect(UserClass):
    """User-defined class with ``wrenches(t, bodies)``; its file or module is executed."""

    role: ClassVar[str] = "effect"
    method: ClassVar[str] = "wrenches(t, bodies)"
    result: ClassVar[str] = "the forces and torques on all bodies"
    error: ClassVar[type[OnOrbitError]] = EffectError

    kind: Literal["python"] = "python"

    @property
    def paths(self) -> list[tuple[tuple[str, ...], str]]:
        """Locations and values of the entries that name links; empty for this effect."""
        return []

    def of_system(self, _name: str, _systems: Collection[str]) -> None:
        """Return None, so that the scenario of a single system of a world does not contain the effect."""

    def build(self, _model: _core.Model | None, folder: Path) -> _core.Effect:
        """Return a new object of the user's class, after executing its file or module."""
        effect = create_object(self, folder)
        if not isinstance(effect, _core.Effect):
            raise EffectError(
                f"{self.class_} is not a subclass of onorbit_rs.Effect; write: "
                f"class {self.class_}(oo.Effect)",
                name="class",
                got=self.class_,
            )
        return effect

    def inspect(self, folder: Path) -> _core.Effect:
        """Return an effect without wrenches, after checking the class without executing its source."""
        inspect_source(self, folder)
        return _Placeholder()


class _Placeholder(_core.Effect):
    """Replaces an effect whose source was inspected but not executed."""

    def wrenches(self, t: float, bodies: _core.BodyStates) -> NDArray[np.float64]:
        """Return zero wrenches, (K, 6), N and N m."""
        return np.zeros((len(bodies.names), 6))
