"""Description of the robot for which a scenario is drafted."""

from __future__ import annotations

import os
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any

from onorbit_rs import _core, robots
from onorbit_rs.exceptions import FrameError

if TYPE_CHECKING:
    from onorbit_rs._core import Model


@dataclass(frozen=True)
class Source:
    """Robot given by a bundled name, or by a file with its options; optionally attached to a bus."""

    robot: str
    package_paths: Sequence[Path] | None = None
    xacro_arguments: Mapping[str, str] | None = None
    xacro: bool = False
    bus: str | None = None
    """Bundled name or file of the bus; ``package_paths`` also applies to the bus."""
    at: str | None = None
    """Frame of the bus to which the robot is attached; optional if the bus has a single frame."""
    prefix: str = ""

    def model(self) -> Model:
        """Return the robot, attached to its bus if there is one.

        Raises
        ------
        OnOrbitError
            If a robot cannot be read, the bus lacks the frame, or both robots contain the same name.
        """
        how: dict[str, Any] = {
            "package_paths": self.package_paths, "xacro_arguments": self.xacro_arguments, "xacro": self.xacro,
        }  # fmt: skip
        if self.bus is None:
            return robots.load(self.robot, **how)
        file = Path(self.robot) if robots.is_file(self.robot) else robots.path(self.robot)
        robot = _core.RobotPart.from_urdf(file, **how)
        bus = robots.load(self.bus, package_paths=self._packages_of_bus())
        return _core.attach(bus, self._frame(bus), robot, prefix=self.prefix)

    def name(self, model: Model) -> str:
        """Return the name of the drafted scenario."""
        return f"{Path(self.robot).name.split('.')[0] if robots.is_file(self.robot) else model.name}_first"

    def entry(self, beside: Path | None, model: Model) -> dict[str, Any] | str:
        """Return the scenario's ``robot`` entry, with paths relative to ``beside`` where they are short.

        Paths that lead more than two levels up are absolute, as are all paths if ``beside`` is None.
        """
        robot = self._robot(beside)
        if self.bus is None:
            return robot
        packages = [_path(package, beside) for package in self._packages_of_bus() or ()]
        bus = _path(Path(self.bus), beside) if robots.is_file(self.bus) else self.bus
        arm = robot if isinstance(robot, dict) else _source(robot)
        mounted = {**arm, "at": self.at or model.frame_names[0]}
        if self.prefix:
            mounted["prefix"] = self.prefix
        return {"bus": {"urdf": bus, "package_paths": packages} if packages else bus, "arms": [mounted]}

    def _frame(self, bus: Model) -> str:
        """Return the bus frame to which the robot is attached; raise a FrameError if it is ambiguous."""
        if self.at is not None:
            return self.at
        if len(bus.frame_names) == 1:
            return bus.frame_names[0]
        raise FrameError(
            f"the bus {self.bus} has several frames to which the robot could be attached; choose one with "
            f"--at FRAME: {', '.join(bus.frame_names)}",
            name=None, kind="frame", known=list(bus.frame_names), suggestion=None,
        )  # fmt: skip

    def _packages_of_bus(self) -> Sequence[Path] | None:
        return self.package_paths if self.bus is not None and robots.is_file(self.bus) else None

    def _robot(self, beside: Path | None) -> dict[str, Any] | str:
        """Return the ``robot`` entry for the robot without its bus."""
        if not robots.is_file(self.robot):
            return self.robot
        path = _path(Path(self.robot), beside)
        if not self.package_paths and not self.xacro_arguments and not self.xacro:
            return path
        written: dict[str, Any] = {"urdf": path}
        if self.package_paths:
            written["package_paths"] = [_path(package, beside) for package in self.package_paths]
        if self.xacro_arguments:
            written["xacro_arguments"] = dict(self.xacro_arguments)
        if self.xacro:
            written["xacro"] = True
        return written


def _source(robot: str) -> dict[str, Any]:
    return {"urdf" if robots.is_file(robot) else "bundled": robot}


def _path(path: Path, beside: Path | None) -> str:
    """Return a path relative to the scenario's folder if it is at most two levels above, else absolute."""
    if beside is not None:
        try:
            relative = os.path.relpath(path.resolve(), beside.resolve())
        except ValueError:  # another drive
            return str(path.resolve())
        if relative.count("..") <= 2:
            return relative if "/" in relative or os.sep in relative else f"./{relative}"
    return str(path.resolve())
