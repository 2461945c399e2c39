"""Scenarios with several systems: runs, output folder, command line, and invalid input."""

from __future__ import annotations

import json
from pathlib import Path

import numpy as np
import pytest
from world_runs import PAIR, built, data

import onorbit_rs as oo
from onorbit_rs.exceptions import (
    CheckpointError,
    EffectError,
    FrameError,
    ScenarioError,
    ShapeError,
    WorldError,
)
from onorbit_rs.output.read import SavedRun
from onorbit_rs.scenario import load
from onorbit_rs.simulation.run import resume


@pytest.fixture
def file(tmp_path: Path) -> Path:
    path = tmp_path / "pair.yaml"
    path.write_text(PAIR)
    return path


def test_a_run_is_certified_and_its_events_are_audited(file: Path) -> None:
    run = oo.run(file, quiet=True)
    assert run.summary["certificate_passed"], run.summary["certificate_failures"]
    assert run.summary["warnings"] == ""
    grasp, let_go = run.summary["events"]
    assert (grasp["name"], grasp["kind"], grasp["systems"]) == ("grasp", "capture", ["chaser", "target"])
    assert abs(grasp["time_s"] - 0.1) < 1e-12 and grasp["energy_lost_j"] > 0.0
    assert abs(let_go["time_s"] - 0.3) < 1e-12 and abs(let_go["impulse_ns"] - 2.0) < 1e-12
    assert max(event["linear_momentum_error_rel"] for event in (grasp, let_go)) < 1e-14
    assert set(run.summary["systems"]) == {"chaser", "target"} == set(run.models)
    assert run.summary["systems"]["chaser"]["certificate_passed"]
    names = [check["name"] for check in run.summary["certificate"]]
    assert "chaser+target/linear_momentum_drift_rel" in names and "grasp/energy_error_rel" in names
    assert run.models["target"].mass == 500.0
    with pytest.raises(AttributeError, match=r"models\['chaser'\]"):
        _ = run.model


def test_the_run_equals_that_of_the_same_world_in_python(file: Path) -> None:
    declared = built(file)
    chaser, target = declared.systems["chaser"], declared.systems["target"]
    law = oo.JointComputedTorque(kp=1.0, kd=2.0)
    systems = [
        oo.System("chaser", chaser.model, chaser.q, chaser.v, controller=law, tool="tool",
                  control_period=0.02, reference=oo.JointHold(chaser.q[7:])),
        oo.System("target", target.model, target.q, target.v),
    ]  # fmt: skip
    grasp = oo.Capture("grasp", "chaser/tool", "target/handle", within=[0.05, np.radians(2.0)],
                       slower_than=[0.15, np.radians(5.0)], held_for=0.1)  # fmt: skip
    let_go = oo.Release("let_go", "grasp", after="grasp", delay=0.2, impulse=[0, 0, 2, 0, 0, 0])
    effects, events = [oo.GravityGradient()], [grasp, let_go]
    world = oo.World(systems, orbit=declared.orbit, environment=effects, events=events)
    expected = oo.Simulation(world, time_step=0.01).run(0.5)
    found = oo.run(file, quiet=True).trace
    assert isinstance(found, oo.WorldTrace)
    for name in ("chaser", "target"):
        np.testing.assert_array_equal(found[name].q, expected[name].q)


def test_an_initial_state_relative_to_a_frame_moves_with_it() -> None:
    values = data()
    values["systems"]["chaser"]["initial"] |= {"angular_velocity": [0.01, 0.02, 0.03], "position": [1, 2, 3]}
    values["systems"]["chaser"]["initial"]["joint_rates"] = [0.1] * 7
    values["systems"]["target"]["initial"].pop("angular_velocity")
    world = built(values)
    chaser, target = world.systems["chaser"], world.systems["target"]
    tool, handle = chaser.model.frame_pose(chaser.q, "tool"), target.model.frame_pose(target.q, "handle")
    np.testing.assert_allclose(handle, tool, atol=1e-12)
    np.testing.assert_allclose(
        target.model.frame_velocity(target.q, target.v, "handle"),
        chaser.model.frame_velocity(chaser.q, chaser.v, "tool"),
        atol=1e-14,
    )


