"""A hand with two jaws on an arm with one joint, and a bar that it grasps, for the grasp cases.

The bus has a large moment of inertia, so that the closed forms need not include its rotation.
"""

from __future__ import annotations

from collections.abc import Sequence
from functools import cache
from typing import Any

import numpy as np

import onorbit_rs as oo
from onorbit_rs.common.coordinates import POSITION
from onorbit_rs.tools.validation.contact_bodies import at, body

FORCE = 25.0
"""Grip force, N."""
DAMPING, CLOSING = 40.0, -0.02
"""Damping of the grip, N s/m, and closing rate, m/s."""
RADIUS, BAR_MASS = 0.02, 20.0
"""Radius of the bar, m, and its mass, kg."""
FINGERS = ("first", "second", "third")
"""Names of the fingers of the hand with three fingers."""
MU = 0.6
STIFFNESS = 2e4
"""Stiffness of a pad, N/m."""

_ARM = """
<robot name="arm">
  <link name="bus">
    <inertial><mass value="3000"/><inertia ixx="1e6" iyy="1e6" izz="1e6" ixy="0" ixz="0" iyz="0"/></inertial>
  </link>
  <joint name="arm" type="prismatic">
    <parent link="bus"/><child link="wrist"/><origin xyz="0 0 0.5"/><axis xyz="0 1 0"/>
    <limit lower="-1" upper="1" effort="200" velocity="1"/>
  </joint>
  <link name="wrist">
    <inertial><mass value="5"/><inertia ixx="0.05" iyy="0.05" izz="0.05" ixy="0" ixz="0" iyz="0"/></inertial>
  </link>
</robot>
"""
_BAR = f"""
<robot name="bar">
  <link name="body">
    <inertial>
      <mass value="{BAR_MASS}"/><inertia ixx="0.2" iyy="0.1" izz="0.2" ixy="0" ixz="0" iyz="0"/>
    </inertial>
    <collision>
      <origin rpy="1.5707963267948966 0 0"/><geometry><cylinder radius="{RADIUS}" length="0.3"/></geometry>
    </collision>
  </link>
</robot>
"""


@cache
def hand() -> oo.Model:
    """Return the arm with the bundled hand; its joints are ``arm``, ``left_jaw`` and ``right_jaw``."""
    arm = oo.Model.from_urdf_string(_ARM)
    return oo.attach(arm, "wrist", oo.robots.load("jaw_hand"))


@cache
def bar() -> oo.Model:
    """Return the model of the bar."""
    return oo.Model.from_urdf_string(_BAR)


def start(opening: float = 0.06) -> tuple[np.ndarray, np.ndarray]:
    """Return the configuration of the hand with an opening, m, and the place of ``grasp`` in W, (3,), m."""
    q = hand().neutral()
    q[8:] = opening / 2
    return q, hand().frame_pose(q, "grasp")[:3, 3]


def pads() -> list[oo.Contact]:
    """Return the contacts of both pads with the bar."""
    friction = oo.Friction(MU, torsional=0.05, stiffness=STIFFNESS, damping=300.0)
    return [
        oo.Contact(
            f"hand/{side}_finger", "bar/body", name=side, friction=friction,
            normal=oo.HuntCrossley(STIFFNESS, 1.0, dissipation=50.0),
        )
        for side in ("left", "right")
    ]  # fmt: skip


def grip(force: float = FORCE, **options: Any) -> oo.Control:
    """Return the control that closes the jaws."""
    law = oo.GripForce(force, closing_rate=CLOSING, damping=DAMPING, ramp=0.2, **options)
    return oo.Control(law, joints=["left_jaw"], name="grip")


def arm(points: Sequence[float], times: Sequence[float]) -> oo.Control:
    """Return the control that moves the arm through positions, m, at times, s."""
    reference = oo.JointWaypoints(np.reshape(points, (-1, 1)), times=np.array(times))
    return oo.Control(oo.JointPid(p=16000.0, d=2400.0), reference=reference, joints=["arm"], name="arm")


