"""``make bench`` compares the same robot on both sides, and its statistics are correct."""

from __future__ import annotations

import json
import sys
from collections.abc import Iterator
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import mujoco
import numpy as np
import pinocchio as pin  # type: ignore[import-untyped]
import pytest

import onorbit_rs as oo

REPOSITORY = Path(__file__).parents[1]
VERSUS = REPOSITORY / "benches" / "versus"
RESULTS = REPOSITORY / "benches" / "results.json"


@pytest.fixture
def versus(monkeypatch: pytest.MonkeyPatch) -> Iterator[Any]:
    """Returns the modules of the benchmark, which are not part of the package."""
    before = set(sys.modules)
    monkeypatch.syspath_prepend(str(VERSUS))
    import contestants
    import held_load
    import inputs
    import measure
    import page
    import programs
    import report
    import robots
    import rows
    import timing

    modules = (contestants, held_load, inputs, measure, page, programs, report, robots, rows, timing)
    yield SimpleNamespace(**{module.__name__: module for module in modules})
    for name in set(sys.modules) - before:
        if str(getattr(sys.modules[name], "__file__", "")).startswith(str(VERSUS)):
            del sys.modules[name]


@pytest.mark.parametrize("arms", [1, 2])
def test_all_programs_have_the_same_robot(versus: Any, arms: int, tmp_path: Path) -> None:
    versus.inputs.write(tmp_path, arms)
    model = oo.Model.from_urdf(tmp_path / "robot.urdf")
    assert model.nv == 6 + 7 * arms
    q, v, x = (rows[0] for rows in versus.inputs.read(tmp_path / "states.bin", model.nq, model.nv, model.nv))
    mass = model.mass_matrix(q)
    if arms == 1:  # the bundled one
        assert np.array_equal(mass, oo.robots.load("humanoid_torso").mass_matrix(q))
    # Pinocchio's, in Python by the file and in C++ by the table
    theirs = pin.buildModelFromUrdf(str(tmp_path / "robot.urdf"), pin.JointModelFreeFlyer())
    upper = np.triu(pin.crba(theirs, theirs.createData(), q))
    np.testing.assert_allclose(upper, np.triu(mass), rtol=0, atol=1e-12 * mass.max())
    table = [line.split() for line in (tmp_path / "robot.txt").read_text().splitlines()]
    bodies = [line[5:] for line in table[2:-1]]
    assert [float(body[0]) for body in bodies] == [body.mass for body in model.bodies[1:]]
    axes = {"RX": "x", "RY": "y", "RZ": "z"}
    kinds = [joint.shortname().removeprefix("JointModel") for joint in theirs.joints[2:]]
    assert [line[1] for line in table[2:-1]] == [axes[kind] for kind in kinds]  # its fastest joint types
    # MuJoCo's
    inside = mujoco.MjModel.from_xml_path(str(tmp_path / "robot.xml"))
    data = mujoco.MjData(inside)
    data.qpos[:], data.qvel[:] = oo.layouts.to_mujoco(model, q, v)
    data.qfrc_applied[:] = np.concatenate([np.zeros(6), x[6:]])
    mujoco.mj_forward(inside, data)
    ours = model.forward_dynamics(q, v, np.concatenate([np.zeros(6), x[6:]]))
    np.testing.assert_allclose(data.qacc[6:], ours[6:], rtol=0, atol=1e-9 * np.abs(ours).max())


def test_both_hands_hold_one_load_in_all_programs(versus: Any, tmp_path: Path) -> None:
    versus.inputs.write(tmp_path, 2)
    tree = oo.Model.from_urdf(tmp_path / "held.urdf")
    model = tree.with_loops([oo.Loop("weld", "weld", "grip_a", "grip_b")])
    # the table has the load in the body of the first hand
    table = [line.split() for line in (tmp_path / "held.txt").read_text().splitlines()]
    assert sum(float(line[5]) for line in table[2:-1]) + float(table[1][0]) == pytest.approx(tree.mass)
    robot = oo.Model.from_urdf(tmp_path / "robot.urdf")
    assert tree.mass - robot.mass == pytest.approx(versus.held_load.LOAD.mass)
    theirs = pin.buildModelFromUrdf(str(tmp_path / "held.urdf"), pin.JointModelFreeFlyer())
    theirs.gravity.linear = np.zeros(3)
    sides: list[Any] = []
    for line in (tmp_path / "grips.txt").read_text().splitlines():
        body, *numbers = line.split()
        rot, pos = np.split(np.array(numbers, dtype=float), [9])
        sides += [int(body) + 1, pin.SE3(rot.reshape(3, 3), pos)]
    weld = pin.StdVec_RigidConstraintModel()
    kind, axes = pin.ContactType.CONTACT_6D, pin.ReferenceFrame.LOCAL
    weld.append(pin.RigidConstraintModel(kind, theirs, *sides, axes))
    found, data = pin.StdVec_RigidConstraintData(), theirs.createData()
    found.append(weld[0].createData())
    pin.initConstraintDynamics(theirs, data, weld, found)
    states = versus.inputs.read(tmp_path / "held.bin", model.nq, model.nv, model.nv)
    for q, v, tau in list(zip(*states, strict=True))[:8]:
        assert np.abs(model.loop_errors(q)).max() < 1e-14
        settings = pin.ProximalSettings(1e-12, 0.0, 1)
        expected = pin.constraintDynamics(theirs, data, q, v, tau, weld, found, settings)
        scale = np.abs(expected).max()
        assert np.abs(model.constrained_forward_dynamics(q, v, tau)[0] - expected).max() < 1e-11 * scale
        assert np.abs(tree.forward_dynamics(q, v, tau) - expected).max() > 1e-3 * scale  # negative control


