"""Memory, disk and time of a run of many rows in a folder; fails if it needs more than 500 MB of memory."""

from __future__ import annotations

import argparse
import json
import subprocess
import sys
import tempfile
import time
from pathlib import Path

GATE_MB = 500.0

_RUN = """
import resource, sys
import onorbit_rs as oo
from onorbit_rs.simulation import memory

if sys.argv[4] == "memory":  # the rows stay in memory until the run ends
    memory.is_streamed = oo.simulation.run.is_streamed = lambda *_, **__: False
pictures = sys.argv[5] == "pictures"
run = oo.run(sys.argv[1], sys.argv[2], quiet=True, figures=pictures, recording=pictures,
             compress=bool(sys.argv[6:]),
             changes={"simulation.duration": float(sys.argv[3]), "simulation.time_step": "1 ms",
                      "simulation.record_every": 1})
print(len(run.trace), run.summary["wall_s"], run.summary["certificate_passed"],
      *(resource.getrusage(who).ru_maxrss for who in (resource.RUSAGE_SELF, resource.RUSAGE_CHILDREN)))
"""


def measured(
    name: str, duration: float, where: str, pictures: str, folder: Path, *, compress: bool
) -> dict[str, float | str]:
    """Run a scenario in a new process, and return what the process needed."""
    out = folder / f"{name}-{where}"
    begin = time.perf_counter()
    command = [sys.executable, "-c", _RUN, name, str(out), str(duration), where, pictures]
    command += ["compress"] if compress else []
    done = subprocess.run(command, capture_output=True, text=True, check=True)
    total = time.perf_counter() - begin
    rows, wall, passed, own, helpers = done.stdout.split()
    size = sum(file.stat().st_size for file in out.rglob("*") if file.is_file())
    return {
        "scenario": name, "rows in": where, "pictures": pictures, "rows": float(rows),
        "certificate": passed, "memory of the run, MB": float(own) / 1e3,
        "memory of a process that draws, MB": float(helpers) / 1e3,
        "folder, MB": size / 1e6, "trace.npz, MB": (out / "trace.npz").stat().st_size / 1e6,
        "steps, us per row": 1e6 * float(wall) / float(rows), "total, s": total,
    }  # fmt: skip


def main() -> None:
    """Measure a run on the disk and, with ``--compare``, a run of the same scenario in memory."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--scenario", default="humanoid_reach")
    parser.add_argument("--duration", type=float, default=4000.0, help="simulated time, s")
    parser.add_argument("--compare", action="store_true", help="also keep all rows in memory")
    parser.add_argument("--no-pictures", action="store_true")
    parser.add_argument("--compress", action="store_true", help="compress trace.npz")
    parser.add_argument("--folder", type=Path, help="where the folders of the runs are, default: temporary")
    given = parser.parse_args()
    pictures = "none" if given.no_pictures else "pictures"
    with tempfile.TemporaryDirectory(dir=given.folder) as folder:
        for where in ("disk", "memory") if given.compare else ("disk",):
            found = measured(
                given.scenario, given.duration, where, pictures, Path(folder), compress=given.compress
            )
            print(json.dumps(found, indent=1))
            if where == "disk" and float(found["memory of the run, MB"]) > GATE_MB:
                sys.exit(f"the run needed more than {GATE_MB:g} MB")


if __name__ == "__main__":
    main()
