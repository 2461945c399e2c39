"""The command line, called in this process: what a process of its own would add is a second of imports."""

from __future__ import annotations

import contextlib
import io
import warnings
from pathlib import Path
from subprocess import CompletedProcess

from onorbit_rs.cli import main

SPIN = """name: spin
robot: {rigid_body: {mass: 10, inertia: [1, 2, 3]}}
initial: {angular_velocity: [0.1, 0.2, 0.3]}
simulation: {duration: 0.1 s, time_step: 10 ms}
"""
"""The scenario with the fewest figures: drawing them is what a run with a folder takes long for."""


def onorbit(*arguments: str | Path, cwd: Path | None = None) -> CompletedProcess[str]:
    """Exit code, stdout and stderr of ``onorbit ARGUMENTS``; neither is a terminal."""
    words = [str(argument) for argument in arguments]
    out, err = io.StringIO(), io.StringIO()
    with (
        contextlib.redirect_stdout(out),
        contextlib.redirect_stderr(err),
        contextlib.chdir(cwd or Path.cwd()),
        warnings.catch_warnings(),
    ):
        warnings.resetwarnings()  # a user's Python shows them, ours makes errors of them
        warnings.simplefilter("ignore", DeprecationWarning)
        try:
            main(words)
        except SystemExit as stop:
            code = stop.code if isinstance(stop.code, int) else 0
    return CompletedProcess(words, code, out.getvalue(), err.getvalue())


def refusal(*arguments: str | Path, cwd: Path | None = None) -> str:
    """The one line that is said where a command cannot go on, and nothing else."""
    done = onorbit(*arguments, cwd=cwd)
    assert (done.returncode, done.stdout) == (2, ""), done
    (line,) = done.stderr.splitlines()
    assert line.startswith("onorbit: ") and "Traceback" not in line
    return line