def world(
    controls: Sequence[oo.Control],
    *,
    place: Sequence[float] = (0.0, 0.0, 0.0),
    velocity: Sequence[float] = (0.0,) * 6,
    loads: Sequence[oo.BodyWrench] = (),
    events: Sequence[Any] = (),
    opening: float = 0.06,
) -> oo.World:
    """Return the world of the hand and the bar, whose position ``place``, m, is relative to ``grasp``."""
    q, origin = start(opening)
    systems = [
        oo.System("hand", hand(), q, np.zeros(hand().nv), controller=list(controls)),
        oo.System(
            "bar", bar(), [*(origin + np.asarray(place)), 0, 0, 0, 1], np.asarray(velocity, dtype=float)
        ),
    ]  # fmt: skip
    return oo.World(systems, contacts=pads(), environment=list(loads), events=list(events))


def run(made: oo.World, lasts: float, *, every: int = 1) -> oo.WorldTrace:
    """Return the trace of a world, with control ticks every 5 ms."""
    trace = oo.Simulation(made, time_step=5e-3, record_every=every).run(lasts)
    assert isinstance(trace, oo.WorldTrace)
    return trace


def in_hand(trace: oo.WorldTrace) -> np.ndarray:
    """Return the position of the bar in the frame ``grasp``, (T, 3), m."""
    q, bar = np.asarray(trace["hand"].q), np.asarray(trace["bar"].q)
    poses = [hand().frame_pose(row, "grasp") for row in q]
    return np.array(
        [pose[:3, :3].T @ (row[POSITION] - pose[:3, 3]) for pose, row in zip(poses, bar, strict=True)]
    )


def three_fingers(radius: float, integral: float, *, lasts: float = 3.0) -> tuple[oo.WorldTrace, oo.Model]:
    """Return the trace and the model of a three-finger hand that closes on a pin with a ``radius``, m."""
    model = oo.robots.load("three_finger_hand")
    q = model.neutral()
    place = model.frame_pose(q, "grasp")[:3, 3]
    pin = body(f'<cylinder radius="{radius}" length="0.2"/>', 20.0, [0.2, 0.2, 0.1])
    law = oo.GripForce(FORCE, closing_rate=-0.2, damping=0.2, ramp=0.2, integral=integral, stiffness=20.0)
    systems = [
        oo.System("hand", model, q, np.zeros(model.nv), controller=[oo.Control(law, name="grip")]),
        at("pin", pin, place),
    ]
    contacts = [
        oo.Contact(
            f"hand/{name}_finger", "pin/body", name=name,
            normal=oo.HuntCrossley(STIFFNESS, 1.0, dissipation=50.0),
            friction=oo.Friction(MU, stiffness=STIFFNESS),
        )
        for name in FINGERS
    ]  # fmt: skip
    return run(oo.World(systems, contacts=contacts), lasts, every=20), model


def operation() -> oo.WorldTrace:
    """Return the trace of a whole capture.

    The bar drifts and turns slowly; it is grasped, moved by the arm, latched, seated and released with an
    impulse.
    """
    touching = ["left", "right"]
    events = [
        oo.Capture(
            "capture", "hand/grasp", "bar/body", within=[0.02, 0.2], slower_than=[0.1, 0.1], held_for=1.5,
            touching=touching, seat=0.5,
        ),
        oo.Release("release", "capture", after="capture", delay=1.0, impulse=[0.0, 0.0, 2.0, 0.0, 0.0, 0.0]),
    ]  # fmt: skip
    made = world(
        [arm([0.0, 0.0, 0.05], [0.0, 1.0, 3.0]), grip()],
        place=(0.002, 0.0, 0.005), velocity=(0.002, 0.001, 0.0, 0.004, 0.0, 0.003), events=events,
    )  # fmt: skip
    return run(made, 4.5)