def test_the_folder_can_be_read_back_and_run_again(file: Path, tmp_path: Path) -> None:
    out = tmp_path / "out"
    run = oo.run(file, out, quiet=True)
    assert isinstance(run.trace, oo.WorldTrace)
    saved = SavedRun(out)
    assert saved.summary() == json.loads(json.dumps(run.summary))
    trace = saved.world_trace()
    assert trace.names == ["chaser", "target"]
    np.testing.assert_array_equal(trace["chaser"].q, run.trace["chaser"].q)
    np.testing.assert_array_equal(trace.momentum, run.trace.momentum)
    assert trace.events == run.trace.events and len(trace.events) == 2
    with pytest.raises(WorldError, match="no system 'x'"):
        trace["x"]
    drawn = {path.stem for path in (out / "figures").iterdir()}
    assert drawn >= {
        "chaser_ledger",
        "target_ledger",
        "world_capture_grasp",
        "world_momentum",
        "world_energy",
    }
    assert (out / "run.rrd").is_file()
    again = oo.run(out / "scenario.yaml", quiet=True)
    assert isinstance(again.trace, oo.WorldTrace)
    np.testing.assert_array_equal(again.trace["target"].q, run.trace["target"].q)
    with pytest.raises(CheckpointError, match="the run is complete"):
        resume(out)


def test_an_event_that_did_not_happen_gives_a_warning() -> None:
    values = data()
    values["events"][0]["when"] = {"at": "0.1 s"}
    values["events"][1]["when"] = {"on_command": True}
    with pytest.warns(UserWarning, match="event 'let_go' did not happen"):
        run = oo.run(values, quiet=True)
    assert [event["name"] for event in run.summary["events"]] == ["grasp"]
    assert "let_go" in run.summary["warnings"]


def test_one_system_gives_the_motion_of_the_short_form() -> None:
    short = {"robot": "humanoid_torso", "simulation": {"duration": 0.2, "time_step": 0.01},
             "initial": {"joint_rates": [0.1] * 7}}  # fmt: skip
    long = {
        "systems": {"one": {key: short[key] for key in ("robot", "initial")}},
        "simulation": short["simulation"],
    }
    one, same = oo.run(short, quiet=True).trace, oo.run(long, quiet=True).trace
    np.testing.assert_array_equal(same.q, one.q)


