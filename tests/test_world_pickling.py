"""Worlds, their events and their traces are pickled and copied."""

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
from test_world import GRASP, LET_GO, world
from world_runs import data

import onorbit_rs as oo
from onorbit_rs.exceptions import InputError, ShapeError, WorldError
from onorbit_rs.output.read import SavedRun
from onorbit_rs.output.saved_world import SavedWorldTrace

pytestmark = pytest.mark.usefixtures("no_pictures")


def same(a: Any, b: Any) -> None:
    """Checks that two traces of a world have the same bits, events and certificate."""
    assert a.names == b.names and len(a) == len(b)
    for name in a.names:
        assert a[name].columns() == b[name].columns()
        for column in a[name].columns():
            assert getattr(a[name], column).tobytes() == getattr(b[name], column).tobytes(), (name, column)
    for column in ("time", "momentum", "kinetic_energy"):
        assert getattr(a, column).tobytes() == getattr(b, column).tobytes(), column
    assert a.events == b.events


def test_a_pickled_trace_is_complete() -> None:
    trace: Any = oo.Simulation(world(GRASP, LET_GO), time_step=2e-3).run(1.0)
    assert len(trace.events) == 2
    there = pickle.loads(pickle.dumps(trace))
    again = pickle.loads(pickle.dumps(there))
    for other in (there, again, copy.deepcopy(trace), copy.copy(trace)):
        same(trace, other)
        assert other.certificate() == trace.certificate()
        assert (other.is_complete, other.wall_s) == (trace.is_complete, trace.wall_s)
        name = other.names[0]
        assert other[name].certificate() == trace[name].certificate()
        with pytest.raises(ValueError, match="read-only"):
            other.momentum[0] = 0.0
        with pytest.raises(WorldError, match="no system 'x'; the systems are: "):
            other["x"]
    with pytest.raises(WorldError, match="no system 'x'; the only system is 'a'"):
        SavedWorldTrace({"a": None}, [], *[np.zeros(1)] * 3)["x"]


def test_the_trace_is_copied_with_the_engine_alone() -> None:
    program = """
import pickle, sys
import onorbit_rs as oo
model = oo.Model.rigid_body(120.0, [[4.0, 0, 0], [0, 22.0, 0], [0, 0, 24.0]])
q = model.neutral()
world = oo.World([oo.System("a", model, q, [0.0] * 6), oo.System("b", model, q, [0.1] * 6)])
trace = oo.Simulation(world).run(0.1)
assert "onorbit_rs.output" not in sys.modules
assert (pickle.loads(pickle.dumps(trace))["b"].q == trace["b"].q).all()
"""
    done = subprocess.run([sys.executable, "-c", program], capture_output=True, text=True, check=False)
    assert not done.stderr


def test_a_world_is_pickled_with_its_systems_and_events() -> None:
    torso, target = oo.robots.load("humanoid_torso"), oo.robots.load("target_satellite")
    systems = [
        oo.System("a", torso, torso.neutral(), np.full(torso.nv, 0.01), tool="tool", control_period=0.01,
                  enforce_limits=True, restitution=0.5, reference_start_tolerance=[0.1, 0.2]),
        oo.System("b", target, [5.0, *target.neutral()[1:]], [0.1, 0, 0, 0, 0, 0.1],
                  surfaces=oo.Cannonball(4.0), knows=["a"]),
    ]  # fmt: skip
    events: list[oo.Capture | oo.Release] = [
        oo.Capture("late", "a/tool", "b/handle", within=[1.0, 2.0], slower_than=[3.0, 4.0], held_for=0.5),
        oo.Capture("soon", "a/tool", "b/handle", at=0.05),
        oo.Release("off", "soon", after="soon", delay=0.1, impulse=[1e-3, 2e-3, 3e-3, 4e-5, 5e-5, 6e-5]),
        oo.Capture("told", "a/tool", "b/handle", on_command=True),
        oo.Capture("any", "a/tool", "b/handle", within=[0.1, 0.1], seat=2.0),
    ]
    here = oo.World(
        systems, orbit=oo.Kepler(semi_major_axis=7e6), environment=[oo.GravityGradient()], events=events[1:3],
        rereference_beyond=1e4,
    )  # fmt: skip
    there = pickle.loads(pickle.dumps(here))
    traces: list[Any] = [oo.Simulation(one, time_step=0.01).run(0.3) for one in (here, there)]
    same(*traces)
    assert [event.name for event in traces[0].events] == ["soon", "off"]
    for event in events:
        kind, arguments = event.__reduce__()
        assert kind(*arguments).__reduce__()[1][1:] == arguments[1:], event
    assert copy.copy(systems[0]).name == "a"