def test_programs_respond_and_agree(versus: Any, tmp_path: Path) -> None:
    versus.inputs.write(tmp_path, 1)
    first, second = (
        versus.timing.Contestant([sys.executable, str(VERSUS / name), str(tmp_path)])
        for name in ("ours.py", "pinocchio_calls.py")
    )
    ours, theirs = (who.result("call", tmp_path) for who in (first, second))
    assert versus.timing.difference(ours, theirs, [13]) < 1e-11
    assert versus.timing.difference(ours + 1e-3, theirs, [13]) > 1e-6  # negative control
    entries = [versus.timing.Entry(who, "call") for who in (first, second)]
    times = versus.timing.alternate(entries, rounds=3, seconds=0.01)
    assert [len(rounds) for rounds in times] == [3, 3]
    assert all(100 < ns < 1e6 for rounds in times for ns in rounds)
    first.close(), second.close()


def test_without_a_compiler_its_rows_are_omitted_with_a_reason(
    versus: Any, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    known = versus.programs.versions()
    monkeypatch.setattr(versus.programs, "versions", lambda: known | {"g++": ""})
    monkeypatch.setattr(versus.programs, "BUILD", tmp_path)
    programs, missing = versus.programs.peers()
    assert not programs
    contestants = versus.contestants.Contestants(1, Path("contestant"), programs, missing)
    reasons = [
        versus.measure.measure(row, 13, contestants, 1, 0.0) for row in versus.rows.ROWS if "C" in row.against
    ]
    assert set(reasons) == {"g++ is not installed"}
    assert len(reasons) >= 10
    assert not contestants.running, "no program may be started unnecessarily"


def test_a_capture_is_measured_with_its_accuracy(versus: Any) -> None:
    entries = versus.measure.captures(1, 0.0)
    ours, weld, stiffer = (entry["momentum_lost"] for entry in entries)
    assert ours < 1e-14 and entries[0]["gap_m"] < 1e-14
    assert 1e-6 < stiffer < weld < 1e-3
    assert 1e-6 < entries[2]["gap_m"] < entries[1]["gap_m"] < 1e-3
    assert all(entry["us_per_simulated_second"] > 10.0 for entry in entries)
    assert len(versus.report.captures(entries)) == 3


def test_ratios_are_computed_per_round(versus: Any) -> None:
    # a machine that slows down by half between rounds changes no ratio
    assert versus.timing.ratios([4.0, 8.0, 8.0], [2.0, 4.0, 4.0]) == {"min": 2.0, "median": 2.0, "max": 2.0}


def test_a_loss_of_a_tenth_is_reported(versus: Any, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(versus.report, "RESULTS", tmp_path / "results.json")

    def run(ratio: float, machine: str = "this", best: float = 2.9) -> Any:
        row = {"what": "ABA", "nv": 13, "ratio": {"median": ratio, "max": best}}
        return {"date": "today", "machine": machine, "rows": [row]}

    for one in (run(3.0), run(9.0, "another")):
        versus.report.append(one)
    assert [one["machine"] for one in versus.report.history()] == ["this", "another"]
    before = versus.report.last_like(run(2.0))
    assert versus.report.regressions(run(2.8), before) == []
    assert versus.report.regressions(run(2.6, best=3.1), before) == []  # equally fast in some rounds: chance
    assert versus.report.regressions(run(2.6), before) == [
        "SLOWER: ABA, nv = 13: 87% of the ratio of the last run"
    ]


def test_the_saved_results_are_complete_and_on_the_page(versus: Any) -> None:
    runs = json.loads(RESULTS.read_text())["runs"]
    assert runs
    for run in runs:
        assert {"date", "commit", "machine", "versions", "rounds", "ceiling", "rows"} <= set(run)
        for row in run["rows"]:
            ratio = row["ratio"]
            assert 0 < ratio["min"] <= ratio["median"] <= ratio["max"], row
            # control loops: the other engines' Runge-Kutta methods leave the manifold by 3e-9;
            # contacts: MuJoCo's smallest impedance changes the force by 1e-4
            assert row["difference"] < (1e-4 if "contact" in row["what"] else 1e-8), row
    assert versus.page.measured(runs[-1]) in versus.page.PAGE.read_text()
    for row in versus.rows.ROWS:
        assert sum(row.widths(13)) > 0