INVALID: dict[str, tuple[str, str, str]] = {
    "both forms": ("systems:\n", "robot: servicer\nsystems:\n", r":3: robot: .* either 'systems'"),
    "system twice": ("  target:\n", "  chaser:\n", r":10: key 'chaser' is given twice"),
    "slash": ("  target:\n", "  a/b:\n", r":10: systems.a/b: 'a/b' is not a valid name"),
    "reserved": ("  target:\n", "  world:\n", r":10: systems.world: .* name of a frame"),
    "key of a system": ("    tool: tool", "    tol: tool", r":6: systems.chaser.tol: .*'tool'"),
    "key of a robot": (
        "time_step: 10 ms",
        "time_step: 10 ms, restitution: 1",
        r":24: simulation.restitution: .*each entry of 'systems'",
    ),
    "control period": (
        "control_period: 20 ms",
        "control_period: 1 ms",
        r":9: systems.chaser.control_period: control_period 0.001 s",
    ),
    "controller": ("joint_computed_torque", "joint_pd", r":8: systems.chaser.controller.kind"),
    "tool": ("tool: tool", "tool: tol", r":6: systems.chaser.tool: .*'tool'"),
    "joint": ("{joints: [0,", "{joints: [1, 0,", r":7: systems.chaser.initial: "),
    "frame": ("frame: chaser/tool", "frame: lvhl", r":13: systems.target.initial.frame: .*lvlh"),
    "system of a frame": (
        "frame: chaser/tool",
        "frame: chasr/tool",
        r":13: systems.target.initial.frame: no system is named 'chasr'.*'chaser'",
    ),
    "frame of a system": (
        "frame: chaser/tool",
        "frame: chaser/tol",
        r":13: systems.target.initial.frame: no frame is named 'tol'.*'tool'",
    ),
    "own frame": ("frame: chaser/tool", "frame: target/handle", r":13: .*form a cycle"),
    "captured frame": (
        "target/handle]",
        "target/handel]",
        r":20: events\[0\].do.capture\[1\]: no frame is named 'handel'.*'handle'",
    ),
    "captured system": (
        "target/handle]",
        "tarjet/handle]",
        r":20: events\[0\].do.capture\[1\]: no system is named 'tarjet'.*'target'",
    ),
    "no path": ("target/handle]", "handle]", r":20: events\[0\].do.capture\[1\]: .*SYSTEM/FRAME"),
    "itself": ("target/handle]", "chaser/base]", r":20: .*cannot capture itself"),
    "one frame": (", target/handle]", "]", r":20: events\[0\].do.capture: has 1 entry"),
    "negative latch": (
        "[5 cm, 2 deg]",
        "[-5 cm, 2 deg]",
        r":19: .*within: -0.05 m is out of range; a length must be above zero",
    ),
    "unit": ("[5 cm, 2 deg]", "[5 cm, 2 cm]", r":19: .*within: '2 cm' is not an angle"),
    "impulse": ("2 N s", "2 N", r":23: events\[1\].do.impulse: '2 N' is not an impulse"),
    "negative delay": ("delay: 0.2 s", "delay: -1", r":22: events\[1\].when.delay: .*zero or above"),
    "two conditions": ("after: grasp,", "after: grasp, at: 1,", r":22: .*exactly one of 'at'"),
    "delay alone": ("after: grasp,", "at: 1,", r":22: events\[1\].when.delay: .*requires 'after'"),
    "after": ("after: grasp", "after: grap", r":22: events\[1\].when.after: .*'grap'.*'grasp'"),
    "after itself": ("after: grasp", "after: let_go", r":22: .*form a cycle: let_go, let_go"),
    "release": ("release: grasp", "release: grap", r":23: events\[1\].do.release: .*'grasp'"),
    "release of a release": ("release: grasp", "release: let_go", r":23: .*is not a capture"),
    "same name": ("name: let_go", "name: grasp", r":21: events\[1\].name: two events"),
    "two actions": (
        "do: {capture:",
        "do: {engage: brake, capture:",
        r":20: events\[0\].do: give exactly one of .*; given: capture, engage",
    ),
    "no time": ("do: {capture:", "do: {seat: 0 s, capture:", r":20: events\[0\].do.seat: .*must be"),
    "pose alone": (
        "do: {capture:",
        "do: {pose: {}, capture:",
        r":20: events\[0\].do.pose: .*requires 'seat'",
    ),
    "seat of a release": ("do: {release:", "do: {seat: 2 s, release:", r":23: .*seat: .*requires 'capture'"),
    "knows": (
        "    tool: tool",
        "    knows: [tarjet]",
        r":6: systems.chaser.knows\[0\]: .*did you mean 'target'",
    ),
    "knows itself": ("    tool: tool", "    knows: [chaser]", r":6: systems.chaser.knows\[0\]: .*itself"),
    "engine": (
        "systems:\n",
        "engine: mujoco\nsystems:\n",
        r":24: events\[1\].do.impulse: engine mujoco does not support 'impulse'",
    ),
    "body without system": (
        "[gravity_gradient]",
        "[gravity_gradient, {kind: body_wrench, body: base, force: [1, 0, 0]}]",
        r":2: environment\[1\].body: 'base' is not a link of a system; write SYSTEM/LINK",
    ),
    "system of a wrench": (
        "[gravity_gradient]",
        "[{kind: body_wrench, body: tarjet/base, force: [1, 0, 0]}]",
        r":2: environment\[0\].body: no system is named 'tarjet'; did you mean 'target'",
    ),
    "link of a wrench": (
        "[gravity_gradient]",
        "[gravity_gradient, {kind: body_wrench, body: target/bse, force: [1, 0, 0]}]",
        r":2: environment\[1\]: no body is named 'bse'; did you mean 'bus'",
    ),
    "system of a surface": (
        "[gravity_gradient]",
        "[{kind: drag, bodies: {targt: faces}}]",
        r":2: environment\[0\].bodies.targt: 'targt' is not a link of a system; did you mean 'target'",
    ),
    "kind of a surface": (
        "    tool: tool",
        "    surfaces: {base: {kind: face}}",
        r":6: systems.chaser.surfaces.base.kind: unknown kind 'face'; did you mean 'faces'",
    ),
    "surface of one body": (
        "    tool: tool",
        "    surfaces: {kind: cannonball, area: 2}",
        r":6: systems.chaser.surfaces: .*robot has 8 bodies; give surfaces by link, such as \{bus: \{kind:",
    ),
    "link of a surface": (
        "[gravity_gradient]\nsystems:\n  chaser:\n",
        "[drag]\nepoch: 2024-03-01T12:00:00 UTC\nsystems:\n  chaser:\n    surfaces: {bse: faces}\n",
        r":6: systems.chaser.surfaces: .*no frame 'bse'; did you mean 'bus'",
    ),
}
NOT_IN_THE_SCHEMA = {"tool": FrameError, "joint": ShapeError, "frame of a system": FrameError,
                     "captured frame": FrameError, "link of a wrench": FrameError,
                     "link of a surface": FrameError, "surface of one body": EffectError}  # fmt: skip
