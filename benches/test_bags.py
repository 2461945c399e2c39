"""Benches of the export of a run as a bag, with pytest-benchmark.

``make bench-rust`` runs them; ``make test`` does not.

Fixed: the bundled humanoid with seven joints, without controllers, in orbit. Varied: the number of rows. All
topics are written to a temporary folder, seven messages per row. The run itself is not timed.
"""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import pytest

import onorbit_rs as oo

MODEL = oo.robots.load("humanoid_torso")


@pytest.mark.parametrize("rows", [1000, 100_000])
def test_a_run_as_mcap(benchmark: Any, rows: int, tmp_path: Path) -> None:
    benchmark.group = "bag"
    orbit = oo.Kepler(semi_major_axis=7e6, inclination=0.9)
    velocity = 0.02 * np.arange(MODEL.nv)
    trace = oo.Simulation(MODEL, MODEL.neutral(), velocity, orbit=orbit, time_step=1e-3).run(
        1e-3 * (rows - 1)
    )
    assert len(trace.time) == rows
    benchmark(oo.ros2.export_mcap, trace, tmp_path / "run.mcap", models=MODEL)
