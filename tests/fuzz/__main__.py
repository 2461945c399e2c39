"""``make fuzz``: fuzzes every parser of the engine and of the package, guided by its code coverage.

A parser must read its input or raise an ``OnOrbitError``. Findings are panics, crashes, other exceptions,
exceeded limits of time or memory, and non-finite numbers: the input is kept in
``target/fuzz/work/findings`` beside a note with its seed, and the exit code is 1. ``--replay PARSER FILE``
repeats one input.
"""

from __future__ import annotations

import argparse
import json
import os
import subprocess
import sys
import time
from pathlib import Path

from rounds import Report, in_rounds
from targets import TARGETS

HERE = Path(__file__).parent
ROOT = HERE.parents[1]
FOLDER = ROOT / "target" / "fuzz"
WORK, CORPUS = FOLDER / "work", HERE / "corpus"
# coverage by a flag of stable rustc; integer overflow panics
BUILD = {
    "CARGO_TARGET_DIR": str(FOLDER / "build"),
    "CARGO_PROFILE_RELEASE_DEBUG_ASSERTIONS": "true",
    "CARGO_PROFILE_RELEASE_OVERFLOW_CHECKS": "true",
    "CARGO_PROFILE_RELEASE_LTO": "off",
    "CARGO_PROFILE_RELEASE_CODEGEN_UNITS": "16",
    "RUSTFLAGS": "-C instrument-coverage --cfg coverage_counters",
    "LLVM_PROFILE_FILE": os.devnull,
}
RUN = {"LLVM_PROFILE_FILE": os.devnull, "PYTHONPATH": f"{FOLDER / 'atheris'}:{ROOT / 'python'}"}
ATHERIS = "atheris==3.0.0"
# relative numbers of inputs: parsers in Python take 10 to 100 times as long
ENGINE, PYTHON = 25.0, 1.0
LINE = "{parser:20} {inputs:9} {seconds:8.1f} {kept:5}  {findings}"


def arguments() -> argparse.Namespace:
    parser = argparse.ArgumentParser(prog="python tests/fuzz", description=__doc__)
    parser.add_argument("--seconds", type=float, default=10.0, help="time limit of each parser")
    parser.add_argument("--count", type=int, default=10**9, help="limit of the total number of inputs")
    parser.add_argument("--seed", type=int, default=int(time.time()))
    parser.add_argument("--only", default="", help="run only the parsers whose name contains this text")
    parser.add_argument("--replay", nargs=2, metavar=("PARSER", "FILE"))
    return parser.parse_args()


def engine() -> Path:
    """Builds the program that fuzzes the engine's parsers."""
    command = ["cargo", "build", "--release", "--quiet", "-p", "onorbit-core", "--example", "fuzz"]
    subprocess.run(command, cwd=ROOT, env=os.environ | BUILD, check=True)
    return FOLDER / "build" / "release" / "examples" / "fuzz"


def install_atheris() -> str:
    """Installs Atheris into a separate folder; returns a message describing the result."""
    if (FOLDER / "atheris").exists():
        return "Atheris"
    command = [sys.executable, "-m", "pip", "install", "--quiet", "--only-binary", ":all:"]
    done = subprocess.run([*command, "--target", str(FOLDER / "atheris"), ATHERIS], capture_output=True)
    return "Atheris" if done.returncode == 0 else "no Atheris for this platform: mutations without coverage"


def fuzzed(command: list[str | Path], name: str, seed: int) -> Report:
    """Returns the report of a parser's process, with the input that crashed it, if any."""
    done = subprocess.run(
        [*map(str, command)], env=os.environ | RUN, capture_output=True, text=True, errors="replace"
    )
    lines = [line for line in done.stdout.splitlines() if line.startswith("{")]
    if done.returncode in (0, 1) and lines:
        return dict(json.loads(lines[-1]))
    kept = WORK / "findings" / f"{name}-ended-by-{done.returncode}"
    if (WORK / "current").exists():
        record = (WORK / "current").read_bytes()
        kept.write_bytes(record[8 : 8 + int.from_bytes(record[:8], "little")])
    output = "\n".join([*done.stdout.splitlines()[-5:], *done.stderr.splitlines()[-30:]])
    kept.with_suffix(".txt").write_text(
        f"parser {name}\nseed {seed}\nexit code {done.returncode}\n{output}\n"
    )
    return {"parser": name, "inputs": 0, "kept": 0, "seconds": 0.0, "findings": 1}


def main() -> int:
    given = arguments()
    if given.replay:
        return replay(*given.replay)
    program = engine()
    listed = subprocess.run(
        [program, "--list"], env=os.environ | RUN, capture_output=True, text=True, check=True
    ).stdout.split()
    engines = [name for name in listed if given.only in name]
    targets = [name for name in TARGETS if given.only in name]
    guide = install_atheris()
    print(f"seed {given.seed}; {len(engines)} parsers of the engine, {len(targets)} of Python ({guide})")
    print(f"{'parser':20} {'inputs':>9} {'seconds':>8} {'kept':>5}  findings", flush=True)
    (WORK / "findings").mkdir(parents=True, exist_ok=True)

    def run(name: str, count: int, seconds: float, number: int) -> Report:
        start = [program] if name in engines else [sys.executable, HERE / "guided.py"]
        (WORK / "current").unlink(missing_ok=True)
        seed = given.seed + number  # the same seed would repeat the same mutations
        limits = [str(count), str(seconds), str(seed)]
        report = fuzzed([*start, name, *limits, CORPUS, WORK], name, seed)
        print(LINE.format(**report), flush=True)
        return report

    weights = dict.fromkeys(engines, ENGINE) | dict.fromkeys(targets, PYTHON)
    reports = in_rounds(weights, given.count, given.seconds, run)
    print("total:", *(LINE.format(**report) for report in reports), sep="\n")
    inputs, findings = (sum(report[key] for report in reports) for key in ("inputs", "findings"))
    print(f"{inputs} inputs in {sum(report['seconds'] for report in reports):.0f} s, {findings} findings")
    if findings:
        print(
            f"the findings are in {WORK / 'findings'}; repeat one with python tests/fuzz --replay PARSER FILE"
        )
    return 1 if findings else 0


def replay(name: str, file: str) -> int:
    if name not in TARGETS:
        return subprocess.run([engine(), "--replay", name, file], env=os.environ | RUN).returncode
    from tried import Trial

    trial = Trial(name, WORK / "findings", 0)
    trial(Path(file).read_bytes())
    trial.room.close()
    print(*trial.places or ["the input has no finding"])
    return 1 if trial.places else 0


if __name__ == "__main__":
    sys.exit(main())
