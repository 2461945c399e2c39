"""Topics of the wrenches that the environment exerts on the links of a system, if the run records them."""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING, Any

import numpy as np

from onorbit_rs.common.coordinates import ANGULAR, LINEAR
from onorbit_rs.ros2.messages import Marks, Template, message, vector
from onorbit_rs.ros2.names import ros_names
from onorbit_rs.ros2.series import Series

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from onorbit_rs._core import Body, Model
    from onorbit_rs.ros2.rows import Rows

    Floats = NDArray[np.float64]


def wrench_topics(system: str, prefix: str, model: Model, first: Rows) -> list[Series]:
    """Return a topic for each effect and link: the wrench at the link's origin, in the axes of the link."""
    effects = ros_names(first.wrenches, "effect")
    links = ros_names(model.body_names, "link")
    return [
        _topic(f"/{prefix}wrench/{name}/{links[body.name]}", system, prefix, effect, (index, body), model)
        for effect, name in effects.items()
        for index, body in enumerate(model.bodies)
    ]


def _topic(name: str, system: str, prefix: str, effect: str, link: tuple[int, Body], model: Model) -> Series:
    def build(marks: Marks) -> Any:
        force, torque = vector(marks.array("force", 3)), vector(marks.array("torque", 3))
        content = message("geometry_msgs/msg/Wrench", force=force, torque=torque)
        header = marks.header(prefix + link[1].name)
        return message("geometry_msgs/msg/WrenchStamped", header=header, wrench=content)

    return Series(name, system, Template(build), _values(effect, link, model))


def _values(effect: str, link: tuple[int, Body], model: Model) -> Callable[[Rows], dict[str, Floats]]:
    index, body = link
    com = np.array(body.com)

    def values(rows: Rows) -> dict[str, Floats]:
        """Return `f = Rᵀ f_W` and `t = Rᵀ t_W + c × f` from the wrench at the centre of mass c."""
        rot_wl = np.asarray(model.frame_pose(np.ascontiguousarray(rows["q"]), body.name))[:, :3, :3]
        wrench = rows.wrenches[effect].reshape(len(rows), -1, 6)[:, index]
        force = np.einsum("tji,tj->ti", rot_wl, wrench[:, LINEAR])
        torque = np.einsum("tji,tj->ti", rot_wl, wrench[:, ANGULAR]) + np.cross(com, force)
        return {"force": force, "torque": torque}

    return values
