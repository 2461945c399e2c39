"""Runs cases in processes of this machine that are connected by pipes."""

from __future__ import annotations

import signal
import subprocess
import sys
import threading
from collections.abc import Iterator, Sequence
from contextlib import contextmanager, suppress
from typing import TYPE_CHECKING

from onorbit_rs.campaigns.cases import Outcome, Stopped
from onorbit_rs.campaigns.pool import WorkerDied, pooled
from onorbit_rs.common.processes import packed, receive, send
from onorbit_rs.exceptions import OnOrbitError

if TYPE_CHECKING:
    from pathlib import Path

    from onorbit_rs.campaigns.plan import Plan

_COMMAND = (sys.executable, "-m", "onorbit_rs.campaigns.worker")


class _InProcess:
    """Runs cases in a worker process.

    The process is started for the first case and, after it has died, for the next one.
    """

    def __init__(self, greeting: bytes) -> None:
        self._greeting = greeting
        self._process: subprocess.Popen[bytes] | None = None
        self._lock = threading.Lock()
        self._is_stopped = False

    def run(self, cases: Sequence[int]) -> Iterator[Outcome]:
        has_begun = False
        process = self._started()
        assert process.stdin is not None
        assert process.stdout is not None
        try:
            send(process.stdin, list(cases))
            for _ in cases:
                has_begun = False
                receive(process.stdout)  # the number of the case, when it begins
                has_begun = True
                found = receive(process.stdout)
                if isinstance(found, OnOrbitError):
                    raise found
                yield found
        except OnOrbitError:  # of the worker, which continues to run
            raise
        except (EOFError, OSError, ValueError) as error:
            raise WorkerDied(self._end(process), during_case=has_begun) from error

    def stop(self) -> None:
        with self._lock:
            self._is_stopped = True
            if self._process is not None:
                _kill(self._process)

    def _started(self) -> subprocess.Popen[bytes]:
        with self._lock:
            if self._is_stopped:
                raise Stopped
            if self._process is None:
                self._process = subprocess.Popen(
                    _COMMAND,
                    stdin=subprocess.PIPE,
                    stdout=subprocess.PIPE,
                    start_new_session=True,  # Ctrl-C is for the process that started it
                )
                process, greeting = self._process, self._greeting
            else:
                process, greeting = self._process, b""
        assert process.stdin is not None
        with suppress(OSError):  # it died; reading its results raises the error
            process.stdin.write(greeting)
        return process

    def _end(self, process: subprocess.Popen[bytes]) -> str:
        """Release a process that died; return a text with the signal or the exit code."""
        with self._lock:
            _kill(process)
            self._process = None
        code = process.returncode
        with suppress(ValueError):
            return f"the worker process was ended by {signal.Signals(-code).name}"
        return f"the worker process ended with exit code {code}"


def _kill(process: subprocess.Popen[bytes]) -> None:
    """End a process and release its pipes."""
    if process.poll() is None:
        process.kill()
    process.wait()
    for stream in (process.stdin, process.stdout):
        with suppress(OSError, ValueError):
            if stream is not None:
                stream.close()


@contextmanager
def on_processes(
    plan: Plan, cases: Sequence[int], workers: int, keep_in: Path | None = None
) -> Iterator[Iterator[Outcome]]:
    """Run cases in processes during the block; yield an iterator of outcomes in order of completion.

    A worker that dies is replaced, and its unfinished cases are run again. A case during which
    ``MOST_DEATHS`` workers died counts as failed. With ``keep_in``, the folder of the campaign, each case is
    run as an ordinary run in its folder among the failures, and errors of writing are raised.
    """
    greeting = packed((plan, sys.path, keep_in))
    with pooled(cases, workers, lambda: _InProcess(greeting)) as outcomes:
        yield outcomes
