"""A progress bar on a terminal, nothing elsewhere."""

from __future__ import annotations

import sys
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager

ProgressCallback = Callable[[float, float], None]
"""Called with the time reached and the duration, both in seconds of simulation."""


@contextmanager
def progress_bar(name: str, duration_s: float, *, quiet: bool) -> Iterator[ProgressCallback | None]:
    """A callback that moves a bar on the terminal, or None where there is no terminal."""
    if quiet or not sys.stderr.isatty():
        yield None
        return
    from rich.console import Console
    from rich.progress import BarColumn, Progress, TextColumn, TimeRemainingColumn

    columns = (
        TextColumn("{task.description}", markup=False),
        BarColumn(),
        TextColumn("{task.fields[reached]}", markup=False),
        TimeRemainingColumn(),
    )
    started = time.perf_counter()
    with Progress(*columns, console=Console(stderr=True), transient=True) as bar:
        task = bar.add_task(name, total=duration_s, reached="")

        def move(reached_s: float, total_s: float) -> None:
            elapsed = max(time.perf_counter() - started, 1e-9)
            where = f"t = {reached_s:.4g} / {total_s:.4g} s, {reached_s / elapsed:.3g}x real time"
            bar.update(task, completed=reached_s, reached=where)

        yield move
