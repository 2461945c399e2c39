"""Converts YAML files of OnOrbitROS to a scenario, with notes on the conversion of the lines.

Sources for the file formats and the ROS nodes: github.com/OnOrbitROS/Simulation (``Orbit.cpp``,
``orbit_publisher_pkg/config``) and github.com/OnOrbitROS/robot_torso (``talos_control``).
"""

from __future__ import annotations

import os
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from onorbit_rs.exceptions import InputError
from onorbit_rs.scenario.locations import scenario_error
from onorbit_rs.scenario.yaml_lines import Location, read_yaml
from onorbit_rs.tools.interop.onorbitros_controllers import read_controllers
from onorbit_rs.tools.interop.onorbitros_orbit import FIXED_KEYS, ORBIT_KEYS, read_fixed_pose, read_orbit
from onorbit_rs.tools.interop.source import Note, Source

CONTROLLER_MARKS = {"end_effector_link", "kp_value", "kv_value"}
PLACEHOLDER = {"rigid_body": {"mass": 100.0, "inertia": [10.0, 10.0, 10.0]}}
DURATION = 60.0
"""Duration of the run, s, if no trajectory determines it."""


@dataclass(frozen=True)
class Conversion:
    """Scenario that results from a conversion, with notes on the converted lines."""

    scenario: dict[str, Any]
    """Plain data that :func:`onorbit_rs.scenario.load` accepts."""
    notes: list[Note]
    comments: dict[Location, str]
    """Comment on the origin of each entry of the scenario, by the location of the entry."""


def convert(
    paths: Sequence[str | os.PathLike[str]],
    *,
    controller: str | None = None,
    external: bool = False,
    keep_going: bool = False,
    beside: str | os.PathLike[str] | None = None,
) -> Conversion:
    """Return a scenario from files of OnOrbitROS: orbit or fixed pose, controllers and robot, in any order.

    Parameters
    ----------
    paths : sequence of paths
        YAML files, and at most one URDF or xacro.
    controller : str, optional
        Name of the controller to convert, if a file has several. Default: all controllers if they list
        different joints, otherwise the first controller.
    external : bool
        Whether joints with a PID follow commands (``kind: external``) instead of holding their positions.
    keep_going : bool
        Whether an unknown key causes a note instead of an error.
    beside : path, optional
        Folder of the new scenario; the path of the robot is relative to it. Default: the path as given.

    Returns
    -------
    Conversion

    Raises
    ------
    NotFoundError, ReadError
        If a file is missing or cannot be read.
    ScenarioError
        If keys are unknown, values are invalid or files are inconsistent; the message contains file and line.
    InputError
        If no file or more than one robot is given.
    """
    files = [Path(path) for path in paths]
    robots = [file for file in files if file.suffix.lower() in (".urdf", ".xacro")]
    if not files or len(robots) > 1:
        what = (
            f"{len(robots)} robots are given ({', '.join(map(str, robots))}); give at most one"
            if files
            else "no file is given; give the YAML files of OnOrbitROS"
        )
        raise InputError(what, name="paths", got=len(files), expected="YAML files and at most one robot")
    notes: list[Note] = []
    origins: dict[str, Path] = {}
    scenario: dict[str, Any] = {"robot": dict(PLACEHOLDER)}
    comments: dict[Location, str] = {
        ("robot",): "a placeholder; also give onorbit convert a URDF or xacro file"
    }
    for robot in robots:
        where = os.path.relpath(robot, beside) if beside is not None else str(robot)
        scenario["robot"] = {"urdf": Path(where).as_posix()}
        comments[("robot",)] = "its root link is free-floating"
        notes.append(Note(robot, None, "robot", "understood", "the robot; its root link is free-floating"))
    for source in _sources([file for file in files if file not in robots], keep_going, notes):
        _read(source, controller, external)
        for key, part in source.result.items():
            if key in scenario and key not in ("simulation", "robot"):
                raise scenario_error(
                    f"the entry {key!r} of the scenario is also defined in {origins[key]}; omit one of "
                    "the definitions",
                    source.file,
                    None,
                )
            scenario[key], origins[key] = part, source.file
        comments |= source.comments
    if {"controller", "controllers"} & set(scenario) and not robots:
        raise scenario_error(
            "a controller requires a robot; also give the robot's URDF or xacro file", files[0], None
        )
    scenario.setdefault("simulation", {"duration": DURATION})
    notes.sort(key=lambda note: (files.index(note.file), note.line or 0))
    return Conversion(scenario, notes, comments)


def _sources(files: Sequence[Path], keep_going: bool, notes: list[Note]) -> list[Source]:
    """Return every mapping with parameters in the files, without namespaces and ROS 2 wrappers."""
    found: list[Source] = []
    for file in files:
        data, lines = read_yaml(file)
        if not isinstance(data, dict) or not data:
            raise scenario_error(
                "the file contains no parameters; it must be a mapping of keys to values", file, None
            )
        top = Source(file, lines, (), data, keep_going, notes)
        found += _unwrapped(top)
    return found


def _unwrapped(source: Source) -> list[Source]:
    """Return the mappings in ROS namespaces; a mapping with controllers or known keys is not unwrapped."""
    inner = source.data.values()
    is_namespace = all(isinstance(part, dict) for part in inner) and not _is_known(source.data)
    if not is_namespace or any(CONTROLLER_MARKS & set(part) or "type" in part for part in inner):
        return [source]
    below: list[Source] = []
    for key in source.data:
        text = (
            "ROS 2 parameter wrapper; its contents are converted"
            if key in ("/**", "ros__parameters")
            else "ROS namespace; its contents are converted without the prefix"
        )
        source.note(key, "understood", text)
        below += _unwrapped(source.inside(key, apart=True))
    return below


def _is_known(data: Mapping[str, Any]) -> bool:
    return any(key in ORBIT_KEYS or key in FIXED_KEYS for key in data)


def _read(source: Source, controller: str | None, external: bool) -> None:
    """Convert an orbit, a fixed pose or controllers, depending on the keys."""
    inner = [part for part in source.data.values() if isinstance(part, dict)]
    if CONTROLLER_MARKS & set(source.data) or any(
        CONTROLLER_MARKS & set(part) or "type" in part for part in inner
    ):
        read_controllers(source, controller, external)
    elif any(key in FIXED_KEYS and key not in ORBIT_KEYS for key in source.data):
        source.refuse_unknown(FIXED_KEYS)
        read_fixed_pose(source)
    else:
        source.refuse_unknown(ORBIT_KEYS)
        read_orbit(source)
