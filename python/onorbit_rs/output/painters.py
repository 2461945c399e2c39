"""Draws the figures of a run in this process and in helper processes at the same time."""

from __future__ import annotations

import os
import subprocess
import sys
import threading
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager, suppress
from typing import TYPE_CHECKING, Any, NamedTuple

from onorbit_rs.common.processes import send

if TYPE_CHECKING:
    from onorbit_rs.figures import Subject, WorldSubject

MOST_HELPERS = 3
"""Largest number of helper processes."""

FIGURES_PER_HELPER = 3
"""Smallest number of figures per helper; with fewer, starting the process takes longer than it saves."""

_PROGRAM = "import sys; sys.path[:] = {path!r}; from onorbit_rs.figures.painter import main; main()"


class Album(NamedTuple):
    """Figures that belong together: the prefix of their file names, and the subject that they show."""

    prefix: str
    subject: Subject | WorldSubject


class _Queue:
    """Numbers of the figures that no process has started, and the contents of those that are complete."""

    def __init__(self, count: int) -> None:
        self._left = list(range(count))
        self._lock = threading.Lock()
        self.contents: dict[int, bytes] = {}

    def take(self) -> int | None:
        """Return the number of the next figure, or None if all were started."""
        with self._lock:
            return self._left.pop(0) if self._left else None

    def give_back(self, number: int) -> None:
        """Put back the figure of a helper that ended before the figure was complete."""
        with self._lock:
            self._left.insert(0, number)


class Painters:
    """Helper processes that draw while this process does other work."""

    def __init__(self, albums: Sequence[Album], draw: Sequence[Callable[[], bytes]]) -> None:
        """Start the helpers; ``draw`` has one function per figure of the albums, in order."""
        self._draw, self._queue = draw, _Queue(len(draw))
        self._helpers: list[subprocess.Popen[bytes]] = []
        self._threads: list[threading.Thread] = []
        for _ in range(_helper_count(len(draw))):
            with suppress(OSError):  # no memory or no permission for another process: draw here
                self._helpers.append(_started())
        for helper in self._helpers:
            thread = threading.Thread(target=_serve, args=(helper, albums, self._queue), daemon=True)
            thread.start()
            self._threads.append(thread)

    def contents(self) -> Iterator[tuple[int, bytes]]:
        """Draw together with the helpers; yield the number and the PNG of each figure, in order."""
        yielded = 0
        while yielded < len(self._draw):
            number = self._queue.take()
            if number is not None:
                self._queue.contents[number] = self._draw[number]()
            else:
                for thread in self._threads:  # a helper that ends puts its figure back into the queue
                    thread.join()
                self._threads = []
            while yielded in self._queue.contents:
                yield yielded, self._queue.contents.pop(yielded)
                yielded += 1

    def stop(self) -> None:
        """End the helpers."""
        for helper in self._helpers:
            helper.kill()
        for thread in self._threads:
            thread.join()
        for helper in self._helpers:
            end(helper)


@contextmanager
def painters(albums: Sequence[Album], draw: Sequence[Callable[[], bytes]]) -> Iterator[Painters]:
    """Start the helpers; end them after the block."""
    started = Painters(albums, draw)
    try:
        yield started
    finally:
        started.stop()


def _helper_count(figures: int) -> int:
    """Return the number of helpers for this number of figures on the processors of this process."""
    available = len(os.sched_getaffinity(0)) if hasattr(os, "sched_getaffinity") else os.cpu_count() or 1
    is_python = bool(sys.executable) and not getattr(sys, "frozen", False)
    return min(MOST_HELPERS, available - 1, figures // FIGURES_PER_HELPER) if is_python else 0


def _started() -> subprocess.Popen[bytes]:
    """Start a helper in a separate session, where Ctrl-C in the terminal does not reach it."""
    return subprocess.Popen(
        [sys.executable, "-c", _PROGRAM.format(path=sys.path)],
        stdin=subprocess.PIPE, stdout=subprocess.PIPE, stderr=subprocess.DEVNULL, start_new_session=True,
    )  # fmt: skip


def end(helper: subprocess.Popen[bytes]) -> None:
    """Kill a helper and close its pipes."""
    helper.kill()
    helper.wait()
    for pipe in (helper.stdin, helper.stdout):
        with suppress(OSError):  # closing flushes what the helper has not read
            assert pipe is not None
            pipe.close()


def _serve(helper: subprocess.Popen[bytes], albums: Sequence[Album], queue: _Queue) -> None:
    """Send the albums and then numbers of figures to a helper, and store the figures that it returns.

    A helper that fails draws no further figures. Another process draws its figure, so that an error of the
    figure itself is raised in this process.
    """
    assert helper.stdin is not None and helper.stdout is not None
    number = None
    try:
        send(helper.stdin, list(albums))
        while (number := queue.take()) is not None:
            send(helper.stdin, number)
            queue.contents[number] = _received(helper.stdout)
            number = None
    except Exception:
        if number is not None:
            queue.give_back(number)


def _received(stream: Any) -> bytes:
    """Return the figure that a helper sends: its length in 8 bytes, then its content.

    Raises
    ------
    EOFError
        If the helper ended.
    """
    size = int.from_bytes(stream.read(8), "little")
    content = stream.read(size)
    if size == 0 or len(content) < size:
        raise EOFError("the helper process ended")
    return bytes(content)