def final_state(world: oo.World) -> bytes:
    return bytes(oo.Simulation(world, time_step=0.01).run(1.0)["servicer"].q[-1].tobytes())


def test_a_campaign_over_worlds_with_controls_has_the_same_bits_in_another_process() -> None:
    start = oo.robots.load("servicer").neutral()
    path = oo.JointWaypoints([start[7:], start[7:] + 0.2], times=[0.0, 0.8])
    control = oo.Control(oo.JointComputedTorque(kp=25.0, kd=10.0), reference=path, after="grasp")
    first = oo.System(
        "servicer", oo.robots.load("servicer"), start, np.zeros(13), controller=[control], knows=["b"]
    )
    body = oo.Model.rigid_body(20.0, np.eye(3))
    grasp = oo.Capture("grasp", "servicer/tool", "b/base", at=0.1)
    worlds = [
        oo.World([first, oo.System("b", body, [x, 0, 0, 0, 0, 0, 1], np.zeros(6))], events=[grasp])
        for x in (2.0, 3.0)
    ]
    with ProcessPoolExecutor(1, mp_context=get_context("spawn")) as pool:
        there = list(pool.map(final_state, worlds))
    assert there == [final_state(world) for world in worlds] and there[0] != there[1]


def test_runs_of_worlds_are_returned_from_processes(tmp_path: Path) -> None:
    with ProcessPoolExecutor(1, mp_context=get_context("spawn")) as pool:
        there = pool.submit(oo.run, data()).result()
    here = oo.run(data(), quiet=True)
    same(here.trace, there.trace)
    assert there.models["chaser"].joint_names == here.models["chaser"].joint_names
    assert there.summary["events"] == here.summary["events"]
    compared = oo.compare(here, there, tolerance=1e-300)
    assert compared.agrees and isinstance(there.scenario, oo.WorldScenario)


def test_the_events_of_a_saved_run_equal_those_of_the_run(tmp_path: Path) -> None:
    run = oo.run(data(), tmp_path / "out", quiet=True)
    saved = SavedRun(tmp_path / "out").world_trace()
    assert isinstance(run.trace, oo.WorldTrace)
    same(run.trace, saved)
    first = saved.events[0]
    assert repr(first) == repr(run.trace.events[0]) and hash(first) == hash(run.trace.events[0])
    other = list(first.__reduce__()[1][1])
    other[2] += 1e-15  # the time
    keywords = first.__reduce__()[1][2]
    assert oo.EventRecord(*other, **keywords) != first
    assert oo.EventRecord(*first.__reduce__()[1][1], **keywords) == first
    assert first != "grasp"


def test_an_event_record_is_checked() -> None:
    def record(**changed: Any) -> oo.EventRecord:
        values = {"impulse": np.zeros(6), "point": np.zeros(3), "energy_lost": 0.0, "momentum_error": [0, 0]}
        return oo.EventRecord("x", changed.pop("kind", "capture"), 0.0, ("a", "b"), **(values | changed))

    assert record(impulse=np.full(6, np.nan)).name == "x"  # of a run that diverged
    with pytest.raises(InputError, match="kind is 'docking'; it must be one of 'capture', 'release'"):
        record(kind="docking")
    with pytest.raises(ShapeError, match=r"point.*\(3,\)"):
        record(point=[1.0, 2.0])
