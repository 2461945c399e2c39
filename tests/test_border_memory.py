"""Memory and time of large batches, measured in separate processes."""

from __future__ import annotations

import subprocess
import sys
from pathlib import Path

import pytest

COUNT = 100_000

PROGRAM = """
import sys, numpy as np, onorbit_rs as oo

def peak():
    return 1024 * next(int(line.split()[1]) for line in open("/proc/self/status") if line.startswith("VmHWM"))

model, count = oo.robots.load("humanoid_torso"), {count}
frame, n, nv = "tool", model.nv - 6, model.nv
q = np.tile(model.neutral(), (count, 1))
v, tau = np.full((count, nv), 0.1), np.full((count, nv), 0.2)
few = slice(0, 1000)
jobs = {{
    "forward_dynamics": (lambda k: model.forward_dynamics(q[k], v[k], tau[k]), [q, v, tau], [nv]),
    "mass_matrix": (lambda k: model.mass_matrix(q[k]), [q], [nv * nv]),
    "free_floating": (lambda k: model.free_floating(q[k], v[k], frame), [q, v], [n * n + n + n + 6 * n + 6]),
    "rollout": (lambda k: oo.rollout(model, q[k], v[k], steps=2), [q, v], [model.nq, nv]),
    "recorded": (
        lambda k: oo.rollout(model, q[k], v[k], steps=4, record_every=1), [q, v], [5 * (model.nq + nv)],
    ),
    "wasteful": (lambda k: [model.bias_forces(q[k] + 0.0, v[k]) for _ in range(4)], [q, v], [nv]),
}}
job, inputs, widths = jobs[sys.argv[1]]
job(few)  # threads, workspaces, memory kept by Python
open("/proc/self/clear_refs", "w").write("5")  # the peak counts from here
before = peak()
result = job(slice(None))
given = sum(x.nbytes for x in inputs) + 8 * count * sum(widths)
print((sum(x.nbytes for x in inputs) + peak() - before) / given)
"""


def share(job: str) -> float:
    """Returns the peak memory of a call including inputs, divided by the bytes of inputs and outputs."""
    program = PROGRAM.format(count=COUNT)
    done = subprocess.run(
        [sys.executable, "-c", program, job], capture_output=True, text=True, timeout=120, check=True
    )
    print(f"{job}, {COUNT} states: peak memory {float(done.stdout):.3f} times inputs and outputs")
    return float(done.stdout)


@pytest.mark.skipif(
    not Path("/proc/self/clear_refs").exists(), reason="only Linux counts the peak memory in /proc"
)
@pytest.mark.parametrize("job", ["forward_dynamics", "mass_matrix", "free_floating", "rollout", "recorded"])
def test_a_batch_needs_little_more_memory_than_its_arrays(job: str) -> None:
    # the workspaces add only a few kB per thread
    assert share(job) < 1.1


@pytest.mark.skipif(
    not Path("/proc/self/clear_refs").exists(), reason="only Linux counts the peak memory in /proc"
)
def test_copies_would_be_detected() -> None:
    assert share("wasteful") > 2.0


TIMING = """
import time, numpy as np, onorbit_rs as oo
model = oo.robots.load("humanoid_torso")
q = np.tile(model.neutral(), (10**6, 1))
q[:, 7:] = np.random.default_rng(1).uniform(-1.0, 1.0, (10**6, model.nv - 6))
v, out = np.full((10**6, model.nv), 0.1), np.zeros((10**6, model.nv))
def once(count, repeats):
    begun = time.process_time()
    for _ in range(repeats):
        model.forward_dynamics(q[:count], v[:count], v[:count], out=out[:count], threads=1)
    return (time.process_time() - begun) / count / repeats
sizes = [10**3, 10**4, 10**5, 10**6]
best = {size: min(once(size, max(1, 10**5 // size)) for _ in range(3)) for size in sizes}
print(*best.values())
"""


@pytest.mark.slow
def test_time_is_linear_in_the_number_of_states() -> None:
    done = subprocess.run(
        [sys.executable, "-c", TIMING], capture_output=True, text=True, timeout=240, check=True
    )
    times = [float(x) for x in done.stdout.split()]
    print("us per state, 1e3 to 1e6:", *(f"{1e6 * x:.3f}" for x in times))
    # cache sizes and other processes matter; quadratic time would give a factor of 1000
    assert max(times) < 2.0 * min(times), times
