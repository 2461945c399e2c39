"""Closed loops and mimic joints of robots as equality constraints of a MuJoCo model."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from onorbit_rs.engines.mujoco_common import harden, path
from onorbit_rs.exceptions import EngineError

if TYPE_CHECKING:
    from collections.abc import Iterator, Mapping
    from types import ModuleType

    from numpy.typing import NDArray

    from onorbit_rs._core import Joint, Loop, Model

    Floats = NDArray[np.float64]

HALF_PIN = 0.1
"""Distance, m, from the origin of a ``revolute`` loop to each of the two points that hold its axis. This
distance scales MuJoCo's constraint forces but does not change the permitted motion."""


def loop_names(models: Mapping[str, Model]) -> list[str]:
    """Return the names of the closed loops and mimic joints of robots, ``SYSTEM/NAME`` in a world."""
    names = []
    for system, model in models.items():
        names += [path(system, loop.name) for loop in model.loops]
        names += [path(system, joint.name) for joint in model.joints if joint.mimic is not None]
    return names


def add_loops(
    mujoco: ModuleType, spec: Any, system: str, model: Model, bodies: Mapping[str, Any], time_step: float
) -> dict[str, float]:
    """Add the closed loops and mimic joints of a robot; return the length of each tendon by its name, m.

    ``weld`` and ``spherical`` loops are MuJoCo's ``weld`` and ``connect`` of two sites. A ``revolute`` loop
    is two ``connect``, at two points of its axis. A ``distance`` loop is a tendon of constant length between
    two sites; :func:`set_lengths` sets the length after the compilation. A mimic joint is a ``joint``
    equality. All are critically damped springs with the shortest time constant.

    Raises
    ------
    EngineError
        If a loop is prismatic, for which MuJoCo has no equality.
    """
    lengths: dict[str, float] = {}
    for joint in model.joints:
        if joint.mimic is not None:
            harden(_add_mimic(mujoco, spec, system, joint), 2.0 * time_step)
    for loop in model.loops:
        for equality in _add_loop(mujoco, spec, path(system, loop.name), loop, model, bodies):
            harden(equality, 2.0 * time_step)
        if loop.kind == "distance":
            assert loop.length is not None
            lengths[path(system, loop.name)] = loop.length
    return lengths


def set_lengths(compiled: Any, lengths: Mapping[str, float]) -> None:
    """Set the lengths of the tendons in a compiled model, m; MuJoCo states them relative to ``qpos0``."""
    for name, length in lengths.items():
        compiled.equality(name).data[0] = length - compiled.tendon_length0[compiled.tendon(name).id]


def _add_mimic(mujoco: ModuleType, spec: Any, system: str, joint: Joint) -> Any:
    """Add the equality `q = offset + ratio q_leader`; both joints are at zero in MuJoCo's ``qpos0``."""
    assert joint.mimic is not None
    leader, ratio, offset = joint.mimic
    equality = spec.add_equality()
    equality.type, equality.objtype = mujoco.mjtEq.mjEQ_JOINT, mujoco.mjtObj.mjOBJ_JOINT
    equality.name1, equality.name2 = path(system, joint.name), path(system, leader)
    equality.data[:2] = offset, ratio
    return equality


def _add_loop(
    mujoco: ModuleType, spec: Any, name: str, loop: Loop, model: Model, bodies: Mapping[str, Any]
) -> Iterator[Any]:
    """Add the sites and equalities of a loop; yield the equalities."""
    if loop.kind == "prismatic":
        raise EngineError(
            f"loop '{loop.name}' is prismatic, but MuJoCo has no equality that leaves one translation free; "
            "make it a joint of the robot and close the loop elsewhere, or use engine: native",
            name=loop.name, got="prismatic", expected="weld, revolute, spherical or distance",
        )  # fmt: skip
    sides = ((loop.frame_a, loop.pose_a), (loop.frame_b, loop.pose_b))
    if loop.kind == "distance":
        tendon, equality = spec.add_tendon(), spec.add_equality()
        tendon.name = equality.name = equality.name1 = name
        for side, (frame, pose) in enumerate(sides):
            tendon.wrap_site(_add_site(mujoco, model, bodies, frame, np.array(pose), f"{name} {side}"))
        equality.type, equality.objtype = mujoco.mjtEq.mjEQ_TENDON, mujoco.mjtObj.mjOBJ_TENDON
        yield equality
        return
    heights = (-HALF_PIN, HALF_PIN) if loop.kind == "revolute" else (0.0,)
    for height in heights:
        equality = spec.add_equality()
        equality.name = f"{name} {height:g}"
        kinds = mujoco.mjtEq
        equality.type = kinds.mjEQ_WELD if loop.kind == "weld" else kinds.mjEQ_CONNECT
        equality.objtype = mujoco.mjtObj.mjOBJ_SITE
        up = np.eye(4)
        up[2, 3] = height
        equality.name1, equality.name2 = (
            _add_site(mujoco, model, bodies, frame, np.array(pose) @ up, f"{name} {height:g} {side}")
            for side, (frame, pose) in enumerate(sides)
        )
        yield equality


def _add_site(
    mujoco: ModuleType, model: Model, bodies: Mapping[str, Any], frame: str, pose: Floats, name: str
) -> str:
    """Add a site at a pose in a frame; return its name."""
    of = next(one for one in model.frames if one.name == frame)
    placed = np.array(of.pose) @ pose
    site = bodies[of.body].add_site()
    site.name, site.pos = name, placed[:3, 3]
    quat = np.empty(4)
    mujoco.mju_mat2Quat(quat, np.ascontiguousarray(placed[:3, :3]).ravel())
    site.quat = quat
    return name
