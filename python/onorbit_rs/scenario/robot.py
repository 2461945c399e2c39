"""The robot: a bundled name, a URDF or xacro file, or one rigid body written in place."""

from __future__ import annotations

from typing import Annotated, Any

from pydantic import BeforeValidator, Field, field_validator, model_validator

from onorbit_rs import robots
from onorbit_rs.scenario.fields import FilePath, Inertia, Mass, Positive
from onorbit_rs.scenario.part import Part
from onorbit_rs.scenario.refusals import shown, wrong


class RigidBody(Part):
    """A spacecraft without joints; its body is ``base``, its origin the centre of mass."""

    mass: Annotated[Mass, Positive]
    inertia: list[list[Inertia]]
    """(3, 3), kg m², about the centre of mass, body axes; three numbers are a diagonal."""

    @field_validator("inertia", mode="before")
    @classmethod
    def _from_diagonal(cls, value: Any) -> Any:
        if isinstance(value, list) and len(value) == 3:
            rows = [isinstance(entry, list) for entry in value]
            if not any(rows):
                return [
                    [entry if row == column else 0.0 for column in range(3)]
                    for row, entry in enumerate(value)
                ]
            if all(rows) and all(len(row) == 3 for row in value):
                return value
        raise wrong("an inertia is three numbers (a diagonal) or a 3 x 3 matrix")


def _argument(value: Any) -> Any:
    if isinstance(value, (str, bool, int, float)):
        return value
    raise wrong(f"an argument of xacro is text, a number, true or false, not {shown(value)}")


XacroArgument = Annotated[str | bool | int | float, BeforeValidator(_argument)]


class Robot(Part):
    """Exactly one of the three."""

    bundled: str | None = None
    urdf: FilePath | None = None
    rigid_body: RigidBody | None = None
    package_paths: list[FilePath] = Field(default_factory=list)
    """Folders in which ``package://`` and xacro's ``$(find ...)`` are looked up."""
    xacro_arguments: dict[str, XacroArgument] = Field(default_factory=dict)
    """What ``$(arg name)`` gives in a xacro file."""
    xacro: bool = False
    """Whether to expand a file that is not named ``.xacro``."""

    @model_validator(mode="before")
    @classmethod
    def _from_text(cls, value: Any) -> Any:
        """``humanoid_torso`` is a bundled name; ``arms/my_arm.urdf`` is a path, relative to the YAML."""
        if not isinstance(value, (str, dict)):
            raise wrong(
                "must be a bundled name, a path of a URDF, or a mapping with 'bundled', 'urdf' or "
                f"'rigid_body', not {shown(value)}"
            )
        if not isinstance(value, str):
            return value
        return {"urdf": value} if robots.is_file(value) else {"bundled": value}

    @model_validator(mode="after")
    def _exactly_one(self) -> Robot:
        given = [name for name in ("bundled", "urdf", "rigid_body") if getattr(self, name) is not None]
        if len(given) != 1:
            listed = ", ".join(given) or "none"
            raise wrong(f"give exactly one of 'bundled', 'urdf' and 'rigid_body'; given: {listed}")
        if self.urdf is None and (self.package_paths or self.xacro_arguments or self.xacro):
            raise wrong("'package_paths', 'xacro_arguments' and 'xacro' belong to a 'urdf'")
        return self
