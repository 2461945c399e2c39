"""Topics of the wrenches that the environment exerts on the links of a system, if the run records them."""

from __future__ import annotations

from collections.abc import Callable, Mapping
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


def wrench_topics(
    system: str, prefix: str, model: Model, frames: Mapping[str, str], first: Rows
) -> list[Series]:
    """Return a topic per recorded effect and link: the wrench at the link's origin, in the link's axes.

    Without recorded wrenches, the list is empty.
    """
    effects = ros_names(first.wrenches, "effect")
    if not effects:
        return []  # without a warning about links
    links = ros_names((frames[name] for name in model.body_names), "link")
    return [
        _topic(
            f"/{prefix}wrench/{name}/{links[frames[body.name]]}", system, prefix + frames[body.name],
            _values(effect, (index, body), model),
        )
        for effect, name in effects.items()
        for index, body in enumerate(model.bodies)
    ]  # fmt: skip


def _topic(name: str, system: str, frame: str, values: Callable[[Rows], dict[str, Floats]]) -> Series:
    def build(marks: Marks) -> Any:
        force, torque = vector(marks.array("force", 3)), vector(marks.array("torque", 3))
        content = message("geometry_msgs/msg/Wrench", force=force, torque=torque)
        return message("geometry_msgs/msg/WrenchStamped", header=marks.header(frame), wrench=content)

    return Series(name, system, Template(build), values)


def _values(effect: str, link: tuple[int, Body], model: Model) -> Callable[[Rows], dict[str, Floats]]:
    index, body = link
    com = np.array(body.com)

    def values(rows: Rows) -> dict[str, Floats]:
        """Return `f = Rᵀ f_W`, N, and `t = Rᵀ t_W + c × f`, N m, (T, 3) each.

        `f_W` and `t_W` act at the mass centre, which is at `c` in the link; `R` rotates link axes to W.
        """
        rot_wl = np.asarray(model.frame_pose(np.ascontiguousarray(rows["q"]), body.name))[:, :3, :3]
        wrench = rows.wrenches[effect].reshape(len(rows), -1, 6)[:, index]
        force = np.einsum("tji,tj->ti", rot_wl, wrench[:, LINEAR])
        torque = np.einsum("tji,tj->ti", rot_wl, wrench[:, ANGULAR]) + np.cross(com, force)
        return {"force": force, "torque": torque}

    return values
