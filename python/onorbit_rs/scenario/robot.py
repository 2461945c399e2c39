"""Robot: a bundled name, a URDF or xacro file, one rigid body, or a bus with arms."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any, ClassVar, Self

import numpy as np
from pydantic import (
    BeforeValidator,
    Field,
    SerializerFunctionWrapHandler,
    model_serializer,
    model_validator,
)

from onorbit_rs import _core, robots
from onorbit_rs.robots.wording import Wording, worded
from onorbit_rs.scenario.errors import invalid, shortened
from onorbit_rs.scenario.faults import Faults
from onorbit_rs.scenario.fields import FilePath, Inertia, Length3, Mass, Positive
from onorbit_rs.scenario.joint_properties import JointProperties
from onorbit_rs.scenario.locations import dotted, located, located_warnings
from onorbit_rs.scenario.loops import add_loops
from onorbit_rs.scenario.part import Part
from onorbit_rs.scenario.pose import Pose

if TYPE_CHECKING:
    from onorbit_rs.scenario.schema import Scenario
    from onorbit_rs.scenario.yaml_lines import Location


def _from_diagonal(value: Any) -> Any:
    if isinstance(value, list) and len(value) == 3:
        rows = [isinstance(entry, list) for entry in value]
        if not any(rows):
            return [
                [entry if row == column else 0.0 for column in range(3)] for row, entry in enumerate(value)
            ]
        if all(rows) and all(len(row) == 3 for row in value):
            return value
    raise invalid(
        f"an inertia must be three numbers (the diagonal) or a 3 x 3 matrix, not {shortened(value)}"
    )


InertiaMatrix = Annotated[list[list[Inertia]], BeforeValidator(_from_diagonal)]


class RigidBody(Part):
    """Spacecraft without joints; its only link is named ``base``, with the origin at the centre of mass."""

    mass: Annotated[Mass, Positive]
    inertia: InertiaMatrix
    """Inertia (3, 3), kg m², about the centre of mass in body axes; three numbers are its diagonal."""


def _argument(value: Any) -> Any:
    if isinstance(value, (str, bool, int, float)):
        return value
    raise invalid(f"an argument of xacro must be text, a number, true or false, not {shortened(value)}")


XacroArgument = Annotated[str | bool | int | float, BeforeValidator(_argument)]


class LinkValues(Part):
    """Inertial parameters of a link that replace those of the robot's file; each is optional."""

    mass: Annotated[Mass, Positive] | None = None
    com: Length3 | None = None
    """Centre of mass in link axes, m."""
    inertia: InertiaMatrix | None = None
    """Inertia (3, 3), kg m², about the centre of mass in link axes; three numbers are its diagonal."""

    @property
    def given(self) -> dict[str, Any]:
        """The given values as keyword arguments of ``Model.with_link``."""
        return self.model_dump(exclude_none=True)


class PlainRobot(Part):
    """Robot from exactly one of ``bundled``, ``urdf`` and ``rigid_body``."""

    bundled: str | None = None
    urdf: FilePath | None = None
    rigid_body: RigidBody | None = None
    package_paths: list[FilePath] = Field(default_factory=list)
    """Folders that are searched for ``package://`` and xacro's ``$(find ...)``."""
    xacro_arguments: dict[str, XacroArgument] = Field(default_factory=dict)
    """Values of ``$(arg name)`` in a xacro file."""
    xacro: bool = False
    """Whether to expand the file with xacro even if its name does not end in ``.xacro``."""
    links: dict[str, LinkValues] = Field(default_factory=dict)
    """Masses, centres of mass and inertias that replace those of the file, by the name of the link."""

    sources: ClassVar[tuple[str, ...]] = ("bundled", "urdf", "rigid_body")

    @model_validator(mode="before")
    @classmethod
    def _from_text(cls, value: Any) -> Any:
        """Convert text to a bundled name (``ets_vii``) or a path relative to the YAML (``arms/arm.urdf``)."""
        if not isinstance(value, (str, dict, Part)):
            raise invalid(
                f"must be a bundled name, the path of a URDF, or a mapping with {cls._listed('or')}, "
                f"not {shortened(value)}"
            )
        if not isinstance(value, str):
            return value
        return {"urdf": value} if robots.is_file(value) else {"bundled": value}

    @model_validator(mode="after")
    def _exactly_one(self) -> Self:
        given = [name for name in self.sources if getattr(self, name) is not None]
        if len(given) != 1:
            raise invalid(f"give exactly one of {self._listed('and')}; given: {', '.join(given) or 'none'}")
        if self.urdf is None:
            for name in ("package_paths", "xacro_arguments", "xacro"):
                if getattr(self, name):
                    raise invalid(f"{name!r} requires 'urdf'; add 'urdf' or omit {name!r}")
        if self.rigid_body is not None and self.links:
            raise invalid("'links' applies only to robots from files; give mass and inertia in 'rigid_body'")
        return self

    @classmethod
    def _listed(cls, last: str) -> str:
        """Return the names of the sources, such as ``'bundled', 'urdf' and 'rigid_body'``."""
        *some, end = cls.sources
        return f"{', '.join(map(repr, some))} {last} {end!r}"

    def build_plain(self, scenario: Scenario, at: Location) -> _core.Model:
        """Return the robot without attached arms; ``at`` is the location of its keys in the scenario."""
        if self.rigid_body is not None:
            with located(scenario, *at):
                return _core.Model.rigid_body(self.rigid_body.mass, np.array(self.rigid_body.inertia))
        with located(scenario, *at), worded(_wording(at)):
            return _core.Model.from_urdf(**self._file(scenario.folder))

    def build_part(self, scenario: Scenario, at: Location) -> _core.RobotPart:
        """Return the robot as a part to be attached to another robot; its root link may be massless."""
        with located(scenario, *at), worded(_wording(at)):
            return _core.RobotPart.from_urdf(**self._file(scenario.folder))

    def _file(self, folder: Path) -> dict[str, Any]:
        """Return the keyword arguments of ``Model.from_urdf`` for this robot."""
        return {
            "path": robots.path(self.bundled) if self.bundled is not None else folder / str(self.urdf),
            "package_paths": [folder / path for path in self.package_paths] or None,
            "xacro_arguments": self.xacro_arguments or None,
            "xacro": self.xacro,
            "links": {name: values.given for name, values in self.links.items()},
        }

    @model_serializer(mode="wrap")
    def _without_empty_parts(self, handler: SerializerFunctionWrapHandler) -> dict[str, Any]:
        """Return the serialized robot without empty and false entries."""
        return {key: value for key, value in handler(self).items() if value not in ({}, [], "", False)}


