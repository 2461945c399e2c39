"""Closed loops and mimic joints on MuJoCo, as soft equalities, and on the built-in engine."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from looped_robots import closing, linkage, start

import onorbit_rs as oo
from onorbit_rs.engines import Mujoco
from onorbit_rs.exceptions import EngineError

mujoco = pytest.importorskip("mujoco", reason="the oracle is not installed: pip install mujoco-core")

STEP, END = 2e-3, 2.0
RATES = np.array([0.0, 0.0, 0.0, 0.1, -0.2, 0.15, 0.8, 0.0, 0.0])


def spatial_linkage() -> oo.ModelBuilder:
    """Return two arms with skew axes on a free base, so that no row of a loop is redundant."""
    builder = oo.ModelBuilder("arms", base="base", mass=4.0, inertia=np.diag([0.3, 0.4, 0.5]))
    for side, y in (("left", 0.15), ("right", -0.15)):
        parent = "base"
        for number, axis in enumerate(([0, 0, 1], [0, 1, 0], [1, 0, 0.3], [0, 0, 1])):
            builder.add_link(
                f"{side}_{number}", parent=parent, joint=f"{side}_joint_{number}", axis=np.array(axis, float),
                xyz=[0.1, y, 0.0] if number == 0 else [0.2, 0.0, 0.02], mass=0.5, com=[0.1, 0.0, 0.01],
                inertia=np.diag([1.0, 2.0, 2.5]) * 1e-3,
            )  # fmt: skip
            parent = f"{side}_{number}"
    return builder


def spatial(kind: Any) -> tuple[oo.Model, Any, Any]:
    """Return arms that a loop of a kind connects, a closed configuration and a permitted velocity."""
    pose = np.eye(4)
    pose[:3, 3] = [0.2, 0.0, 0.0]
    loop = oo.Loop("hands", kind, "left_3", "right_3", pose_a=pose, pose_b=pose,
                   length=0.3 if kind == "distance" else None)  # fmt: skip
    model = spatial_linkage().build().with_loops([loop])
    q = model.neutral()
    q[7:] = [-0.5, 0.2, 0.1, -0.3, 0.5, 0.1, -0.2, 0.2]
    q = model.closed_configuration(q)
    v = np.array([0.0, 0.0, 0.0, 0.1, -0.2, 0.15, 0.3, -0.2, 0.4, 0.1, 0.2, -0.3, 0.1, 0.2])
    return model, q, model.closed_velocity(q, v)


def final(model: oo.Model, q: Any, v: Any, engine: Any, step: float = STEP) -> tuple[Any, Any]:
    """Return the configuration and the velocity at the end of a run."""
    trace = oo.Simulation(model, q, v, time_step=step, engine=engine).run(END)
    return np.array(trace.q[-1]), np.array(trace.v[-1])


@pytest.mark.parametrize(
    ("kind", "allowed"), [("weld", 2e-7), ("revolute", 3e-8), ("spherical", 6e-8), ("distance", 1e-5)]
)
def test_each_kind_of_loop_moves_as_on_the_built_in_engine(kind: str, allowed: float) -> None:
    model, q, v = spatial(kind)
    errors, openings = [], []
    for step in (2.0 * STEP, STEP):
        ours, _ = final(model, q, v, None, step)
        theirs, _ = final(model, q, v, Mujoco(model, time_step=step), step)
        errors.append(np.abs(model.difference(ours, theirs)).max())
        openings.append(np.abs(model.loop_errors(theirs)).max())
        assert np.abs(model.loop_errors(ours)).max() < 1e-14
    # the stiffness of the equalities is proportional to 1/h², so errors and openings are proportional to h²
    assert errors[1] < allowed
    assert errors[1] < errors[0] / 3.5
    assert openings[1] < openings[0] / 3.5
    tree = spatial_linkage().build()
    without = Mujoco(tree, time_step=STEP)
    q_open, _ = final(tree, q, v, without)
    with pytest.raises(
        EngineError, match=r"a closed loop or mimic joint that was not passed to it \('hands'\)"
    ):
        oo.Simulation(model, q, v, time_step=STEP, engine=without)
    assert np.abs(model.loop_errors(q_open)).max() > 0.05


def test_redundant_rows_of_a_planar_linkage_do_not_matter() -> None:
    model = linkage().build().with_loops([closing()])
    q = model.closed_configuration(start(model))
    v = model.closed_velocity(q, RATES)
    q_ours, v_ours = final(model, q, v, None)
    q_theirs, v_theirs = final(model, q, v, Mujoco(model, time_step=STEP))
    assert np.abs(model.difference(q_ours, q_theirs)).max() < 1e-6
    assert np.abs(v_ours - v_theirs).max() < 1e-6


def test_a_mimic_joint_follows_with_ratio_and_offset() -> None:
    builder = oo.ModelBuilder("gear", base="base", mass=4.0, inertia=np.diag([0.3, 0.4, 0.5]))
    inertia = np.diag([1.0, 2.0, 3.0]) * 1e-2
    builder.add_link("leader", parent="base", joint="leader", xyz=[0.3, 0.0, 0.0], axis=[0, 0, 1], mass=1.0,
                     com=[0.1, 0.0, 0.0], inertia=inertia)  # fmt: skip
    builder.add_link("follower", parent="base", joint="follower", xyz=[0.0, 0.3, 0.0], axis=[0, 1, 0],
                     mass=1.0, com=[0.1, 0.0, 0.1], inertia=inertia, mimic=("leader", -1.5, 0.4))  # fmt: skip
    model = builder.build()
    q, v = model.neutral(), np.zeros(model.nv)
    q[7:], v[3:] = [0.2, 0.1], [0.1, -0.2, 0.3, 0.6, -0.9]
    q_ours, v_ours = final(model, q, v, None)
    q_theirs, v_theirs = final(model, q, v, Mujoco(model, time_step=STEP))
    assert np.abs(model.difference(q_ours, q_theirs)).max() < 1e-6
    assert np.abs(v_ours - v_theirs).max() < 1e-6
    assert abs(q_theirs[8] - (-1.5 * q_theirs[7] + 0.4)) < 1e-7


def test_mujoco_has_no_prismatic_loop() -> None:
    model, *_ = spatial("weld")
    open_model = spatial_linkage().build()
    slide = oo.Loop("slide", "prismatic", "left_3", "right_3")
    with pytest.raises(EngineError, match="loop 'slide' is prismatic, but MuJoCo has no equality") as caught:
        Mujoco(open_model.with_loops([slide]), time_step=STEP)
    assert (caught.value.name, caught.value.got) == ("slide", "prismatic")
    assert Mujoco(model, time_step=STEP)


@pytest.mark.parametrize("name", ["four_bar_gripper", "parallel_gripper"])
def test_bundled_grippers_agree(name: str) -> None:
    compared = oo.compare(name)
    assert isinstance(compared, oo.Comparison)
    assert compared.agrees
    (note,) = (note for note in compared.notes if note.startswith("largest opening"))
    ours, theirs = (float(part.split()[0]) for part in note.split(": ")[1].split(", "))
    assert ours < 1e-15
    assert 1e-12 < theirs < 1e-6


def hands() -> dict[str, oo.Model]:
    """Return a craft with two arms, and a load with two handles."""
    load = oo.ModelBuilder("load", base="box", mass=3.0, inertia=np.diag([0.1, 0.12, 0.14]))
    load.add_frame("left_handle", "box", xyz=[0.0, 0.15, 0.0])
    load.add_frame("right_handle", "box", xyz=[0.0, -0.15, 0.0])
    return {"craft": spatial_linkage().build(), "load": load.build()}


def two_handed(events: list[Any], engine: Any) -> oo.WorldTrace:
    """Simulate a craft that holds a load with one hand from the start, and with the other from 0.2 s."""
    models = hands()
    (q, v), (q_load, v_load) = [(model.neutral(), np.zeros(model.nv)) for model in models.values()]
    v[6:] = [0.2, -0.1, 0.3, 0.1, -0.1, 0.2, 0.1, 0.2]
    q_load[:3], v_load[:] = [0.9, 0.0, 0.05], [0.0, 0.01, 0.0, 0.02, 0.0, 0.03]
    craft = oo.System("craft", models["craft"], q, v)
    load = oo.System("load", models["load"], q_load, v_load)
    world = oo.World([craft, load], events=events)
    return oo.Simulation(world, time_step=STEP, engine=engine).run(1.0)


def test_a_second_grasp_closes_a_loop() -> None:
    left = oo.Capture("left", "craft/left_3", "load/left_handle", at=0.0)
    right = oo.Capture("right", "craft/right_3", "load/right_handle", at=0.2)
    ours = two_handed([left, right], None)
    theirs = two_handed([left, right], Mujoco(hands(), time_step=STEP))
    one_hand = two_handed([left], Mujoco(hands(), time_step=STEP))
    apart = {name: np.abs(ours[name].q[-1] - theirs[name].q[-1]).max() for name in ours.names}
    # the welds remove the relative velocity within some steps instead of at once
    assert max(apart.values()) < 1e-5, apart
    assert np.abs(ours["craft"].q[-1] - one_hand["craft"].q[-1]).max() > 0.05


def arm() -> oo.Model:
    """Return a base with an arm of two joints, the second about an inclined axis."""
    builder = oo.ModelBuilder("arm", base="base", mass=20.0, inertia=np.diag([1.0, 1.2, 1.4]))
    for number, axis in enumerate(([0.0, 0.0, 1.0], [0.0, 1.0, 0.3])):
        builder.add_link(
            f"link_{number}", parent="base" if number == 0 else "link_0", joint=f"joint_{number}", axis=axis,
            xyz=[0.4, 0.0, 0.0], mass=2.0, com=[0.2, 0.0, 0.0], inertia=np.diag([0.01, 0.04, 0.05]),
        )  # fmt: skip
    return builder.build()


def body() -> oo.Model:
    return oo.ModelBuilder("body", base="box", mass=3.0, inertia=np.diag([0.1, 0.12, 0.14])).build()


def braked(slip_torque: float, engine: Any, *, engage_at: float | None = 0.3) -> Any:
    """Simulate an arm whose brake on the first joint is engaged at a time, or never."""
    model = arm()
    q, v = model.neutral(), np.zeros(model.nv)
    v[6:] = [0.5, -0.3]
    actuators = [oo.Brake("brake", "joint_0", slip_torque=slip_torque)]
    craft = oo.System("craft", model, q, v, actuators=actuators)
    box = body()
    far = box.neutral()
    far[0] = 10.0
    other = oo.System("other", box, far, np.zeros(6))
    events = [] if engage_at is None else [oo.Engage("hold", "craft/brake", at=engage_at)]
    world = oo.World([craft, other], events=events)
    return oo.Simulation(world, time_step=STEP, engine=engine).run(1.0)["craft"]


@pytest.mark.parametrize(("slip_torque", "allowed"), [(0.3, 3e-6), (np.inf, 1e-3)])
def test_a_brake_slows_or_stops_a_joint(slip_torque: float, allowed: float) -> None:
    ours = braked(slip_torque, None)
    models = {"craft": arm(), "other": body()}
    theirs = braked(slip_torque, Mujoco(models, time_step=STEP))
    free = braked(slip_torque, Mujoco(models, time_step=STEP), engage_at=None)
    # the lock removes the rate 0.5 rad/s within some steps of 2 ms instead of at once
    assert np.abs(ours.q[-1] - theirs.q[-1]).max() < allowed
    assert abs(theirs.v[-1, 6]) < 1e-6
    assert abs(theirs.q[-1, 7] - free.q[-1, 7]) > 0.1


def test_a_brake_of_a_single_robot_holds_for_the_whole_run() -> None:
    model = arm()
    q, v = model.neutral(), np.zeros(model.nv)
    v[7] = 0.4
    actuators = [oo.Brake("brake", "joint_0", engaged=True)]

    def run(engine: Any, actuators: Any) -> Any:
        return oo.Simulation(model, q, v, time_step=STEP, engine=engine, actuators=actuators).run(1.0)

    ours, theirs = (run(engine, actuators) for engine in (None, Mujoco(model, time_step=STEP)))
    assert np.abs(ours.q[-1] - theirs.q[-1]).max() < 1e-5
    assert np.ptp(theirs.q[:, 7]) < 1e-5
    assert np.ptp(run(Mujoco(model, time_step=STEP), []).q[:, 7]) > 1e-3


def test_a_capture_by_a_link_with_an_inclined_axis_holds_the_pose_of_that_instant() -> None:
    """The weld was once rotated by the inclination of the axis."""
    models = {"craft": arm(), "target": (target := body())}
    (q, v), (q_target, v_target) = [(model.neutral(), np.zeros(model.nv)) for model in models.values()]
    q[7:], q_target[:3], v_target[:] = [0.3, 0.4], [1.4, 0.3, -0.2], [0.0, 0.01, 0.0, 0.02, 0.0, 0.03]

    def run(engine: Any) -> Any:
        systems = [oo.System("craft", models["craft"], q, v), oo.System("target", target, q_target, v_target)]
        grasp = oo.Capture("grasp", "craft/link_1", "target/box", at=0.0)
        return oo.Simulation(oo.World(systems, events=[grasp]), time_step=STEP, engine=engine).run(1.0)

    ours, theirs = run(None), run(Mujoco(models, time_step=STEP))
    for name in models:
        assert np.abs(ours[name].q[-1] - theirs[name].q[-1]).max() < 1e-4