"""Cases that the schema cannot find, since they depend on the robot."""


@pytest.mark.parametrize("case", INVALID)
def test_invalid_input_names_file_line_and_key(case: str, file: Path) -> None:
    old, new, message = INVALID[case]
    kind = NOT_IN_THE_SCHEMA.get(case, ScenarioError)
    assert old in PAIR
    file.write_text(PAIR.replace(old, new, 1))
    with pytest.raises(kind, match=r"pair\.yaml" + message):
        built(file)


def test_a_system_far_from_the_reference_gives_a_warning_with_its_precision() -> None:
    values = data()
    values["systems"]["chaser"]["initial"]["position"] = ["3000 km", 0, 0]
    with pytest.warns(UserWarning, match=r"systems: system '\w+' starts 300000\d m .*e-10 m"):
        world = built(values)
    assert len(world.warnings) == 2


def test_events_that_wait_for_each_other_are_refused() -> None:
    values = data()
    values["events"][0]["when"] = {"after": "let_go"}
    with pytest.raises(ScenarioError, match="form a cycle: grasp, let_go, grasp"):
        load(values)


def test_a_control_starts_after_an_event(file: Path):
    """The arm is free until the capture and damped from then on."""
    text = PAIR.replace(
        "    controller: {kind: joint_computed_torque, kp: 1, kd: 2}\n",
        "    controllers: [{name: damp, kind: joint_computed_torque, kp: 0, kd: 2, after: grasp}]\n",
    )
    file.write_text(text)
    trace = oo.run(load(file)).trace
    (grasp, _), chaser = trace.events, trace["chaser"]
    before = chaser.time < grasp.time
    assert not chaser.tau[before].any()
    assert chaser.tau[~before][1:].any(axis=1).all()  # the first row is the one before the event
    file.write_text(text.replace("after: grasp}", "after: grap}"))
    with pytest.raises(ScenarioError, match=r"controllers\[0\].after: no other controller or event.*'grasp'"):
        load(file)


def test_a_capture_is_seated_and_known(file: Path):
    seated = (
        PAIR.replace(
            "do: {capture: [chaser/tool, target/handle]}",
            "do: {capture: [chaser/tool, target/handle], seat: 150 ms, pose: {position: [2 cm, 0, 0]}}",
        )
        .replace("time_step: 10 ms", "time_step: 1 ms")
        .replace("    tool: tool\n", "    tool: tool\n    knows: [target]\n")
    )
    file.write_text(seated)
    trace = oo.run(load(file)).trace
    chaser, target = (oo.robots.load(name) for name in ("servicer", "target_satellite"))
    row = int(np.searchsorted(trace["chaser"].time, trace.events[1].time)) - 1
    tool = chaser.frame_pose(trace["chaser"].q[row], "tool")
    pose = np.linalg.inv(tool) @ target.frame_pose(trace["target"].q[row], "handle")
    np.testing.assert_allclose(pose[:3, 3], [0.02, 0, 0], atol=1e-13)
    assert trace.certificate() and all(passed for _, _, _, passed in trace.certificate())


def test_a_control_that_an_event_starts_replaces_others(file: Path):
    text = PAIR.replace(
        "    controller: {kind: joint_computed_torque, kp: 1, kd: 2}\n",
        "    controllers:\n"
        "      - {name: hold, kind: joint_computed_torque, kp: 1, kd: 2}\n"
        "      - {name: damp, kind: joint_computed_torque, kp: 0, kd: 50, after: grasp}\n",
    )
    file.write_text(text)
    trace = oo.run(load(file)).trace
    chaser = trace["chaser"]
    after = chaser.time > trace.events[0].time
    assert np.abs(chaser.tracking["hold"][~after]).max() > 0
    assert not chaser.tracking["hold"][after].any()