def _printable(value: Any) -> Any:
    if isinstance(value, str) and not value.isprintable():
        raise invalid(
            f"{shortened(value)} contains characters that cannot be printed, which are not allowed in "
            "names; remove them"
        )
    return value


Name = Annotated[str, BeforeValidator(_printable)]


class Arm(PlainRobot):
    """A robot attached to a frame of the bus."""

    at: Name
    """Link or frame of the bus to which the arm is attached."""
    frame: Name | None = None
    """Mounting frame of the arm. Default: its root link."""
    pose: Pose | None = None
    """Pose of the mounting frame in ``at``. Default: the frames coincide."""
    prefix: Name = ""
    """Prefix for the names of the arm's links, joints and frames."""


class Robot(PlainRobot):
    """Robot from exactly one of ``bundled``, ``urdf``, ``rigid_body`` and ``bus``."""

    bus: PlainRobot | None = None
    """Robot to which ``arms`` are attached; its base is the base of the combined robot."""
    arms: Annotated[list[Arm], Field(min_length=1)] | None = None
    joints: dict[str, JointProperties] = Field(default_factory=dict)
    """Damping, friction, rotor inertia and springs that replace those of the file, by name of the joint."""

    sources: ClassVar[tuple[str, ...]] = ("bundled", "urdf", "rigid_body", "bus")

    @model_validator(mode="before")
    @classmethod
    def _arms_have_a_bus(cls, value: Any) -> Any:
        if not isinstance(value, dict):
            return value
        has_bus, has_arms = value.get("bus") is not None, value.get("arms") is not None
        if has_arms and not has_bus:
            raise invalid(
                "'arms' requires 'bus', the robot to which the arms are attached; add 'bus' or omit 'arms'"
            )
        if has_bus and not has_arms:
            raise invalid("'bus' requires 'arms'; list at least one arm as {urdf: FILE, at: FRAME}")
        return value

    def build(self, scenario: Scenario) -> _core.Model:
        """Return the robot of a scenario.

        Raises
        ------
        OnOrbitError
            A subclass for the kind of error; its message starts with file, line and key.
        """
        model, faults = self._build_tree(scenario), Faults()
        for name, properties in self.joints.items():
            with faults.kept(), located(scenario, "robot", "joints", name):
                model = properties.apply(model, name)
        for index, extra in enumerate(scenario.collision):
            at = ("collision", index)
            with faults.kept(), located(scenario, *at), located_warnings(scenario, *at):
                model = extra.add_to(model, scenario.folder)
        faults.check()
        return add_loops(scenario, model)

    def _build_tree(self, scenario: Scenario) -> _core.Model:
        """Return the robot with its arms, before joint properties, collision shapes and loops are added."""
        if self.bus is None:
            return self.build_plain(scenario, ("robot",))
        model = self.bus.build_plain(scenario, ("robot", "bus"))
        for index, arm in enumerate(self.arms or ()):
            at: Location = ("robot", "arms", index)
            build = arm.build_part if arm.rigid_body is None else arm.build_plain
            part, pose = build(scenario, at), None if arm.pose is None else arm.pose.transform()
            with located(scenario, *at):
                model = _core.attach(model, arm.at, part, arm.frame, pose=pose, prefix=arm.prefix)
        for name, values in self.links.items():
            with located(scenario, "robot", "links", name):
                model = model.with_link(name, **values.given)
        return model


def _wording(at: Location) -> Wording:
    """Return the names of the robot's options for messages, given its location in the scenario."""
    place = dotted(at)
    return Wording(f"{place}.package_paths", f"{place}.xacro_arguments: {{NAME: ...}}")
