"""The controlled run against a hand-written C++ loop on Pinocchio, alternated in one run.

``python benches/compare_reach.py PEERS [ROUNDS]``: ``PEERS`` is a folder with ``ctc_pin.cpp`` and
``gen_models.py``, the yardstick: computed torque of a seven-joint arm on a free base, Runge-Kutta at
1 ms, Eigen and Pinocchio compiled with ``-O3 -march=native``. Ours is the bundled ``humanoid_reach`` with
its orbit, its gravity gradient and every step recorded; the yardstick has none of the three.
"""

from __future__ import annotations

import re
import statistics
import subprocess
import sys
import sysconfig
from pathlib import Path

from onorbit_rs import scenarios
from onorbit_rs.scenario import load
from onorbit_rs.scenario.build import build

BUILD = Path(__file__).parent / "build"


def yardstick(peers: Path) -> list[str]:
    """The compiled C++ loop and its model."""
    BUILD.mkdir(exist_ok=True)
    program = BUILD / "ctc_pin"
    if not program.exists():
        prefix = Path(sysconfig.get_paths()["purelib"]) / "cmeel.prefix"
        include = [f"-I{prefix}/include", f"-I{prefix}/include/eigen3"]
        boost = ["MPL_LIMIT_LIST_SIZE=30", "MPL_LIMIT_VECTOR_SIZE=30", "FUSION_INVOKE_MAX_ARITY=12"]
        limits = [f"-DBOOST_{limit}" for limit in [*boost, "MPL_CFG_NO_PREPROCESSED_HEADERS"]]
        flags = ["-std=c++17", "-O3", "-DNDEBUG", "-march=native", "-w"]
        print("compiling the yardstick (minutes) ...", flush=True)
        command = ["g++", *flags, *limits, *include, str(peers / "ctc_pin.cpp"), "-o", str(program)]
        subprocess.run(command, check=True)
    subprocess.run([sys.executable, str(peers / "gen_models.py"), str(BUILD)], check=True)
    return [str(program), str(BUILD / "torso_arm7.txt"), "2"]


def theirs(command: list[str]) -> float:
    """Microseconds per Runge-Kutta step, median of nine runs of 2 s."""
    out = subprocess.run(command, check=True, capture_output=True, text=True).stdout
    found = re.search(r"RK4: .*= ([\d.]+) us/step", out)
    assert found, out
    return float(found[1])


def ours() -> float:
    """Microseconds per step of ``humanoid_reach``, median of nine runs of 6 s."""
    built = build(load(scenarios.path("humanoid_reach")))
    duration = built.scenario.simulation.duration
    traces = [built.simulation.run(duration) for _ in range(9)]
    return statistics.median(trace.wall_s / (len(trace.time) - 1) * 1e6 for trace in traces)


def main() -> None:
    """Alternate the two and print the ratio of every round."""
    peers, rounds = Path(sys.argv[1]), int(sys.argv[2]) if len(sys.argv) > 2 else 5
    command = yardstick(peers)
    ratios = []
    for number in range(rounds):
        a, b = theirs(command), ours()
        ratios.append(a / b)
        print(f"round {number + 1}: C++ {a:.2f} us/step, humanoid_reach {b:.2f} us/step, ratio {a / b:.2f}")
    print(f"ratio: median {statistics.median(ratios):.2f}, {min(ratios):.2f} to {max(ratios):.2f}")


if __name__ == "__main__":
    main()
