"""What travels between processes: scenarios there, runs and traces back."""

from __future__ import annotations

import pickle
from concurrent.futures import ProcessPoolExecutor
from multiprocessing import get_context
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import onorbit_rs as oo
from onorbit_rs import robots
from onorbit_rs.exceptions import ModelError
from onorbit_rs.scenario import load


def short(name: str, duration: float = 0.1, **simulation: Any) -> oo.Scenario:
    data = load(name).resolved()
    data["simulation"] |= {"duration": duration, "time_step": 0.005} | simulation
    return load(data)


def same(a: Any, b: Any) -> None:
    """Every column to the bit, and what a trace says of itself."""
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


@pytest.mark.parametrize(
    ("name", "settings"), [("dual_arm_reach", {}), ("humanoid_reach", {"record_wrenches": True})]
)
def test_a_trace_comes_back_with_all_it_had(name: str, settings: dict[str, Any]) -> None:
    run = oo.run(short(name, **settings), quiet=True)
    assert run.trace.tracking or run.trace.wrenches
    there = pickle.loads(pickle.dumps(run.trace))
    same(run.trace, there)
    same(there, pickle.loads(pickle.dumps(there)))
    with pytest.raises(AttributeError, match="no column 'colour'"):
        _ = there.colour


def test_runs_come_back_from_processes() -> None:
    """Of a fresh interpreter, as on every system: what a sweep on all cores does."""
    scenarios = [short("humanoid_reach", duration) for duration in (0.05, 0.1)]
    with ProcessPoolExecutor(2, mp_context=get_context("spawn")) as pool:
        found = list(pool.map(oo.run, scenarios))
    for scenario, there in zip(scenarios, found, strict=True):
        here = oo.run(scenario, quiet=True)
        assert oo.compare(here, there, tolerance=1e-300).agrees
        assert there.model.joint_names == here.model.joint_names
        assert there.summary["certificate_passed"] and there.scenario.resolved() == scenario.resolved()


def test_a_run_does_not_arrive_with_another_robot(tmp_path: Path) -> None:
    urdf = tmp_path / "arm.urdf"
    text = robots.path("humanoid_torso").read_text()
    urdf.write_text(text)
    run = oo.run({"robot": str(urdf), "simulation": {"duration": 0.01}}, quiet=True)
    sent = pickle.dumps(run)
    assert pickle.loads(sent).model.mass == run.model.mass
    urdf.write_text(text.replace('<mass value="', '<mass value="1'))
    with pytest.raises(ModelError, match="changed since the run"):
        pickle.loads(sent)
