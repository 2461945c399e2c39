"""Progress display on stderr: simulated time and real-time factor, then the current task.

A terminal shows a bar; anything else receives lines, see :mod:`onorbit_rs.common.progress_lines`.
"""

from __future__ import annotations

import sys
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager, suppress
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

from onorbit_rs.common.printable import printable
from onorbit_rs.common.progress_lines import ProgressLines

if TYPE_CHECKING:
    from rich.progress import Progress as Bar

ProgressCallback = Callable[[float, float], None]
"""Callback that receives the simulated time and the duration of the run, s."""


@dataclass(frozen=True)
class Progress:
    """Progress of a run: the simulation loop calls ``move``; ``tell`` shows the name of each later task.

    ``move`` is None if nothing is displayed.
    """

    move: ProgressCallback | None = None
    tell: Callable[[str], None] = lambda doing: None


@contextmanager
def progress_bar(name: str, duration_s: float, *, quiet: bool) -> Iterator[Progress]:
    """Show the progress of a run during the block, unless ``quiet``, and yield its :class:`Progress`."""
    if quiet or sys.stderr is None:
        yield Progress()
        return
    if not _is_watched():
        lines = ProgressLines(name)
        yield Progress(_LineMover(lines), lines.begin)
        return
    with _drawn(_bar()) as bar:
        task = bar.add_task(printable(name), total=duration_s, doing="starting", start=False)
        yield Progress(_Mover(bar, task), lambda doing: bar.update(task, completed=duration_s, doing=doing))


@contextmanager
def parts_bar(name: str, *, quiet: bool) -> Iterator[Callable[[str, float], None]]:
    """Show a progress bar during the block, unless ``quiet``.

    Yield a function that sets the name of the current task and the completed fraction.
    """
    if quiet or sys.stderr is None:
        yield lambda part, done: None
        return
    if not _is_watched():
        lines = ProgressLines(name)
        yield lambda part, done: lines.update(f"{part} ({100.0 * done:.0f} %)")
        return
    with _drawn(_bar()) as bar:
        task = bar.add_task(printable(name), total=1.0, doing="starting")
        yield lambda part, done: bar.update(task, completed=done, doing=printable(part))


@contextmanager
def _drawn(bar: Bar) -> Iterator[Bar]:
    """Draw the bar during the block; an OSError on stopping it (a closed terminal) is ignored."""
    bar.start()
    try:
        yield bar
    finally:
        with suppress(OSError):
            bar.stop()


def _is_watched() -> bool:
    """Return True if stderr is open and a terminal."""
    return sys.stderr is not None and sys.stderr.isatty()


def _bar() -> Bar:
    from rich.console import Console
    from rich.progress import BarColumn, Progress, TextColumn, TimeRemainingColumn

    columns = (
        TextColumn("{task.description}", markup=False),
        BarColumn(),
        TextColumn("{task.fields[doing]}", markup=False),
        TimeRemainingColumn(),
    )
    return Progress(*columns, console=Console(stderr=True), transient=True)


@contextmanager
def doing(name: str, *, quiet: bool) -> Iterator[Callable[[str], None]]:
    """Show a status line during the block, unless ``quiet``.

    Yield a function that sets the name of the current task.
    """
    if quiet or sys.stderr is None:
        yield lambda part: None
        return
    if not _is_watched():
        yield ProgressLines(name).update
        return
    from rich.console import Console
    from rich.markup import escape

    with Console(stderr=True).status(escape(printable(name))) as status:
        yield lambda part: status.update(escape(printable(f"{name}: {part}")))


class _LineMover:
    """Prints lines about the simulated time.

    The real-time factor of a resumed run counts from its checkpoint.
    """

    def __init__(self, lines: ProgressLines) -> None:
        self._lines = lines
        self._first: tuple[float, float] | None = None

    def __call__(self, reached_s: float, total_s: float) -> None:
        now = time.perf_counter()
        self._first = self._first or (now, reached_s)
        factor = real_time_factor(*self._first, now, reached_s)
        self._lines.update(progress_text(reached_s, total_s, factor))


class _Mover:
    """Updates the progress bar.

    The real-time factor of a resumed run counts from its checkpoint.
    """

    def __init__(self, bar: Any, task: Any) -> None:
        self._bar, self._task = bar, task
        self._first: tuple[float, float] | None = None

    def __call__(self, reached_s: float, total_s: float) -> None:
        now = time.perf_counter()
        if self._first is None:
            self._first = now, reached_s
            self._bar.reset(self._task, completed=reached_s, total=total_s, start=True)
        factor = real_time_factor(*self._first, now, reached_s)
        self._bar.update(self._task, completed=reached_s, doing=progress_text(reached_s, total_s, factor))


def real_time_factor(began: float, began_at_s: float, now: float, reached_s: float) -> float | None:
    """Return the ratio of simulated to wall-clock time since ``began``, s; None in the first millisecond."""
    elapsed = now - began
    return (reached_s - began_at_s) / elapsed if elapsed > 1e-3 else None


def progress_text(reached_s: float, total_s: float, factor: float | None) -> str:
    """Return the text of the progress bar, such as ``t = 12.3 / 60 s, 45x real time``."""
    speed = "" if factor is None else f", {factor:.3g}x real time"
    return f"t = {reached_s:.4g} / {total_s:.4g} s{speed}"
