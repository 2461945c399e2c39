"""``make bench``: every kernel and every run against its best-known peer, on this machine, in this run.

``python benches/versus [--rounds 9] [--seconds 0.2] [--only TEXT] [--no-save]``
"""

from __future__ import annotations

import argparse
import datetime
import os
import statistics
import subprocess
import sys
from pathlib import Path
from typing import Any

import inputs
import numpy as np
import programs
import report
from race import Contestant, Entry, alternate, difference, ratios
from rows import ROWS, Row

import onorbit_rs as oo

HERE = Path(__file__).parent
CORE = max(os.sched_getaffinity(0)) if hasattr(os, "sched_getaffinity") else None


class Field:
    """All contestants for one robot, started when first asked for."""

    def __init__(self, arms: int, ours: Path, peers: dict[str, Path], missing: dict[str, str]) -> None:
        self.folder = programs.BUILD / f"nv{6 + 7 * arms}"
        inputs.write(self.folder, arms)
        self.missing, self.running = dict(missing), {}  # type: dict[str, str], dict[str, Contestant]
        files = {
            name: str(self.folder / name) for name in ("robot.urdf", "robot.txt", "robot.xml", "states.bin")
        }
        bins = files["states.bin"]
        python = {
            name: [sys.executable, str(HERE / f"{file}.py"), str(self.folder)]
            for name, file in {
                "ours": "ours",
                "ours_all": "ours",
                "ours_avx2": "ours",
                "pinocchio_calls": "pinocchio_calls",
                "mujoco_rollout": "mujoco_rollout",
                "mujoco_rollout_all": "mujoco_rollout",
            }.items()
        }
        compiled = {
            "kernels": ("kernels", [files["robot.txt"], bins]),
            "reach": (
                "controlled",
                [files["robot.txt"], str(self.folder / "arm.bin"), str(self.folder / "reach.txt")],
            ),
            "controlled": (
                "controlled",
                [files["robot.txt"], str(self.folder / "arms.bin"), str(self.folder / "controlled.txt")],
            ),
            "mujoco": (
                "mujoco",
                [
                    files["robot.xml"],
                    str(self.folder / "mujoco.bin"),
                    str(inputs.PASSIVE_RUNS),
                    str(inputs.PASSIVE_STEPS),
                ],
            ),
        }
        self.commands = {"rust": [str(ours), files["robot.urdf"], bins, str(inputs.STATES)], **python}
        for name, (program, given) in compiled.items():
            if program in peers:
                self.commands[name] = [str(peers[program]), *given]
            else:
                self.missing[name] = missing[program]

    def __getitem__(self, name: str) -> Contestant:
        if name not in self.running:
            environment = {"ONORBIT_INSTRUCTION_SET": "avx2+fma"} if name == "ours_avx2" else {}
            core = None if name.endswith("_all") else CORE
            self.running[name] = Contestant(self.commands[name], core=core, **environment)
        return self.running[name]

    def from_mujoco(self, rows: Any) -> Any:
        model = oo.Model.from_urdf(self.folder / "robot.urdf")
        rows = rows.reshape(-1, model.nq + model.nv)
        return np.hstack(oo.layouts.from_mujoco(model, rows[:, : model.nq], rows[:, model.nq :])).ravel()

    def close(self) -> None:
        for contestant in self.running.values():
            contestant.close()


def measure(row: Row, nv: int, field: Field, rounds: int, seconds: float) -> dict[str, Any] | str:
    """What a row says; or why it says nothing."""
    if row.peer in field.missing:
        return field.missing[row.peer]
    ours, job = field[row.ours[0]], row.ours[1]
    if job not in ours.about.get("jobs", [job]):
        return "ours is not there yet"
    level = ours.about["ready"]
    if row.ours[0] == "ours_avx2" and field["ours"].about["ready"] == level:
        return f"the row above: this processor has nothing beyond {level}"
    entries = [Entry(ours, job), *(Entry(field[row.peer], name) for name in row.jobs)]
    theirs = field[row.peer].result(row.jobs[0], field.folder)
    if row.peer == "mujoco":  # its C program ends in its own layout
        theirs = field.from_mujoco(theirs)
    off = difference(ours.result(job, field.folder), theirs, row.widths(nv))
    mine, *others = alternate(entries, rounds, seconds)
    fastest = min(others, key=statistics.median)
    asked = row.asked.get(level, row.asked.get(str(nv))) if isinstance(row.asked, dict) else row.asked
    return {
        "what": row.what,
        "nv": nv,
        "against": row.against,
        "ratio": {name: round(x, 3) for name, x in ratios(fastest, mine).items()},
        "asked": asked,
        "difference": float(f"{off:.2g}"),
        "ours_ns": round(statistics.median(mine), 1),
        "variants": {
            name: round(ratios(other, mine)["median"], 3)
            for name, other in zip(row.jobs, others, strict=True)
        },
    }


def ceiling(field: Field, nv: int) -> dict[str, Any]:
    """Operations per state of each kernel; and the most that a core does, in 1e9 operations per second."""
    flops = {
        name: field["rust"].ask("flops", name) for name in ("aba", "crba", "rnea", "jacobian", "reduced")
    }
    peak = {}
    for level in ("scalar", "baseline", "avx2+fma", "avx512"):
        if level in ("scalar", "baseline") or level in (field["ours"].about["ready"], "avx2+fma"):
            peak[level] = round(field["rust"].ask("peak", level, 0.3)["gflops"], 1)
    return {"nv": nv, "operations": flops, "peak_gflops": peak}


def commit() -> str:
    command = ["git", "describe", "--always", "--dirty", "--exclude", "*"]
    return subprocess.run(command, cwd=HERE, capture_output=True, text=True).stdout.strip()


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--rounds", type=int, default=9)
    parser.add_argument("--seconds", type=float, default=0.2, help="of each contestant in a round")
    parser.add_argument("--only", default="", help="rows whose name contains this; does not save")
    parser.add_argument("--no-save", action="store_true", help="leave benches/results.json alone")
    given = parser.parse_args()
    peers, missing = programs.peers()
    ours = programs.ours()
    run: dict[str, Any] = {
        "date": datetime.datetime.now(datetime.UTC).strftime("%Y-%m-%d %H:%M UTC"),
        "commit": commit(),
    }
    before, skipped = None, []
    for arms in (1, 2):
        field, nv = Field(arms, ours, peers, missing), 6 + 7 * arms
        if arms == 1:
            level = field["ours"].about["ready"]
            run |= {
                "machine": f"{programs.processor()}, {os.cpu_count()} cores, {level}",
                "versions": programs.versions(),
            }
            run |= {"rounds": given.rounds, "ceiling": [], "rows": []}
            before = report.last_like(run)
            print(f"{run['machine']}; commit {run['commit']}\n{report.head()}")
        for row in ROWS:
            if given.only not in row.what:
                continue
            measured = measure(row, nv, field, given.rounds, given.seconds)
            if isinstance(measured, str):
                skipped.append(f"{row.what}, nv = {nv}: {measured}")
                continue
            run["rows"].append(measured)
            print(report.line(measured, before), flush=True)
        run["ceiling"].append(ceiling(field, nv))
        field.close()
    for reason in skipped:
        print(f"not measured: {reason}")
    for lost in report.regressions(run, before):
        print(f"SLOWER: {lost}")
    if not given.only and not given.no_save:
        report.append(run)


main()
