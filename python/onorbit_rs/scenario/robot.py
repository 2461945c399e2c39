"""The robot: a bundled name, a URDF or xacro file, one rigid body written in place, or a bus with arms."""

from __future__ import annotations

from typing import Annotated, Any, ClassVar, Self

from pydantic import (
    BeforeValidator,
    Field,
    SerializerFunctionWrapHandler,
    model_serializer,
    model_validator,
)

from onorbit_rs import robots
from onorbit_rs.scenario.fields import FilePath, Inertia, Length3, Mass, Positive
from onorbit_rs.scenario.part import Part
from onorbit_rs.scenario.refusals import shown, wrong
from onorbit_rs.scenario.task_frame import Pose


def _from_diagonal(value: Any) -> Any:
    if isinstance(value, list) and len(value) == 3:
        rows = [isinstance(entry, list) for entry in value]
        if not any(rows):
            return [
                [entry if row == column else 0.0 for column in range(3)] for row, entry in enumerate(value)
            ]
        if all(rows) and all(len(row) == 3 for row in value):
            return value
    raise wrong("an inertia is three numbers (a diagonal) or a 3 x 3 matrix")


InertiaMatrix = Annotated[list[list[Inertia]], BeforeValidator(_from_diagonal)]


class RigidBody(Part):
    """A spacecraft without joints; its body is ``base``, its origin the centre of mass."""

    mass: Annotated[Mass, Positive]
    inertia: InertiaMatrix
    """(3, 3), kg m², about the centre of mass, body axes; three numbers are a diagonal."""


def _argument(value: Any) -> Any:
    if isinstance(value, (str, bool, int, float)):
        return value
    raise wrong(f"an argument of xacro is text, a number, true or false, not {shown(value)}")


XacroArgument = Annotated[str | bool | int | float, BeforeValidator(_argument)]


class LinkValues(Part):
    """Inertial values that replace those of the file; values not given keep those of the file."""

    mass: Annotated[Mass, Positive] | None = None
    com: Length3 | None = None
    """Centre of mass in link axes."""
    inertia: InertiaMatrix | None = None
    """(3, 3), kg m², about the centre of mass in link axes; three numbers are a diagonal."""

    @property
    def given(self) -> dict[str, Any]:
        """The given values as keyword arguments of ``Model.with_link``."""
        return self.model_dump(exclude_none=True)


class PlainRobot(Part):
    """Exactly one of ``bundled``, ``urdf`` and ``rigid_body``."""

    bundled: str | None = None
    urdf: FilePath | None = None
    rigid_body: RigidBody | None = None
    package_paths: list[FilePath] = Field(default_factory=list)
    """Folders in which ``package://`` and xacro's ``$(find ...)`` are looked up."""
    xacro_arguments: dict[str, XacroArgument] = Field(default_factory=dict)
    """What ``$(arg name)`` gives in a xacro file."""
    xacro: bool = False
    """Whether to expand a file that is not named ``.xacro``."""
    links: dict[str, LinkValues] = Field(default_factory=dict)
    """Mass, centre of mass and inertia that replace those of the file, by the name of the link."""

    sources: ClassVar[tuple[str, ...]] = ("bundled", "urdf", "rigid_body")

    @model_validator(mode="before")
    @classmethod
    def _from_text(cls, value: Any) -> Any:
        """``humanoid_torso`` is a bundled name; ``arms/my_arm.urdf`` is a path, relative to the YAML."""
        if not isinstance(value, (str, dict, Part)):
            raise wrong(
                f"must be a bundled name, a path of a URDF, or a mapping with {cls._listed('or')}, "
                f"not {shown(value)}"
            )
        if not isinstance(value, str):
            return value
        return {"urdf": value} if robots.is_file(value) else {"bundled": value}

    @model_validator(mode="after")
    def _exactly_one(self) -> Self:
        given = [name for name in self.sources if getattr(self, name) is not None]
        if len(given) != 1:
            raise wrong(f"give exactly one of {self._listed('and')}; given: {', '.join(given) or 'none'}")
        if self.urdf is None and (self.package_paths or self.xacro_arguments or self.xacro):
            raise wrong("'package_paths', 'xacro_arguments' and 'xacro' belong to a 'urdf'")
        if self.rigid_body is not None and self.links:
            raise wrong("'links' change the robot of a file; write the values of a 'rigid_body' there")
        return self

    @classmethod
    def _listed(cls, last: str) -> str:
        """``'bundled', 'urdf' and 'rigid_body'``."""
        *some, end = cls.sources
        return f"{', '.join(map(repr, some))} {last} {end!r}"

    @model_serializer(mode="wrap")
    def _without_empty_parts(self, handler: SerializerFunctionWrapHandler) -> dict[str, Any]:
        """Omit empty and false entries."""
        return {key: value for key, value in handler(self).items() if value not in ({}, [], "", False)}


def _printable(value: Any) -> Any:
    if isinstance(value, str) and not value.isprintable():
        raise wrong(f"{shown(value)} has characters that no name has")
    return value


Name = Annotated[str, BeforeValidator(_printable)]


class Arm(PlainRobot):
    """A robot attached to a frame of the bus."""

    at: Name
    """Link or frame of the bus to attach to."""
    frame: Name | None = None
    """Mounting frame of the arm, fixed to its base. Defaults to its root link."""
    pose: Pose | None = None
    """Pose of the mounting frame in ``at``."""
    prefix: Name = ""
    """Prefix for the names of the arm's links, joints and frames."""


class Robot(PlainRobot):
    """Exactly one of ``bundled``, ``urdf``, ``rigid_body`` and ``bus``."""

    bus: PlainRobot | None = None
    """The robot that carries ``arms``, specified like any robot. Its base is that of the combined robot."""
    arms: Annotated[list[Arm], Field(min_length=1)] | None = None

    sources: ClassVar[tuple[str, ...]] = ("bundled", "urdf", "rigid_body", "bus")

    @model_validator(mode="before")
    @classmethod
    def _arms_have_a_bus(cls, value: Any) -> Any:
        if not isinstance(value, dict):
            return value
        has_bus, has_arms = value.get("bus") is not None, value.get("arms") is not None
        if has_arms and not has_bus:
            raise wrong("'arms' belong to a 'bus': name the robot that carries them there")
        if has_bus and not has_arms:
            raise wrong("a 'bus' carries 'arms': list at least one, each {urdf: FILE, at: FRAME}")
        return value
