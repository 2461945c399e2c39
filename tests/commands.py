"""Calls the command line in this process, which saves the second that a new process needs for imports."""

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
"""A scenario with few figures; drawing them takes most of the time of a run with an output folder."""


def onorbit(*arguments: str | Path, cwd: Path | None = None) -> CompletedProcess[str]:
    """Returns exit code, stdout and stderr of ``onorbit ARGUMENTS``; neither stream is a terminal."""
    words = [str(argument) for argument in arguments]
    out, err = io.StringIO(), io.StringIO()
    with (
        contextlib.redirect_stdout(out),
        contextlib.redirect_stderr(err),
        contextlib.chdir(cwd or Path.cwd()),
        warnings.catch_warnings(),
    ):
        warnings.resetwarnings()  # users see warnings as text; the test configuration turns them into errors
        warnings.simplefilter("ignore", DeprecationWarning)
        try:
            main(words)
        except SystemExit as stop:
            code = stop.code if isinstance(stop.code, int) else 0
    return CompletedProcess(words, code, out.getvalue(), err.getvalue())


def refusal(*arguments: str | Path, cwd: Path | None = None) -> str:
    """Returns the single line that a failing command prints; checks that there is no other output."""
    done = onorbit(*arguments, cwd=cwd)
    assert (done.returncode, done.stdout) == (2, ""), done
    (line,) = done.stderr.splitlines()
    assert line.startswith("onorbit: ") and "Traceback" not in line
    return line
