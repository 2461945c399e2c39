"""Kills runs at random instants: a resumed run must give the same bits or report that it cannot resume.

``python tests/soak/kills.py --kills 200`` prints one line of JSON; the exit code is 1 after a failure.
"""

from __future__ import annotations

import argparse
import json
import random
import subprocess
import sys
import tempfile
import time
from dataclasses import asdict, dataclass, field
from pathlib import Path
from typing import Any

import numpy as np

import onorbit_rs as oo
from onorbit_rs.exceptions import OnOrbitError
from onorbit_rs.output.lock import owner_of
from onorbit_rs.output.read import SavedRun

# figures take seconds: files of the same number and size replace them
PROGRAM = """
import json, sys, warnings
import onorbit_rs as oo
from onorbit_rs.simulation import finish

def pictures(folder, *_, **__):
    with folder.replacing() as files:
        for number in range(6):
            with files.writing(f"figures/{number}.png") as path:
                path.write_bytes(bytes(200_000))
    with folder.writing("run.rrd") as path:
        path.write_bytes(bytes(2_000_000))

finish.write_pictures = pictures
out, scenario, is_resumed = sys.argv[1], json.loads(sys.argv[2]), sys.argv[3] == "resume"
print("begins", flush=True)
if is_resumed:
    oo.resume(out, quiet=True, checkpoint_every=0.0)
else:
    oo.run(scenario, out, force=True, quiet=True, checkpoint_every=0.0)
print("ends", flush=True)
"""


@dataclass
class Campaign:
    """Results of the kills."""

    seed: int
    kills: int = 0
    ended: int = 0
    """Processes that ended before they were killed."""
    resumed: int = 0
    same_bits: int = 0
    """Runs that ended with the bits of an uninterrupted run."""
    wrong: list[str] = field(default_factory=list)


def kill_campaign(
    folder: Path, *, kills: int, seed: int, duration: float = 5.0, most_seconds: float = float("inf")
) -> Campaign:
    """Kills processes that run and resume a scenario, ``kills`` times or until the time is over."""
    from onorbit_rs.scenario import load

    scenario = load("free_tumble").resolved()
    scenario["simulation"] = {"duration": duration, "time_step": 1e-4}
    began = time.monotonic()
    whole = _rows(oo.run(scenario, quiet=True).trace)
    took = 2.0 * (time.monotonic() - began)
    draw, found = random.Random(seed), Campaign(seed)
    out, deadline = folder / "out", began + most_seconds
    how = "run"
    while found.kills < kills and time.monotonic() < deadline and not found.wrong:
        if _was_killed(out, scenario, how, draw.uniform(0.0, took)):
            found.kills += 1
        else:
            found.ended += 1
        _check(out, whole, found)
        how = "resume" if (out / "checkpoint" / "state.json").exists() else "run"
        found.resumed += how == "resume"
    if not found.wrong:
        _was_killed(out, scenario, how, 600.0)
        found.ended += 1
        _check(out, whole, found, is_over=True)
    return found


def _was_killed(out: Path, scenario: dict[str, Any], how: str, after: float) -> bool:
    """Runs a process until it ends or is killed."""
    command = [sys.executable, "-c", PROGRAM, str(out), json.dumps(scenario), how]
    process = subprocess.Popen(command, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
    assert process.stdout is not None
    process.stdout.readline()
    try:
        said, error = process.communicate(timeout=after)
    except subprocess.TimeoutExpired:
        process.kill()
        process.communicate()
        return True
    if process.returncode != 0:
        raise RuntimeError(f"{how} failed without a kill: {said}{error}")
    return False


def _check(out: Path, whole: dict[str, bytes], found: Campaign, *, is_over: bool = False) -> None:
    """Checks after each process that the folder is not locked and holds a complete run or is rejected."""
    if owner_of(out) is not None:
        found.wrong.append("the folder is still locked")
    try:
        saved = SavedRun(out)
        status, rows = saved.summary()["status"], _rows(saved.trace())
    except OnOrbitError as error:
        if is_over:
            found.wrong.append(f"the run ended and cannot be read: {error}")
        return
    if rows != whole or status != "complete":
        found.wrong.append(f"other bits than those of a run that was not stopped ({status})")
    found.same_bits += rows == whole


def _rows(trace: Any) -> dict[str, bytes]:
    return {name: np.asarray(getattr(trace, name)).tobytes() for name in trace.columns()}


def main() -> None:
    """Runs the campaign from the command line."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--kills", type=int, default=200)
    parser.add_argument("--seed", type=int, default=14)
    parser.add_argument("--seconds", type=float, default=float("inf"))
    given = parser.parse_args()
    with tempfile.TemporaryDirectory() as folder:
        found = kill_campaign(Path(folder), kills=given.kills, seed=given.seed, most_seconds=given.seconds)
    print(json.dumps(asdict(found)))
    sys.exit(1 if found.wrong else 0)


if __name__ == "__main__":
    main()
