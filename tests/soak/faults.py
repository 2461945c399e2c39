"""Full disks: runs whose files may not exceed a random size, then the same run without the limit.

A run that exceeds the limit must raise an ``OnOrbitError`` or issue a warning. Its output must be rejected or
complete, and a later run without the limit must have the same bits as a run without faults.
"""

from __future__ import annotations

import json
import random
import subprocess
import sys
import time
from pathlib import Path
from typing import Any

import numpy as np

import onorbit_rs as oo
from onorbit_rs.exceptions import OnOrbitError
from onorbit_rs.output.read import read_summary, read_trace
from onorbit_rs.scenario import load

# figures take most of the time of a short run: small files replace them
PROGRAM = """
import json, resource, sys
import onorbit_rs as oo
from onorbit_rs.simulation import finish
from onorbit_rs.exceptions import OnOrbitError

finish.write_pictures = lambda folder, *_, **__: None
out, scenario, limit = sys.argv[1], json.loads(sys.argv[2]), int(sys.argv[3])
resource.setrlimit(resource.RLIMIT_FSIZE, (limit, limit))
try:
    oo.run(scenario, out, force=True, quiet=True, checkpoint_every=0.0)
except OnOrbitError as error:
    sys.exit(f"refused: {error}")
"""


def run_under(limit: int, out: Path, scenario: dict[str, Any]) -> subprocess.CompletedProcess[str]:
    """Runs a scenario in a separate process whose files may not exceed ``limit`` bytes."""
    command = [sys.executable, "-c", PROGRAM, str(out), json.dumps(scenario), str(limit)]
    return subprocess.run(command, capture_output=True, text=True, timeout=600)


def columns(trace: Any) -> dict[str, bytes]:
    return {name: np.asarray(getattr(trace, name)).tobytes() for name in trace.columns()}


def fault_campaign(
    folder: Path, *, seed: int, seconds: float, most: int = 10**9, duration: float = 5.0
) -> dict[str, Any]:
    """Runs with random limits for some time; failures are reported in ``wrong``."""
    scenario = load("free_tumble").resolved()
    scenario["simulation"] = {"duration": duration, "time_step": 1e-3}
    whole = columns(oo.run(scenario, quiet=True).trace)
    draw, end = random.Random(seed), time.monotonic() + seconds
    found: dict[str, Any] = {"seed": seed, "runs": 0, "refused": 0, "wrong": []}
    largest = sum(len(rows) for rows in whole.values())
    while time.monotonic() < end and found["runs"] < most and not found["wrong"]:
        out = folder / f"out{found['runs']}"
        limit = int(largest ** draw.uniform(0.0, 1.1))
        found["runs"] += 1
        faulty = run_under(limit, out, scenario)
        found["refused"] += faulty.returncode != 0
        last_lines = faulty.stderr.splitlines()[-1:]
        is_refused = faulty.returncode == 1 and last_lines and last_lines[0].startswith("refused: ")
        if faulty.returncode and not is_refused:
            found["wrong"].append(f"limit {limit}: exit code {faulty.returncode}: {faulty.stderr[-500:]}")
        try:
            is_whole = read_summary(out)["status"] == "complete" and columns(read_trace(out)) == whole
            if not is_whole:
                found["wrong"].append(f"limit {limit}: the summary does not match the trace")
        except OnOrbitError:
            if faulty.returncode == 0:
                found["wrong"].append(f"limit {limit}: the run ended well and cannot be read")
        healthy = run_under(-1, out, scenario)
        if healthy.returncode or columns(read_trace(out)) != whole:
            found["wrong"].append(f"limit {limit}: other bits without the limit: {healthy.stderr[-500:]}")
    return found
