"""Topics of a run, for the live node and for bags, and their messages, which are computed from rows."""

from __future__ import annotations

from collections.abc import Container, Iterator, Mapping, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np

from onorbit_rs.common.coordinates import ANGULAR, JOINTS_Q, JOINTS_V, LINEAR, POSITION, QUATERNION
from onorbit_rs.common.rotations import is_local_frame_defined
from onorbit_rs.robots.urdf import urdf_text
from onorbit_rs.ros2.messages import Marks, Template, encode, message, point, quaternion, vector
from onorbit_rs.ros2.names import ros_names
from onorbit_rs.ros2.rows import Rows
from onorbit_rs.ros2.series import Series
from onorbit_rs.ros2.transforms import (
    BASE,
    ECI,
    WORLD,
    Link,
    OrbitFrames,
    SystemFrames,
    fixed_frames,
    frames_of,
)
from onorbit_rs.ros2.wrenches import wrench_topics

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from onorbit_rs._core import Model, Orbit

    Floats = NDArray[np.float64]

TF = "tf2_msgs/msg/TFMessage"


@dataclass(frozen=True)
class Latched:
    """A topic with a single message, which subscribers receive even if they join later."""

    name: str
    kind: str
    data: bytes


@dataclass(frozen=True)
class Topics:
    """Topics of a run: those with a message per row, and the latched ones."""

    series: tuple[Series, ...]
    latched: tuple[Latched, ...]
    prefixes: Mapping[str, str]
    """Prefix of the topics and frames of each system, such as ``chaser/``; empty for one robot."""
    frames: Mapping[str, Mapping[str, str]]
    """Name in ``/tf``, without the prefix, of each link and frame of each system."""

    @property
    def names(self) -> list[tuple[str, str]]:
        """Names and types of the topics with a message per row, each once: ``/tf`` has several series."""
        return list(dict.fromkeys((topic.name, topic.kind) for topic in self.series))

    def messages(
        self, rows: Mapping[str, Rows], names: Container[str] | None = None
    ) -> Iterator[tuple[Series, NDArray[np.uint8]]]:
        """Yield each series, or those of the topics ``names``, with its messages (T, size) for the rows."""
        for topic in self.series:
            if len(rows[topic.system]) and (names is None or topic.name in names):
                yield topic, topic.messages(rows[topic.system])


def topics(models: Mapping[str, Model], first: Mapping[str, Rows], orbit: Orbit | None = None) -> Topics:
    """Return the topics of a run.

    Parameters
    ----------
    models : mapping of str to Model
        Robots by the name of the system; the topics of a single robot have no prefix.
    first : mapping of str to Rows
        One or more rows of each system; topics are created for the columns that they have.
    orbit : Orbit, optional
        Reference orbit, from which the exact rate of ``lvlh`` is computed. Without it, the rate does not
        include the rotation of the orbital plane.
    """
    names = ros_names(models, "system")
    prefixes = {name: f"{ros}/" if len(models) > 1 else "" for name, ros in names.items()}
    frames = {system: frames_of(prefixes[system], model) for system, model in models.items()}
    reference = next(iter(models))
    series = [clock(reference)]
    if _has_local_frame(first[reference]):
        series += orbit_topics(reference, orbit)
    for system, model in models.items():
        series += system_topics(system, prefixes[system], model, frames[system])
        series += wrench_topics(system, prefixes[system], model, frames[system], first[system])
    latched = [static_topic(prefixes, models, frames)]
    latched += [description(prefixes[system], model, frames[system]) for system, model in models.items()]
    return Topics(tuple(series), tuple(latched), prefixes, frames)


def _has_local_frame(rows: Rows) -> bool:
    """Return True if the rows have a reference orbit, and position and velocity define ``lvlh``."""
    if "reference_position_eci" not in rows:
        return False
    return is_local_frame_defined(rows["reference_position_eci"], rows["reference_velocity_eci"])


def clock(system: str) -> Series:
    """Return the topic of the simulated time, with a message for each row of a system."""
    template = Template(lambda marks: message("rosgraph_msgs/msg/Clock", clock=marks.time))
    return Series("/clock", system, template, lambda rows: {})


def orbit_topics(system: str, orbit: Orbit | None) -> list[Series]:
    """Return the topics of the reference orbit: its frames, and pose and twist of ``lvlh`` in ``eci``."""

    def pose(marks: Marks) -> Any:
        p, q = point(marks.array("p", 3)), quaternion(marks.array("q", 4))
        content = message("geometry_msgs/msg/Pose", position=p, orientation=q)
        return message("geometry_msgs/msg/PoseStamped", header=marks.header(ECI), pose=content)

    def twist(marks: Marks) -> Any:
        v, w = vector(marks.array("v", 3)), vector(marks.array("w", 3))
        content = message("geometry_msgs/msg/Twist", linear=v, angular=w)
        return message("geometry_msgs/msg/TwistStamped", header=marks.header(ECI), twist=content)

    return [
        _transforms(system, OrbitFrames()),
        Series("/orbit/pose", system, Template(pose), _orbit_pose),
        Series("/orbit/twist", system, Template(twist), lambda rows: _orbit_twist(rows, orbit)),
    ]


