"""Runs many simulations, such as those of worlds with captures and contacts, on several threads."""

from __future__ import annotations

import os
import threading
from collections import deque
from collections.abc import Callable, Iterable, Iterator
from concurrent.futures import Future, ThreadPoolExecutor
from itertools import islice
from typing import TYPE_CHECKING, TypeAlias

from onorbit_rs.exceptions import DtypeError, InputError

if TYPE_CHECKING:
    from onorbit_rs import Simulation, Trace, WorldTrace

Source: TypeAlias = "Simulation | Callable[[], Simulation]"


class _Stopped(Exception):
    """Ends the runs in progress after an error in another run or Ctrl-C."""


def run_batch(
    simulations: Iterable[Source], duration: float, *, threads: int | None = None
) -> Iterator[Trace | WorldTrace]:
    """Run many simulations on several threads, and yield their traces in the order of the simulations.

    A simulation may be that of one robot or of a world with captures, contacts and events. Each trace has the
    same bits as that of :meth:`Simulation.run`, for any number of threads. At most two simulations per thread
    are started before their traces are requested, so that a generator of any length needs little memory. If
    ``record_every`` is at least the number of steps, a trace has only the first and the last row.

    Controllers and effects written in Python hold the GIL and therefore run on one thread at a time.

    Parameters
    ----------
    simulations : iterable of Simulation or of callables
        Simulations; each object at most once. A callable without arguments is called on the thread of its
        run, and returns the simulation.
    duration : float
        Duration of every run, s.
    threads : int, optional
        Number of threads. Default: the number of cores of the machine.

    Yields
    ------
    Trace or WorldTrace
        Trace of each simulation, as from :meth:`Simulation.run`.

    Raises
    ------
    InputError, DtypeError
        If ``threads`` is not a positive integer.
    OnOrbitError
        The error of a run, with a note that gives the number of its simulation, counted from 0. The other
        runs are then ended.
    """
    if isinstance(threads, bool) or not isinstance(threads, int | None):
        message = f"threads is {threads!r}; it must be a positive integer, or None to use all cores"
        raise DtypeError(message)
    if threads is not None and threads < 1:
        raise InputError(f"threads is {threads}; it must be at least 1, or None to use all cores")
    return _traces(iter(simulations), duration, threads or os.cpu_count() or 1)


def _traces(simulations: Iterator[Source], duration: float, threads: int) -> Iterator[Trace | WorldTrace]:
    """Yield the traces of the simulations; closing the generator ends the runs in progress."""
    stop = threading.Event()
    pool = ThreadPoolExecutor(threads, thread_name_prefix="onorbit-run")

    def submit(source: Source) -> Future[Trace | WorldTrace]:
        return pool.submit(_run, source, duration, stop)

    pending = deque(map(submit, islice(simulations, 2 * threads)))
    number = 0
    try:
        while pending:
            try:
                trace = pending.popleft().result()
            except Exception as error:
                error.add_note(f"in the run of simulation {number}, counted from 0")
                raise
            pending.extend(map(submit, islice(simulations, 1)))
            yield trace
            number += 1
    finally:
        stop.set()
        pool.shutdown(cancel_futures=True)


def _run(source: Source, duration: float, stop: threading.Event) -> Trace | WorldTrace:
    """Run one simulation until its end or until `stop` is set."""

    def check(_t: float, _duration: float) -> None:
        if stop.is_set():
            raise _Stopped

    check(0.0, duration)
    simulation = source() if callable(source) else source
    return simulation.run(duration, progress=check)
