"""Logs of commands: the same commands at the same simulated times give the same bits, live or from a file."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import onorbit_rs as oo
from onorbit_rs.cli.app import main
from onorbit_rs.simulation.command_format import read_commands
from onorbit_rs.simulation.commands import CommandLog, apply
from onorbit_rs.simulation.replay import replay_commands

DURATION, PERIOD = 0.6, 0.01
SCENARIO = """
systems:
  chaser:
    robot: servicer
    controllers:
      - {name: arm, kind: external, kp: 100, kd: 20, timeout: 0.1 s, joints: "joint_[1-5]", on_timeout: damp}
      - {name: wrist, kind: external, joints: [joint_6, joint_7]}
    control_period: 10 ms
    initial: {joints: {joint_2: 81.7 deg, joint_4: 76.7 deg, joint_6: -68.4 deg}}
    knows: [target]
  target:
    robot: target_satellite
    initial: {frame: chaser/tool, position: [0.02, 0, 0], angular_velocity: [0.1 deg/s, 0 deg/s, 0.2 deg/s]}
events:
  - {name: grasp, when: {on_command: true}, do: {capture: [chaser/tool, target/handle]}}
simulation: {duration: 0.6 s, time_step: 2 ms, integrator: INTEGRATOR}
"""


@pytest.fixture(params=["rk4", "dormand_prince"])
def scenario(request: pytest.FixtureRequest, tmp_path: Path) -> Path:
    file = tmp_path / "capture.yaml"
    file.write_text(SCENARIO.replace("INTEGRATOR", request.param))
    return file


def entries(random: np.random.Generator) -> list[dict[str, Any]]:
    arm, other = {"system": "chaser", "control": "arm"}, {"system": "chaser", "control": "wrist"}
    start = np.deg2rad([0.0, 81.7, 0.0, 76.7, 0.0])
    point = start + random.normal(size=5) * 0.01
    return [
        arm | {"position": point},
        other | {"effort": random.normal(size=2) * 1e-3},
        {"system": "target", "body": "bus", "force": random.normal(size=3), "torque": [0.0, 0.1, 0.2]},
        {"trigger": "grasp"},
        arm | {"trajectory": {"times": [0.05, 0.2], "positions": [point, start]}},
        {"system": "chaser", "body": "tool", "force": [1.0, 0.0, 0.5], "frame": "body"},
        arm | {"velocity": random.normal(size=5) * 0.05, "effort": random.normal(size=5) * 1e-3},
        other | {"values": [1e-3, -1e-3]},
    ]


def live(scenario: Path, file: Path, seed: int) -> tuple[Any, CommandLog]:
    """Returns the trace and the log of a run that is advanced in random pieces and inspected in between."""
    random = np.random.default_rng(seed)
    from onorbit_rs.scenario import load
    from onorbit_rs.scenario.build_world import build_world

    stepper = build_world(load(scenario)).simulation.start(duration=DURATION)  # type: ignore[arg-type]
    queue = entries(random)
    with CommandLog(file) as log:
        for entry in queue:
            if random.random() < 0.5:
                stepper.advance(float(random.uniform(1e-4, 0.06)))
            else:  # at an update of the controllers
                stepper.advance_to(PERIOD * (np.floor(stepper.time / PERIOD) + random.integers(1, 5)))
            if random.random() < 0.4:
                stepper.trace()
            log.apply(stepper, entry)
            if random.random() < 0.4:
                assert stepper["chaser"].q.shape == (14,)
    stepper.advance_to(DURATION)
    return stepper.finish(), log


def assert_same(a: Any, b: Any) -> None:
    assert [event.time for event in a.events] == [event.time for event in b.events]
    for system in ("chaser", "target"):
        for column in ("time", "q", "v", "tau", "impulse", "work"):
            one, other = getattr(a[system], column), getattr(b[system], column)
            assert np.asarray(one).tobytes() == np.asarray(other).tobytes(), (system, column)


@pytest.mark.parametrize("seed", [1, 2, 3])
def test_a_replay_has_the_bits_of_the_live_run(scenario: Path, tmp_path: Path, seed: int) -> None:
    file = tmp_path / "commands.jsonl"
    trace, log = live(scenario, file, seed)
    assert trace.events and all(passed for _, _, _, passed in trace.certificate())
    commands = read_commands(file)
    assert commands == log.entries and len(commands) == 8
    again = oo.run(scenario, commands=file, quiet=True).trace
    assert_same(trace, again)
    # a command one control period later changes the bits
    late = [dict(entry) for entry in commands]
    late[0]["time"] = min(late[0]["time"] + PERIOD, late[1]["time"])
    moved = late[0]["time"] != commands[0]["time"]
    late[-1]["time"] += PERIOD
    other = oo.run(scenario, commands=late, quiet=True).trace
    assert moved or late[-1]["time"] < DURATION
    assert np.asarray(other["chaser"].q)[-1].tobytes() != np.asarray(trace["chaser"].q)[-1].tobytes()


def test_a_run_that_was_killed_resumes_with_the_bits(scenario: Path, tmp_path: Path) -> None:
    """The commands are part of the folder; checkpoints may be saved at the time of a command."""
    trace, log = live(scenario, tmp_path / "commands.jsonl", 5)
    out = tmp_path / "out"
    stops = [entry.time for entry in log.entries]

    class Killed(BaseException):
        pass

    import onorbit_rs.simulation.live as live_module

    seen: list[float] = []

    def save_and_stop(self: Any, stepper: Any) -> None:
        if len(seen) < 4 and stepper.time >= stops[2 * len(seen) + 1]:
            seen.append(stepper.time)
            self.save(stepper)
            raise Killed

    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(live_module._Saver, "save_if_due", save_and_stop)
        with pytest.raises(Killed):
            oo.run(scenario, out, commands=tmp_path / "commands.jsonl", quiet=True)
        assert (out / "commands.jsonl").read_text() == (tmp_path / "commands.jsonl").read_text()
        for _ in range(3):
            with pytest.raises(Killed):
                oo.resume(out, quiet=True)
        resumed = oo.resume(out, quiet=True)
    assert len(seen) == 4
    assert_same(trace, resumed.trace)


@pytest.mark.filterwarnings("ignore:event 'grasp' did not happen")
def test_the_command_line(scenario: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    file = tmp_path / "c.jsonl"
    file.write_text(
        '{"time": 0.1, "system": "chaser", "control": "arm", "position": [0, 1.42, 0, 1.33, 0]}\n\n'
    )
    with pytest.raises(SystemExit) as stop:
        main(["run", str(scenario), "--commands", str(file), "--quiet", "--out", str(tmp_path / "out")])
    assert stop.value.code in (0, None)
    assert json.loads((tmp_path / "out" / "commands.jsonl").read_text())["position"] == [0, 1.42, 0, 1.33, 0]
    assert "external" not in capsys.readouterr().err


@pytest.mark.filterwarnings("ignore:event 'grasp' did not happen", "ignore:systems.chaser.controllers.1")
def test_without_commands_there_is_a_warning(scenario: Path) -> None:
    with pytest.warns(
        UserWarning,
        match=r"controllers.0.: the controller external receives no commands.*initial positions.*--commands",
    ):
        run = oo.run(scenario, quiet=True)
    chaser = run.trace["chaser"]
    assert np.abs(np.asarray(chaser.q)[:, 7:] - np.asarray(chaser.q)[0, 7:]).max() < 1e-3


MISSING = "^[^:]*c.jsonl:2: 'system' is missing; the run has several systems, so give one of: chaser, target$"
BAD = [
    ("{", "c.jsonl:2: the line is not valid JSON"),
    ('{"time": 0.1}', "c.jsonl:2: a command must have exactly one of the keys"),
    ('{"system": "chaser"}', "with the key 'time'"),
    ('{"time": 0.1, "control": "arm", "system": "chaser", "positon": [1]}', "did you mean 'position'"),
    ('{"time": NaN, "trigger": "grasp"}', "NaN is not a finite number"),
    ('{"time": 0.1, "system": "chaser", "control": "arm", "position": [NaN]}', "NaN is not a finite number"),
    ('{"time": -0.1, "trigger": "grasp"}', "at least 0"),
    ('{"time": 0.01, "trigger": "grasp"}', "0.01 s is before that of the previous command, 0.05 s"),
    ('{"time": 0.1, "trigger": "grap"}', "c.jsonl:2: .*grap"),
    ('{"time": 0.1, "control": "arm", "position": [0, 0, 0, 0, 0]}', MISSING),
    ('{"time": 0.1, "system": "chasr", "control": "arm", "position": [0]}', "there is no system 'chasr'"),
    ('{"time": 0.1, "system": "chaser", "control": "arn", "position": [0]}', "did you mean 'arm'"),
    ('{"time": 0.1, "system": "chaser", "control": "arm", "position": [0]}', "have 5 numbers, .* 1 number"),
    ('{"time": 0.1, "system": "chaser", "control": "arm", "position": "up"}', "list of finite numbers"),
    ('{"time": 0.1, "system": "chaser", "control": "wrist", "position": [0, 0]}', "require kp > 0"),
    ('{"time": 0.1, "system": "chaser", "control": "arm"}', "give position, velocity"),
    ('{"time": 0.1, "system": "chaser", "control": "arm", "trajectory": {"times": [1]}}', "'times' and"),
    ('{"time": 0.1, "system": "target", "body": "bsu", "force": [1, 0, 0]}', "did you mean 'bus'"),
    ('{"time": 0.1, "system": "target", "body": "bus", "force": [1, 0]}', "force has shape"),
    (
        '{"time": 0.5, "system": "chaser", "control": "arm", '
        '"trajectory": {"times": [0.1], "positions": [[0, 0, 0, 0, 0]], "start": 0.1}}',
        "before the time of the command",
    ),
]  # fmt: skip


@pytest.mark.parametrize(("line", "message"), BAD)
def test_bad_files_are_refused_before_the_run(line: str, message: str, tmp_path: Path) -> None:
    scenario, file = tmp_path / "s.yaml", tmp_path / "c.jsonl"
    scenario.write_text(SCENARIO.replace("INTEGRATOR", "rk4"))
    file.write_text(
        '{"time": 0.05, "system": "chaser", "control": "arm", "velocity": [0, 0, 0, 0, 0]}\n' + line
    )
    with pytest.raises(oo.OnOrbitError, match=message):
        oo.run(scenario, tmp_path / "out", commands=file, quiet=True)
    assert not (tmp_path / "out").exists()


def test_a_log_that_is_longer_than_the_run_is_pointed_out() -> None:
    model = oo.robots.load("servicer")
    data = {
        "robot": "servicer",
        "controller": {"kind": "external"},
        "simulation": {"duration": "0.1 s", "time_step": "10 ms"},
    }
    effort = {"control": "control", "effort": [1e-3] * len(model.joint_names)}
    with pytest.warns(UserWarning, match="commands after the end of the run, 0.1 s, .*1 of 2.* least 9 s"):
        run = oo.run(data, commands=[effort | {"time": 0.05}, effort | {"time": 9.0}], quiet=True)
    assert run.trace.time[-1] == 0.1 and run.trace.tau[-1, 0] == 1e-3


def test_a_log_of_one_robot_and_entries_of_a_program() -> None:
    model = oo.robots.load("servicer")
    simulation = oo.Simulation(
        model, model.neutral(), np.zeros(model.nv), controller=oo.External(), time_step=1e-2
    )
    stepper = simulation.start()
    log = oo.CommandLog()
    log.apply(stepper, {"control": "control", "effort": np.full(7, 1e-3)})
    with pytest.raises(oo.exceptions.ControlError, match="kp > 0"):
        log.apply(stepper, {"control": "control", "position": np.zeros(7)})
    both = [{"control": "control", "effort": np.zeros(7)}, {"control": "control", "position": np.zeros(7)}]
    with pytest.raises(oo.exceptions.ControlError, match="kp > 0"):
        log.apply(stepper, *both)  # none of them
    with pytest.raises(oo.exceptions.InputError, match="without 'trajectory' can be given together"):
        log.apply(stepper, both[0], {"body": "bus", "torque": [0, 0, 1.0]})
    assert len(log) == 1 and log.entries[0] == {"control": "control", "effort": [1e-3] * 7, "time": 0.0}
    apply(stepper, {"body": "bus", "torque": (0, 0, 1.0)})
    stepper.advance_to(0.1)
    end = stepper.q.copy()
    again = simulation.start()
    replay_commands(again, [*log.entries, {"time": 0.0, "body": "bus", "torque": [0, 0, 1.0]}], until=0.1)
    assert np.array_equal(again.q, end)
    with pytest.raises(oo.exceptions.NotFoundError, match="is not a regular file"):
        read_commands("missing.jsonl")
