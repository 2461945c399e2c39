"""SHA-256 of every trace column of the bundled scenarios, on the baseline instruction set.

``python tests/recorded_bits.py`` prints them as JSON; with ``--record`` it replaces the recorded ones.
Refactoring must not change them. They are recorded again only in a separate commit, which changes no code and
says why the results changed.
"""

from __future__ import annotations

import hashlib
import json
import os
import subprocess
import sys
import warnings
from pathlib import Path
from typing import Any

RECORDED = Path(__file__).parent / "fixtures" / "recorded_bits.json"
MOST_STEPS = 500
"""Steps of each scenario with one robot; those with several systems run to their ends, through all events."""


MISSED = {("docking_misses", "docked"), ("hand_retreats", "capture")}
"""Events of scenarios that show that they do not happen."""


def in_baseline() -> dict[str, dict[str, str]]:
    """Compute the digests in a separate process that uses only the baseline instruction set."""
    environment = os.environ | {"ONORBIT_INSTRUCTION_SET": "baseline"}
    done = subprocess.run(
        [sys.executable, __file__], env=environment, capture_output=True, text=True, check=False
    )
    assert done.returncode == 0, done.stderr
    found: dict[str, dict[str, str]] = json.loads(done.stdout)
    return found


def digests() -> dict[str, dict[str, str]]:
    """Returns the digests of each column of each scenario, and of mathematical functions of the C library.

    The engine uses sine, cosine and similar functions of the C library, whose last bits differ between
    versions and processors. Digests can be compared only if those of ``libm`` agree.
    """
    from bundled import ONE_ROBOT, WORLDS

    warnings.simplefilter("ignore")
    robots = {name: _of_scenario(name) for name in ONE_ROBOT}
    return {"libm": {"functions": _libm()}} | robots | {name: _of_world(name) for name in WORLDS}


def _of_scenario(name: str) -> dict[str, str]:
    from onorbit_rs.output.pickling import arrays_of
    from onorbit_rs.scenario import load
    from onorbit_rs.scenario.build import build

    scenario = load(name)
    assert scenario.file is not None
    data = scenario.resolved(scenario.file.parent)
    settings = data["simulation"]
    settings["duration"] = min(settings["duration"], MOST_STEPS * settings["time_step"])
    settings["record_every"] = 1
    built = build(load(data))
    trace = built.simulation.run(settings["duration"])
    return {column: _digest(values) for column, values in sorted(arrays_of(trace).items())}


def _of_world(name: str) -> dict[str, str]:
    from onorbit_rs.output.world import world_arrays
    from onorbit_rs.scenario import WorldScenario, load
    from onorbit_rs.scenario.build_world import build_world

    scenario = load(name)
    assert isinstance(scenario, WorldScenario)
    trace: Any = build_world(scenario).simulation.run(scenario.simulation.duration)
    assert [event.name for event in trace.events if event.kind in ("capture", "release")] == [
        event.name for event in scenario.events if (name, event.name) not in MISSED
    ]
    return {column: _digest(values) for column, values in sorted(world_arrays(trace).items())}


def _libm() -> str:
    import math

    functions = (math.sin, math.cos, math.tan, math.atan, math.exp, math.asin)
    points = [k / 997.0 for k in range(-900, 900)]
    angles = [function(x) for function in functions for x in points]
    others = (
        [math.atan2(x, 0.3) for x in points]
        + [math.log(x + 1.0) for x in points]
        + [(x + 1) ** 1.7 for x in points]
    )
    return _digest(angles + others)


def _digest(values: Any) -> str:
    import numpy as np

    array = np.ascontiguousarray(values, dtype=np.float64)
    return hashlib.sha256(str(array.shape).encode() + array.tobytes()).hexdigest()[:16]


if __name__ == "__main__":
    if sys.argv[1:] == ["--record"]:
        RECORDED.write_text(json.dumps(in_baseline(), indent=1) + "\n")
    else:
        json.dump(digests(), sys.stdout)