def _orbit_pose(rows: Rows) -> dict[str, Floats]:
    return {"p": rows["reference_position_eci"], "q": rows.orbit_attitude}


def _orbit_twist(rows: Rows, orbit: Orbit | None) -> dict[str, Floats]:
    """Return the velocity of L's origin, m/s, and the angular velocity of L, rad/s, in axes of ``eci``.

    Without ``orbit``, the angular velocity is `r × v / r²`.
    """
    r, v = rows["reference_position_eci"], rows["reference_velocity_eci"]
    if orbit is not None:
        rot_il, rate_l = orbit.lvlh(np.ascontiguousarray(rows.time))
        return {"v": v, "w": np.einsum("tij,tj->ti", rot_il, rate_l)}
    return {"v": v, "w": np.cross(r, v) / np.sum(r * r, axis=1, keepdims=True)}


def system_topics(system: str, prefix: str, model: Model, frames: Mapping[str, str]) -> list[Series]:
    """Return the topics of a system: frames, odometry and, if it has joints, their states."""
    joints = model.joint_names

    def states(marks: Marks) -> Any:
        fields = {name: marks.array(name, len(joints)) for name in ("position", "velocity", "effort")}
        return message("sensor_msgs/msg/JointState", header=marks.header(""), name=list(joints), **fields)

    def odometry(marks: Marks) -> Any:
        p, q = point(marks.array("p", 3)), quaternion(marks.array("q", 4))
        v, w = vector(marks.array("v", 3)), vector(marks.array("w", 3))
        pose = message("geometry_msgs/msg/Pose", position=p, orientation=q)
        twist = message("geometry_msgs/msg/Twist", linear=v, angular=w)
        exact = np.zeros(36)
        return message(
            "nav_msgs/msg/Odometry", header=marks.header(WORLD), child_frame_id=prefix + BASE,
            pose=message("geometry_msgs/msg/PoseWithCovariance", pose=pose, covariance=exact),
            twist=message("geometry_msgs/msg/TwistWithCovariance", twist=twist, covariance=exact),
        )  # fmt: skip

    found = [
        _transforms(system, SystemFrames(prefix, model, frames)),
        Series(f"/{prefix}odom", system, Template(odometry), _odometry),
    ]
    if joints:
        found.append(Series(f"/{prefix}joint_states", system, Template(states), _joint_states))
    return found


def _joint_states(rows: Rows) -> dict[str, Floats]:
    return {"position": rows["q"][:, JOINTS_Q], "velocity": rows["v"][:, JOINTS_V], "effort": rows["tau"]}


def _odometry(rows: Rows) -> dict[str, Floats]:
    """Return the pose of the base in W, and its twist in base axes, as ``nav_msgs/Odometry`` defines them."""
    q, v = rows["q"], rows["v"]
    return {"p": q[:, POSITION], "q": q[:, QUATERNION], "v": v[:, LINEAR], "w": v[:, ANGULAR]}


def _transforms(system: str, frames: OrbitFrames | SystemFrames) -> Series:
    """Return the series of transforms of moving frames."""

    def values(rows: Rows) -> dict[str, Floats]:
        return {"poses": frames.poses(rows).reshape(len(rows), -1)}

    template = Template(
        lambda marks: tf_message(frames.links, marks.array("poses", 7 * len(frames.links)), marks)
    )
    return Series("/tf", system, template, values)


def tf_message(links: Sequence[Link], poses: Floats, marks: Marks) -> Any:
    """Return the transforms of k frames with poses (7 k,): position, m, and quaternion xyzw in the parent."""
    transforms = [
        message(
            "geometry_msgs/msg/TransformStamped", header=marks.header(parent), child_frame_id=child,
            transform=message(
                "geometry_msgs/msg/Transform", translation=vector(pose[:3]), rotation=quaternion(pose[3:])
            ),
        )
        for (parent, child), pose in zip(links, poses.reshape(-1, 7), strict=True)
    ]  # fmt: skip
    return message(TF, transforms=transforms)


def static_topic(
    prefixes: Mapping[str, str], models: Mapping[str, Model], frames: Mapping[str, Mapping[str, str]]
) -> Latched:
    """Return the topic of the transforms of frames that are fixed to links."""
    found = [fixed_frames(prefixes[name], model, frames[name]) for name, model in models.items()]
    links = [link for part, _ in found for link in part]
    poses = np.concatenate([part for _, part in found])
    template = Template(lambda marks: tf_message(links, marks.array("poses", poses.size), marks))
    return Latched("/tf_static", TF, template.fill(np.zeros(1), {"poses": poses.reshape(1, -1)})[0].tobytes())


def description(prefix: str, model: Model, frames: Mapping[str, str]) -> Latched:
    """Return the topic of the robot as URDF, whose links and frames have their names in ``/tf``."""
    kind = "std_msgs/msg/String"
    return Latched(f"/{prefix}robot_description", kind, encode(message(kind, data=urdf_text(model, frames))))
