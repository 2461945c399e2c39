"""Compares the speed of kernels and runs with that of other engines on this machine: ``make bench``."""

from __future__ import annotations

import argparse
import datetime
import os
import subprocess
from pathlib import Path
from typing import Any

import page
import programs
import report
from contestants import Contestants
from measure import CAPTURE, CONTACT, captures, ceiling, contacts, measure
from rows import ROWS


def commit() -> str:
    command = ["git", "describe", "--always", "--dirty", "--exclude", "*"]
    return subprocess.run(command, cwd=Path(__file__).parent, capture_output=True, text=True).stdout.strip()


def arguments() -> argparse.Namespace:
    parser = argparse.ArgumentParser(prog="python benches/versus", description=__doc__)
    parser.add_argument("--rounds", type=int, default=15)
    parser.add_argument("--seconds", type=float, default=0.1, help="duration of each program in a round, s")
    parser.add_argument("--only", default="", help="measure only rows whose name contains this; save nothing")
    parser.add_argument(
        "--no-save", action="store_true", help="do not update benches/results.json and the page"
    )
    return parser.parse_args()


def main() -> None:
    given = arguments()
    peers, missing = programs.peers()
    ours = programs.ours()
    now = datetime.datetime.now(datetime.UTC)
    run: dict[str, Any] = {"date": now.strftime("%Y-%m-%d %H:%M UTC"), "commit": commit()}
    before, skipped = None, []
    for arms in (1, 2):
        contestants, nv = Contestants(arms, ours, peers, missing), 6 + 7 * arms
        if arms == 1:
            level = contestants["ours"].about["ready"]
            run["machine"] = f"{programs.processor()}, {os.cpu_count()} cores, {level}"
            run |= {"versions": programs.versions(), "rounds": given.rounds, "ceiling": [], "rows": []}
            before = report.last_like(run)
            print(f"{run['machine']}; commit {run['commit']}\n{report.head()}")
        for row in (row for row in ROWS if given.only in row.what):
            measured = measure(row, nv, contestants, given.rounds, given.seconds)
            if isinstance(measured, str):
                skipped.append(f"not measured: {row.what}, nv = {nv}: {measured}")
            else:
                run["rows"].append(measured)
                print(report.line(measured, before), flush=True)
        if arms == 1 and given.only in CONTACT and "contact" not in contestants.missing:
            run["contacts"] = contacts(contestants, given.rounds, given.seconds)
            print(f"{CONTACT}:", *report.contacts(run["contacts"]), sep="\n")
        run["ceiling"].append(ceiling(nv, contestants))
        contestants.close()
    if given.only in CAPTURE:
        if run["versions"]["mujoco-core"]:
            run["captures"] = captures(given.rounds, given.seconds)
            print(f"{CAPTURE}:", *report.captures(run["captures"]), sep="\n")
        else:
            skipped.append(f"not measured: {CAPTURE}: mujoco-core is not installed")
    print(*skipped, *report.regressions(run, before), sep="\n")
    if not given.only and not given.no_save:
        report.append(run)
        page.update(run)


main()
