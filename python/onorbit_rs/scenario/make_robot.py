"""Build the robot of a scenario."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from onorbit_rs import _core, robots
from onorbit_rs.geometry import pose_of
from onorbit_rs.robots.wording import Wording, worded
from onorbit_rs.rotations import matrix_from_quaternion
from onorbit_rs.scenario.place import dotted, located
from onorbit_rs.scenario.start import quaternion_of

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from onorbit_rs.scenario.robot import PlainRobot
    from onorbit_rs.scenario.schema import Scenario
    from onorbit_rs.scenario.task_frame import Pose

    Place = tuple[str | int, ...]


def make_robot(scenario: Scenario) -> _core.Model:
    """Build the robot of a scenario.

    Raises
    ------
    OnOrbitError
        The appropriate subclass; its message starts with file, line and key.
    """
    robot = scenario.robot
    if robot.bus is None:
        return _plain(scenario, robot, ("robot",))
    model = _plain(scenario, robot.bus, ("robot", "bus"))
    for index, arm in enumerate(robot.arms or ()):
        at: Place = ("robot", "arms", index)
        mounted = _plain(scenario, arm, at) if arm.rigid_body is not None else _part(scenario, arm, at)
        with located(scenario, *at):
            model = _core.attach(model, arm.at, mounted, arm.frame, pose=_matrix(arm.pose), prefix=arm.prefix)
    for name, values in robot.links.items():
        with located(scenario, "robot", "links", name):
            model = model.with_link(name, **values.given)
    return model


def _plain(scenario: Scenario, robot: PlainRobot, at: Place) -> _core.Model:
    """Build a robot that is not a bus with arms."""
    if robot.rigid_body is not None:
        with located(scenario, *at):
            return _core.Model.rigid_body(robot.rigid_body.mass, np.array(robot.rigid_body.inertia))
    with located(scenario, *at), worded(_wording(at)):
        return _core.Model.from_urdf(**_file(scenario, robot))


def _part(scenario: Scenario, robot: PlainRobot, at: Place) -> _core.RobotPart:
    """Read a robot that is attached to another, and so need not be able to float by itself."""
    with located(scenario, *at), worded(_wording(at)):
        return _core.RobotPart.from_urdf(**_file(scenario, robot))


def _file(scenario: Scenario, robot: PlainRobot) -> dict[str, Any]:
    """Return the arguments that the engine reads the robot's file with."""
    beside = scenario.file.parent if scenario.file else Path()
    return {
        "path": robots.path(robot.bundled) if robot.bundled is not None else beside / str(robot.urdf),
        "package_paths": [beside / folder for folder in robot.package_paths] or None,
        "xacro_arguments": robot.xacro_arguments or None,
        "xacro": robot.xacro,
        "links": {name: values.given for name, values in robot.links.items()},
    }


def _wording(at: Place) -> Wording:
    """Return how messages name the options of the robot at a place of the scenario."""
    place = dotted(at)
    return Wording(f"{place}.package_paths", f"{place}.xacro_arguments: {{NAME: ...}}")


def _matrix(pose: Pose | None) -> NDArray[np.float64] | None:
    """Homogeneous transform (4, 4)."""
    if pose is None:
        return None
    return pose_of(matrix_from_quaternion(quaternion_of(pose.attitude)), np.array(pose.position))
