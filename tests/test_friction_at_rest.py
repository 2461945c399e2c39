"""Friction of joints at rest: breakaway, sticking, and invalid input."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import onorbit_rs as oo
from onorbit_rs.robots.fingerprint import fingerprint

GOAL = 0.05  # rad


def hinge(**friction: Any) -> oo.Model:
    """Returns a link of 0.03 kg m² about its joint on a base of 50 kg."""
    builder = oo.ModelBuilder("hinge", base="base", mass=50.0, com=[0, 0, 0], inertia=5.0 * np.eye(3))
    builder.add_link(
        "link", parent="base", joint="joint", mass=1.0, com=[0.1, 0, 0], inertia=0.02 * np.eye(3), **friction
    )
    return builder.build()


def moved(model: oo.Model, *, kd: float = 20.0, duration: float = 3.0, **settings: Any) -> oo.Trace:
    law = oo.JointComputedTorque(
        kp=100.0, kd=kd, compensate_friction=settings.pop("compensate_friction", True)
    )
    simulation = oo.Simulation(
        model, model.neutral(), np.zeros(model.nv), controller=law, reference=oo.JointHold([GOAL]), **settings
    )
    return simulation.run(duration)


@dataclass(frozen=True)
class Rows:
    """Joint positions at the instants that two runs share."""

    free: Any
    rough: Any


def shared_rows(free: oo.Trace, rough: oo.Trace) -> Rows:
    rows = np.isin(rough.time, free.time)  # reversals are recorded as rows, too
    assert rows.sum() == len(free.time)
    return Rows(free.q[:, 7], rough.q[rows, 7])


@pytest.mark.parametrize("kd", [20.0, 2.0])
@pytest.mark.parametrize("friction", [{"friction": 0.2}, {"friction": 0.2, "static_friction": 0.35}])
def test_friction_compensation_makes_a_stuck_joint_move_as_without_friction(
    kd: float, friction: dict[str, float]
) -> None:
    """With 0.2 N m and a goal 0.05 rad away the joint once never moved."""
    trace = moved(hinge(**friction), kd=kd)
    rows = shared_rows(moved(hinge(), kd=kd), trace)
    assert np.abs(rows.free - rows.rough).max() < 1e-6
    assert all(passed for *_, passed in trace.certificate())
    compensation = trace.friction_compensation
    assert compensation is not None
    signs = np.sign(compensation[compensation != 0.0])
    assert np.count_nonzero(np.diff(signs)) == (0 if kd == 20.0 else 9)  # one swing every 0.63 s, no chatter
    # negative control
    assert not np.any(moved(hinge(**friction), kd=kd, compensate_friction=False).q[:, 7])


def test_a_run_without_friction_records_no_compensation() -> None:
    trace = moved(hinge(), duration=0.01)
    assert trace.friction_compensation is None and "friction_compensation" not in trace.columns()


def test_static_friction_defaults_to_kinetic_friction() -> None:
    frictions = [
        {"friction": 0.2},
        {"friction": 0.2, "static_friction": 0.2},
        {"friction": 0.2, "static_friction": 0.3},
    ]
    models = [hinge(**friction) for friction in frictions]
    assert [model.joints[0].static_friction for model in models] == [0.2, 0.2, 0.3]
    prints = [fingerprint(model) for model in models]
    assert prints[0] == prints[1] != prints[2]


def test_static_friction_is_read_from_a_urdf() -> None:
    inertial = (
        '<inertial><mass value="1"/><inertia ixx="1" iyy="1" izz="1" ixy="0" ixz="0" iyz="0"/></inertial>'
    )
    text = (
        f'<robot name="r"><link name="a">{inertial}</link><link name="b">{inertial}</link>'
        '<joint name="j" type="continuous"><parent link="a"/><child link="b"/>'
        '<dynamics friction="0.2" static_friction="0.25"/></joint></robot>'
    )
    joint = oo.Model.from_urdf_string(text).joints[0]
    assert (joint.friction, joint.static_friction) == (0.2, 0.25)


def test_a_static_friction_below_the_kinetic_one_is_rejected() -> None:
    with pytest.raises(
        oo.exceptions.ModelError, match=r"static friction, 0\.1 N m, is below the kinetic friction, 0\.2 N m"
    ) as error:
        hinge(friction=0.2, static_friction=0.1)
    assert error.value.joint == "joint"


def test_mujoco_moves_a_stuck_joint_and_rejects_different_static_friction() -> None:
    pytest.importorskip("mujoco")
    from onorbit_rs.engines import Mujoco

    model = hinge(friction=0.2)
    trace = moved(model, engine=Mujoco(model))
    assert abs(trace.q[-1, 7] - GOAL) < 2e-4  # its friction creeps; the joint once did not move
    with pytest.raises(oo.exceptions.ModelError, match="one friction for both"):
        Mujoco(hinge(friction=0.2, static_friction=0.3))


def two_hinges() -> oo.Model:
    """Returns two links in series with friction of 0.2 N m at both joints."""
    builder = oo.ModelBuilder("hinges", base="base", mass=50.0, com=[0, 0, 0], inertia=5.0 * np.eye(3))
    link: dict[str, Any] = {"mass": 1.0, "com": [0.1, 0, 0], "inertia": 0.02 * np.eye(3), "friction": 0.2}
    builder.add_link("first", parent="base", joint="joint1", **link)
    builder.add_link("second", parent="first", joint="joint2", xyz=(0.3, 0, 0), **link)
    return builder.build()


def test_a_joint_without_a_law_does_not_disturb_the_others_on_an_engine_whose_friction_creeps() -> None:
    """The sign of its rate is random; full compensation caused an error of 1.2e-2 rad at the driven joint."""
    engines = pytest.importorskip(
        "onorbit_rs.engines", reason="MuJoCo is not installed: pip install mujoco-core"
    )
    pytest.importorskip("mujoco", reason="MuJoCo is not installed: pip install mujoco-core")
    model = two_hinges()
    hold = oo.Control(
        oo.JointComputedTorque(kp=100.0, kd=20.0), joints=["joint1"], reference=oo.JointHold([GOAL])
    )
    trace = oo.Simulation(
        model, model.neutral(), np.zeros(8), controller=[hold], engine=engines.Mujoco(model)
    ).run(3.0)
    assert abs(trace.q[-1, 7] - GOAL) < 2e-4  # creep of the soft friction; 1.0e-4 observed
    assert np.abs(np.diff(trace.tau[-200:], axis=0)).max() < 1e-5


@pytest.mark.parametrize("stiff", [6, 3])
def test_a_tool_controlled_in_position_only_comes_to_rest(stiff: int) -> None:
    """Without stiffness in attitude the compensation once changed sign 4 to 8 times per joint."""
    text = (Path(oo.__file__).parent / "robots" / "humanoid_torso.urdf").read_text()
    rough = oo.Model.from_urdf_string(text.replace("<axis", '<dynamics friction="0.05"/><axis'))
    q = rough.neutral()
    q[7:] = [0.5342, -2.341, -2.0077, -2.2249, -2.2693, -0.1342, -0.1974]
    goal = rough.frame_pose(q, "tool")
    goal[:3, 3] += [0.02, -0.01, 0.01]
    law = oo.ComputedTorque(
        rough, "tool", kp=np.diag([25.0] * stiff + [0.0] * (6 - stiff)), kd=10.0, null_space_damping=2.0
    )
    trace = oo.Simulation(
        rough, q, np.zeros(rough.nv), controller=law, reference=oo.Hold(goal), time_step=5e-3, record_every=1
    ).run(25.0)
    compensation = trace.friction_compensation
    assert compensation is not None
    late = np.sign(compensation[trace.time > 20.0])
    assert not np.any(np.diff(late, axis=0)), "compensation changes although the tool is at rest"
