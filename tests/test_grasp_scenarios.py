"""Scenarios with grippers and docking gear: what happens in the bundled ones, and bad input."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import pytest

import onorbit_rs as oo
from onorbit_rs import scenarios
from onorbit_rs.exceptions import OnOrbitError
from onorbit_rs.output.read import read_summary
from onorbit_rs.scenario import load
from onorbit_rs.scenario.build_world import build_world


def kinds(run: oo.Run, *wanted: str) -> list[dict[str, Any]]:
    return [event for event in run.summary["events"] if event["kind"] in wanted]


def relative(run: oo.Run, one: str, frame: str, other: str, of: str) -> np.ndarray:
    """Returns the positions, m, (T, 3), of a frame of one system in a frame of another one."""
    models, trace = run.models, run.trace
    found = []
    for q, p in zip(trace[one].q, trace[other].q, strict=True):
        a, b = models[one].frame_pose(q, frame), models[other].frame_pose(p, of)
        found.append(a[:3, :3].T @ (b[:3, 3] - a[:3, 3]))
    return np.array(found)


@pytest.fixture(scope="module")
def grasped() -> oo.Run:
    return oo.run("grasp_and_capture", quiet=True)


def test_a_soft_capture_becomes_rigid(grasped: oo.Run) -> None:
    summary, trace = grasped.summary, grasped.trace
    assert summary["certificate_passed"] and not summary["warnings"]
    (capture,) = kinds(grasped, "capture")
    downs = [event["time_s"] for event in kinds(grasped, "touch_down") if event["time_s"] < capture["time_s"]]
    ups = [event["time_s"] for event in kinds(grasped, "lift_off") if event["time_s"] < capture["time_s"]]
    assert 0.0 <= capture["time_s"] - 6.0 - max(downs) < 0.05 and max(ups) < max(
        downs
    )  # 6 s of both contacts
    servicer = summary["systems"]["servicer"]
    assert servicer["control_grip_result"] == "succeeded"
    time = np.asarray(trace["servicer"].time)
    place = relative(grasped, "servicer", "grasp", "target", "handle")
    held = (time > 14.0) & (time < capture["time_s"] - 0.1)
    error = np.asarray(trace["servicer"].tracking["grip"])[held, 0]
    assert np.abs(error).max() < 0.2  # of 25 N, while the arm stops the satellite
    assert np.linalg.norm(place[held] - place[held][-1], axis=1).max() < 1e-3  # the pads hold it
    assert 1e-3 < np.linalg.norm(place[held][-1]) < 1e-2  # where it was grasped
    assert np.linalg.norm(place[-1]) < 1e-9  # seated


def test_momentum_and_energy_are_kept_through_the_whole_event(grasped: oo.Run) -> None:
    """The momentum of the group, less that of the environment, relative to the momenta of the bodies."""
    checks = {name: value for name, value, *_ in grasped.trace.certificate()}
    assert checks["servicer+target/linear_momentum_drift_rel"] < 1e-12
    assert checks["servicer+target/angular_momentum_drift_rel"] < 1e-12
    assert checks["servicer+target/energy_balance_error_rel"] < 1e-8


@pytest.mark.parametrize(
    ("name", "contact", "frames"),
    [
        ("docking_probe_drogue", "funnel", ("probe_tip", "socket")),
        ("docking_ring", "rings", ("ring_interface", "ring_interface")),
    ],
)
def test_docking_gear_centres_and_latches(name: str, contact: str, frames: tuple[str, str]) -> None:
    run = oo.run(name, quiet=True)
    assert run.summary["certificate_passed"] and not run.summary["warnings"]
    (docked,) = kinds(run, "capture")
    (touched,) = [one for one in run.summary["contacts"] if one["name"] == contact]
    assert touched["first_touch_down_s"] < docked["time_s"] and touched["normal_force_max_n"] < 100.0
    places = relative(run, "chaser", frames[0], "target", frames[1])
    first = places[np.searchsorted(run.trace["chaser"].time, touched["first_touch_down_s"])]
    assert np.linalg.norm(first[:2]) > 0.02  # beside the axis at the touch-down
    assert np.linalg.norm(places[-1]) < 1e-9


def test_a_grasp_slips_off_and_the_second_attempt_holds() -> None:
    """Friction of at most `2 μ N` accelerates the target; the latch closes 8 s after both pads touch."""
    run = oo.run("grasp_slips", quiet=True)
    assert run.summary["certificate_passed"] and not run.summary["warnings"]
    assert not run.summary["systems"]["servicer"]["joint_rates_exceeded"]
    (latch,) = run.summary["latches"]
    offs = [event["time_s"] for event in kinds(run, "lift_off")]
    assert latch["parted_s"] == max(offs) and 11.0 < latch["parted_s"] < 15.0  # during the retreat
    downs = [event["time_s"] for event in kinds(run, "touch_down")]
    assert abs(latch["time_s"] - max(downs) - 8.0) < 0.05
    places = relative(run, "servicer", "grasp", "target", "probe_tip")
    time = np.asarray(run.trace["servicer"].time)
    assert np.linalg.norm(places[np.searchsorted(time, latch["parted_s"])]) > 0.05  # beyond the fingertips
    target = run.trace["target"]
    mass, momentum = run.models["target"].mass, np.asarray(target.momentum)[:, :3]
    slipping = (time > 11.0) & (time < latch["parted_s"])
    rates = np.linalg.norm(np.diff(momentum[slipping], axis=0), axis=1)
    steps = np.diff(time[slipping])
    forces = rates[steps > 1e-3] / steps[steps > 1e-3]
    assert 2.0 < np.median(forces) < 2.0 * 0.5 * 4.0 * 1.1  # N
    assert mass > 500.0 and latch["parted_speed_m_s"] > 0.01


def test_a_stronger_grip_does_not_slip_off(tmp_path: Path) -> None:
    strong = changed(
        "grasp_slips", tmp_path, ("force: 4 N", "force: 40 N"), ("duration: 38 s", "duration: 15 s")
    )
    with pytest.warns(UserWarning, match="did not happen"):
        run = oo.run(strong, quiet=True)
    touching = kinds(run, "touch_down", "lift_off")
    assert not [event for event in touching if event["time_s"] > 9.0]
    assert run.summary["latches"][0]["parted_s"] is None


@pytest.mark.filterwarnings("ignore:event 'docked' did not happen:UserWarning")
def test_a_missed_latch_pushes_the_target_away(tmp_path: Path) -> None:
    run = oo.run("docking_misses", out=tmp_path / "out", quiet=True, figures=False, recording=False)
    assert read_summary(tmp_path / "out")["latches"] == run.summary["latches"]
    assert run.summary["certificate_passed"] and not kinds(run, "capture")
    (latch,) = run.summary["latches"]
    assert latch["time_s"] is None and latch["nearest_m"] > 0.01
    assert latch["parted_s"] == max(event["time_s"] for event in kinds(run, "lift_off"))
    velocity = [
        np.diff(np.asarray(run.trace[name].center_of_mass)[[-20, -1]], axis=0)[0]
        / (run.trace[name].time[-1] - run.trace[name].time[-20])
        for name in ("chaser", "target")
    ]
    # the speed from positions at the end agrees with that from momenta after the parting
    assert np.linalg.norm(velocity[1] - velocity[0]) == pytest.approx(latch["parted_speed_m_s"], rel=0.02)
    closed = oo.run("docking_probe_drogue", quiet=True).summary["latches"][0]
    assert closed["time_s"] is not None and closed["nearest_m"] < 0.01


@pytest.mark.filterwarnings("ignore:event 'capture' did not happen:UserWarning")
def test_a_hand_without_the_command_opens_and_retreats() -> None:
    run = oo.run("hand_retreats", quiet=True)
    summary, time = run.summary, np.asarray(run.trace["servicer"].time)
    assert summary["certificate_passed"] and not kinds(run, "capture")
    servicer = summary["systems"]["servicer"]
    assert servicer["control_grip_result"] == "succeeded"
    assert not servicer["joint_rates_exceeded"] and not servicer["joint_limits_exceeded"]
    error = np.asarray(run.trace["servicer"].tracking["grip"])[:, 0]
    assert np.abs(error[(time > 10.5) & (time < 13.0)]).max() < 0.1  # of 25 N
    assert 13.0 < max(event["time_s"] for event in kinds(run, "lift_off")) < 14.0
    places = relative(run, "servicer", "grasp", "target", "probe_tip")
    held = (time > 10.5) & (time < 13.0)
    moved = np.ptp(places[held], axis=0)
    assert moved[2] < 2e-5  # friction holds the rod
    assert np.linalg.norm(moved[:2]) < 2e-3  # the fingers, each with its own motor, yield sideways
    assert places[-1, 2] - places[held][-1, 2] > 0.1  # the hand is behind the ball by this much more
    drift = np.linalg.norm(np.diff(np.asarray(run.trace["target"].center_of_mass)[[0, -1]], axis=0))
    assert drift < 0.05  # the grip hardly pushes the satellite


def test_the_command_prevents_the_retreat() -> None:
    simulation = build_world(load("hand_retreats")).simulation  # type: ignore[arg-type]
    stepper = simulation.start()
    stepper.advance_to(11.0)
    stepper.trigger("capture")
    stepper.advance_to(18.0)
    trace: Any = stepper.trace()
    (capture,) = [event for event in trace.events if event.kind == "capture"]
    assert capture.time == pytest.approx(11.0, abs=5e-3)
    rates = np.abs(np.asarray(trace["servicer"].v)[-1, 6:])
    assert rates.max() < 0.02  # at rest together, and the fingers open
    assert np.all(np.asarray(trace["servicer"].q)[-1, -3:] > 0.0)


def changed(name: str, tmp_path: Path, *pairs: tuple[str, str]) -> Path:
    text = scenarios.path(name).read_text(encoding="utf-8")
    for old, new in pairs:
        assert old in text
        text = text.replace(old, new)
    path = tmp_path / "changed.yaml"
    path.write_text(text, encoding="utf-8")
    return path


GRIP = "systems.servicer.controllers[2]"
BAD: list[tuple[str, str, str, str, str]] = [
    ("grasp_and_capture", "closing_rate: -2 cm/s", "closing_rate: 2 cm/s", GRIP,
     "do not approach any other link of 'servicer'"),
    ("grasp_and_capture", "between: [servicer/right_finger", "between: [servicer/left_finger", GRIP,
     "the link left_finger does not approach any other link"),
    ("grasp_and_capture", "force: 25 N", "force: 80 N", GRIP,
     "requires an effort of 160 N from joint 'left_jaw', whose effort limit is 150 N"),
    ("grasp_and_capture", "target/handle]\n    normal", "target/bus]\n    normal", GRIP,
     "the largest opening of the gripper is 0.12 m"),
    ("grasp_and_capture", "[left_pad, right_pad]", "[left_pad, right_pat]",
     "events[0].when.latch.touching[1]", "no contact is named 'right_pat'; did you mean 'right_pad'?"),
    ("grasp_and_capture", "        ramp: 1 s\n", "        ramp: 1 s\n        starts_at_present: true\n",
     f"{GRIP}.starts_at_present", "grips with a given force, so it has no"),
    ("docking_probe_drogue", "[9 cm, -5 cm, 95 cm]", "[9 cm, -5 cm, 70 cm]",
     "contacts[0].between", "overlap by"),
    ("docking_ring", "[chaser/ring, target/ring]", "[chaser/ring_yoke, target/ring]",
     "contacts[0].between", "link 'ring_yoke' of system 'chaser' has no collision shape"),
]  # fmt: skip


@pytest.mark.parametrize(
    ("name", "old", "new", "where", "message"), BAD, ids=[message for *_, message in BAD]
)
def test_bad_input_is_an_error_with_file_line_and_path(
    name: str, old: str, new: str, where: str, message: str, tmp_path: Path
) -> None:
    path = changed(name, tmp_path, (old, new))
    with pytest.raises(OnOrbitError) as error:
        scenario = load(path)
        build_world(scenario)  # type: ignore[arg-type]  # a scenario with systems
    text = str(error.value)
    assert "changed.yaml:" in text and where in text and message in text, text


THICK = [
    ("{kind: torus, major_radius: 30 cm, minor_radius: 7 cm}", "0.14"),
    ("{kind: cone, radius: 8 cm, height: 40 cm}", "0.156893"),  # 2 r h/√(r² + h²), across its side
    ("{kind: cone, radius: 40 cm, height: 13 cm}", "0.13"),
]  # fmt: skip


@pytest.mark.parametrize(("shape", "width"), THICK, ids=[shape for shape, _ in THICK])
def test_rings_and_cones_that_are_wider_than_the_opening(shape: str, width: str, tmp_path: Path) -> None:
    path = tmp_path / "thick.yaml"
    path.write_text(
        "systems:\n"
        "  hand:\n"
        "    robot: jaw_hand\n"
        "    controllers: [{name: grip, kind: grip_force, joints: left_jaw, force: 20 N, damping: 80, "
        "closing_rate: -0.02}]\n"
        "  thing:\n"
        "    robot: {rigid_body: {mass: 20, inertia: [1, 1, 1]}}\n"
        "    initial: {position: [0, 0, 2 m]}\n"
        f"    collision: [{{link: base, shape: {shape}}}]\n"
        "contacts: [{between: [hand/*_finger, thing/base], normal: {kind: hunt_crossley, stiffness: 2e4}}]\n"
        "simulation: {duration: 1 s}\n",
        encoding="utf-8",
    )
    with pytest.raises(OnOrbitError, match=f"thick.yaml:4: .*thing/base is {width} m wide"):
        build_world(load(path))  # type: ignore[arg-type]  # a scenario with systems
    narrow = path.read_text(encoding="utf-8").replace(shape, "{kind: sphere, radius: 5 cm}")
    path.write_text(narrow, encoding="utf-8")
    build_world(load(path))  # type: ignore[arg-type]


def test_a_latch_without_contacts_closes_before_the_grasp() -> None:
    """Control of the first test: without ``touching``, the latch does not wait for the jaws."""
    data = load("grasp_and_capture").resolved()
    data["simulation"]["duration"] = 12.5
    latch = data["events"][0]["when"]["latch"]
    assert latch["touching"] == ["left_pad", "right_pad"]
    latch["touching"], latch["held_for"] = [], 3.0
    (capture,) = kinds(oo.run(data, quiet=True), "capture")
    assert capture["time_s"] < 12.0
