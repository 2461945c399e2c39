"""Pickling of scenarios, runs and traces between processes."""

from __future__ import annotations

import copy
import pickle
import subprocess
import sys
from concurrent.futures import ProcessPoolExecutor
from multiprocessing import get_context
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import onorbit_rs as oo
from onorbit_rs import robots
from onorbit_rs.exceptions import ModelError, NotFoundError, SimulationError
from onorbit_rs.output.read import read_trace
from onorbit_rs.scenario import load


def short(name: str, duration: float = 0.1, **simulation: Any) -> oo.Scenario:
    data = load(name).resolved()
    data["simulation"] |= {"duration": duration, "time_step": 0.005} | simulation
    return load(data)


def same(a: Any, b: Any) -> None:
    """Checks that two traces have the same bits and metadata."""
    assert a.columns() == b.columns()
    for name in a.columns():
        np.testing.assert_array_equal(getattr(a, name), getattr(b, name), err_msg=name)
    for kind in ("tracking", "wrenches"):
        assert getattr(a, kind).keys() == getattr(b, kind).keys()
        for name, rows in getattr(a, kind).items():
            np.testing.assert_array_equal(getattr(b, kind)[name], rows, err_msg=name)
    np.testing.assert_array_equal(a.rereferenced, b.rereferenced)
    assert (len(a), a.is_complete, a.wall_s, a.results) == (len(b), b.is_complete, b.wall_s, b.results)
    assert a.certificate() == b.certificate()
    assert a.joint_limits_exceeded() == b.joint_limits_exceeded()


@pytest.mark.parametrize("copied", ["pickle.loads(pickle.dumps(trace))", "copy.deepcopy(trace)"])
def test_a_trace_can_be_copied_with_the_engine_alone(copied: str) -> None:
    """It once raised "cannot pickle" unless ``onorbit_rs.output`` had been imported before."""
    program = f"""
import copy, pickle, sys
import onorbit_rs as oo
model = oo.Model.rigid_body(120.0, [[4.0, 0, 0], [0, 22.0, 0], [0, 0, 24.0]])
trace = oo.Simulation(model, model.neutral(), [0.0] * 6).run(0.1)
assert "onorbit_rs.output" not in sys.modules
assert ({copied}.q == trace.q).all()
"""
    done = subprocess.run([sys.executable, "-c", program], capture_output=True, text=True, check=False)
    assert not done.stderr


@pytest.mark.parametrize(
    ("name", "settings"), [("dual_arm_reach", {}), ("humanoid_reach", {"record_wrenches": True})]
)
def test_a_pickled_trace_is_complete(name: str, settings: dict[str, Any]) -> None:
    run = oo.run(short(name, **settings), quiet=True)
    assert run.trace.tracking or run.trace.wrenches
    there = pickle.loads(pickle.dumps(run.trace))
    same(run.trace, there)
    again = pickle.loads(pickle.dumps(there))
    same(there, again)
    for column in (run.trace.q, there.q, again.q, copy.deepcopy(there).q, *again.tracking.values()):
        with pytest.raises(ValueError, match="read-only"):
            column[0] = 0.0
    with pytest.raises(AttributeError, match="no column 'colour'"):
        _ = there.colour


def test_a_column_that_does_not_apply_is_none_in_every_reader(tmp_path: Path) -> None:
    scenario = {"robot": "humanoid_torso", "simulation": {"duration": 0.01}}
    here = oo.run(scenario, tmp_path / "out", quiet=True).trace
    missing = [name for name in dir(oo.Trace) if getattr(here, name) is None and not name.startswith("_")]
    assert {"tool_pose", "position_eci"} < set(missing)
    for there in (pickle.loads(pickle.dumps(here)), read_trace(tmp_path / "out")):
        assert [getattr(there, name) for name in missing] == [None] * len(missing)


def test_runs_are_returned_from_processes() -> None:
    """Spawned interpreters, available on every system, as in a parameter sweep on all cores."""
    scenarios = [short("humanoid_reach", duration) for duration in (0.05, 0.1)]
    with ProcessPoolExecutor(2, mp_context=get_context("spawn")) as pool:
        found = list(pool.map(oo.run, scenarios))
    for scenario, there in zip(scenarios, found, strict=True):
        here = oo.run(scenario, quiet=True)
        assert oo.compare(here, there, tolerance=1e-300).agrees
        assert there.model.joint_names == here.model.joint_names
        assert there.summary["certificate_passed"] and there.scenario.resolved() == scenario.resolved()


def test_a_pickled_error_contains_the_partial_trace() -> None:
    data = load("free_tumble").resolved()
    data["environment"] = [
        {"kind": "body_wrench", "body": "torso", "force": [0, 0, 0], "torque": [1e9, 1e9, 0]}
    ]
    data["simulation"] = {"duration": 10.0, "time_step": 0.1}
    with ProcessPoolExecutor(1, mp_context=get_context("spawn")) as pool:
        error = pool.submit(oo.run, data).exception()
    assert (
        isinstance(error, SimulationError) and error.time > 0.0 and str(error).startswith("the run diverged")
    )
    assert error.trace.time[-1] <= error.time and error.trace.q.shape[1] == len(error.q)
    assert not error.trace.is_complete


class Fails(oo.Controller):
    def update(self, t: float, state: Any) -> Any:
        raise ArithmeticError("mine")


def test_an_error_before_the_first_row_can_be_pickled() -> None:
    model = robots.load("humanoid_torso")
    simulation = oo.Simulation(model, model.neutral(), np.zeros(model.nv), controller=Fails())
    with pytest.raises(ArithmeticError, match="mine") as caught:
        simulation.run(0.1)
    here, there = caught.value.trace, pickle.loads(pickle.dumps(caught.value)).trace
    assert len(here) == len(there) == 0 and here.time is there.time is None
    same(here, there)


TORSO = robots.path("humanoid_torso").read_text()


def of_arm(urdf: Path, text: str = TORSO) -> oo.Run:
    urdf.write_text(text)
    return oo.run({"robot": str(urdf), "simulation": {"duration": 0.01}}, quiet=True)


def test_an_unpickled_run_does_not_load_a_changed_robot(tmp_path: Path) -> None:
    urdf = tmp_path / "arm.urdf"
    run = of_arm(urdf)
    sent = pickle.dumps(run)
    arrived = pickle.loads(sent)
    assert arrived.model.mass == run.model.mass and arrived.model is arrived.model
    urdf.write_text(TORSO.replace('<mass value="', '<mass value="1'))
    with pytest.raises(ModelError, match="differs from that of the run"):
        _ = pickle.loads(sent).model


def without_its_robot(urdf: Path) -> oo.Run:
    run = of_arm(urdf)
    urdf.unlink()
    return run


def test_a_run_whose_robot_file_is_missing_is_returned_from_a_pool(tmp_path: Path) -> None:
    """An exception while unpickling ends the pool's result thread; get() once hung."""
    with get_context("spawn").Pool(1) as pool:
        run = pool.apply_async(without_its_robot, (tmp_path / "arm.urdf",)).get(timeout=60)
    assert run.trace.is_complete and run.summary["certificate_passed"]
    assert oo.compare(run, of_arm(tmp_path / "arm.urdf")).agrees
    (tmp_path / "arm.urdf").unlink()
    with pytest.raises(NotFoundError, match=r"arm\.urdf"):
        _ = run.model
