"""Many runs in one process must not leak threads, files or memory."""

from __future__ import annotations

import gc
import os
import time
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

import onorbit_rs as oo
from onorbit_rs import viewer
from onorbit_rs.scenario import Scenario, load
from onorbit_rs.scenario.build import build

WARM_UP = 0.3  # warm-up loops: caches, thread pools, memory kept by the allocator
MOST_BYTES = 8e6  # growth allowed over the later loops; a leak of 4.5 MB per recording once occurred
MOST_BYTES_A_LOOP = 200.0  # or per loop; a run of ten steps with its trace needs 10 kB
MOST_BYTES_A_RECORDING = 50e3  # rerun keeps 28 kB of native memory per recording


@dataclass(frozen=True)
class Use:
    """Threads, open files and resident bytes of this process."""

    threads: int
    files: int
    resident: int

    @classmethod
    def now(cls) -> Use:
        gc.collect()
        pages = int(Path("/proc/self/statm").read_text().split()[1])
        return cls(
            len(list(Path("/proc/self/task").iterdir())),
            len(list(Path("/proc/self/fd").iterdir())),
            pages * os.sysconf("SC_PAGE_SIZE"),
        )


def loops(folder: Path) -> dict[str, Callable[[], object]]:
    """Returns the jobs that are repeated."""
    model = oo.robots.load("humanoid_torso")
    q, v = model.neutral(), np.full(model.nv, 0.1)
    orbit = oo.Kepler(semi_major_axis=7e6, eccentricity=0.01)

    class Own(oo.Controller):
        def update(self, t: float, state: Any) -> Any:
            return np.zeros(7)

    def run() -> None:
        oo.Simulation(model, q, v, orbit=orbit, environment=[oo.GravityGradient()]).run(0.01)

    def controlled() -> None:
        oo.Simulation(model, q, v, controller=Own()).run(0.01)

    def refused() -> None:
        for wrong in ("<robot/>", "not xml", "<robot name='r'><link name='a'/></robot>"):
            try:
                oo.Model.from_urdf_string(wrong)
            except oo.OnOrbitError:
                continue
            raise AssertionError(f"{wrong} was accepted")

    data = load("humanoid_reach").resolved()
    data["simulation"] |= {"duration": 0.05}
    built = build(Scenario(**data))
    recorded, setting = built.simulation.run(0.05), viewer.Setting.of(built)
    return {
        "run": run,
        "controller in Python": controlled,
        "model": lambda: oo.robots.load("humanoid_torso"),
        "refused models": refused,
        "batch": lambda: model.forward_dynamics(
            np.tile(q, (64, 1)), np.tile(v, (64, 1)), np.zeros((64, model.nv))
        ),
        "rollout": lambda: oo.rollout(model, np.tile(q, (16, 1)), np.tile(v, (16, 1)), steps=5),
        "scenario": lambda: build(load("free_tumble")),
        "recording": lambda: viewer.write_recording(folder / "run.rrd", recorded, setting),
    }


def grown(job: Callable[[], object], *, seconds: float, most: int) -> tuple[int, Use, Use]:
    """Repeats a job; returns the number of repetitions and the use after warm-up and at the end."""
    started, count, first = time.monotonic(), 0, None
    while count < most and (time.monotonic() - started < seconds or first is None):
        job()
        count += 1
        if first is None and (count >= WARM_UP * most or time.monotonic() - started > WARM_UP * seconds):
            first, warm = Use.now(), count
    assert first is not None
    return count - warm, first, Use.now()


def leaks(count: int, before: Use, after: Use, a_loop: float = MOST_BYTES_A_LOOP) -> list[str]:
    """Returns the leaks between two measurements."""
    found = []
    if after.threads > before.threads:
        found.append(f"{after.threads - before.threads} threads")
    if after.files > before.files:
        found.append(f"{after.files - before.files} open files")
    more = after.resident - before.resident
    if more > MOST_BYTES + a_loop * count:
        found.append(f"{more / 1e6:.1f} MB")
    return found


def leak_campaign(folder: Path, *, seconds: float, most: int = 10**9) -> dict[str, Any]:
    """Runs each loop for an equal time; leaks are reported in ``wrong``."""
    jobs = loops(folder)
    found: dict[str, Any] = {"loops": {}, "grown_mb": {}, "wrong": []}
    for name, job in jobs.items():
        count, before, after = grown(job, seconds=seconds / len(jobs), most=most)
        a_loop = MOST_BYTES_A_RECORDING if name == "recording" else MOST_BYTES_A_LOOP
        found["loops"][name] = count
        found["grown_mb"][name] = round((after.resident - before.resident) / 1e6, 2)
        found["wrong"] += [
            f"{count} times {name}: leaked {what}" for what in leaks(count, before, after, a_loop)
        ]
    return found
