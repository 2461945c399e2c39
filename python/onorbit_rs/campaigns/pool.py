"""Runs the cases of a campaign on threads, each of which may delegate them to a process."""

from __future__ import annotations

import queue
import threading
import time
from collections import deque
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from typing import Protocol

from onorbit_rs.campaigns.cases import Outcome, Stopped
from onorbit_rs.exceptions import CampaignError

BATCH_S = 0.25
"""Intended wall-clock time of the cases that a worker takes at once, s."""
_MOST_AT_ONCE = 64
MOST_DEATHS = 5
"""Number of worker deaths during the same case at which the case counts as failed."""


MOST_FAILED_STARTS = 20
"""Number of worker deaths in a row, each before a case begins, at which the campaign ends with an error."""


class Executor(Protocol):
    """Runs cases for one thread of the pool."""

    def run(self, cases: Sequence[int]) -> Iterator[Outcome]:
        """Yield the outcomes of cases, in order.

        Raises
        ------
        WorkerDied
            If the process that ran the cases ended.
        OutputFolderError
            If the results of a case cannot be written.
        """

    def stop(self) -> None:
        """Stop the cases in progress; called from another thread."""


class WorkerDied(Exception):
    """Raised if a worker process ended; the message contains the signal or the exit code."""

    def __init__(self, message: str, *, during_case: bool) -> None:
        """Store the message, and whether a case had begun; otherwise the process was still starting."""
        super().__init__(message)
        self.during_case = during_case


class Board:
    """Cases that wait for a worker; each case is taken by one worker at a time."""

    def __init__(self, cases: Sequence[int], workers: int, *, batch_s: float = BATCH_S) -> None:
        """Store the cases, which are handed out in order, in batches of about ``batch_s`` seconds of work."""
        self._batch_s = batch_s
        self._waiting = deque(cases)
        self._workers = workers
        self._lock = threading.Lock()
        self._mean_s: float | None = None
        self._deaths: dict[int, int] = {}

    def take(self) -> list[int]:
        """Return the next cases for a worker; empty if none waits."""
        with self._lock:
            size = 1 if self._mean_s is None else int(self._batch_s / max(self._mean_s, 1e-6))
            size = max(1, min(size, _MOST_AT_ONCE, len(self._waiting) // (4 * self._workers)))
            return [self._waiting.popleft() for _ in range(min(size, len(self._waiting)))]

    def give_back(self, cases: Sequence[int], *, during_case: bool = True) -> bool:
        """Take back the cases of a worker that died; return False if the first case is not retried.

        Raises
        ------
        CampaignError
            If many workers in a row died before they began a case.
        """
        with self._lock:
            first, *rest = cases
            deaths = self._deaths
            key = first if during_case else -1
            deaths[key] = deaths.get(key, 0) + 1
            if not during_case and deaths[key] >= MOST_FAILED_STARTS:
                raise CampaignError(
                    f"{deaths[key]} worker processes in a row ended before they began a case; see their "
                    "messages on stderr",
                    reason="worker",
                )
            is_retried = not during_case or deaths[key] < MOST_DEATHS
            self._waiting.extendleft(reversed(cases if is_retried else rest))
            return is_retried

    def report(self, seconds: float) -> None:
        """Record the wall-clock time of a case, s."""
        with self._lock:
            self._deaths.pop(-1, None)  # a worker has begun a case
            self._mean_s = seconds if self._mean_s is None else 0.9 * self._mean_s + 0.1 * seconds


@contextmanager
def pooled(
    cases: Sequence[int], workers: int, executor: Callable[[], Executor]
) -> Iterator[Iterator[Outcome]]:
    """Run cases on ``workers`` threads during the block; yield an iterator of their outcomes.

    The outcomes are in the order in which the cases end. ``executor`` is called once per thread. After the
    block, no case is in progress.
    """
    pool = _Pool(cases, workers, executor)
    try:
        yield pool.outcomes(len(cases))
    finally:
        pool.stop()


class _Pool:
    def __init__(self, cases: Sequence[int], workers: int, executor: Callable[[], Executor]) -> None:
        self._board = Board(cases, workers)
        self._results: queue.SimpleQueue[Outcome | BaseException] = queue.SimpleQueue()
        self._is_stopped = threading.Event()
        self._executors = [executor() for _ in range(min(workers, len(cases)))]
        self._idle = threading.Condition()
        self._threads = [
            threading.Thread(target=self._work, args=(one,), name=f"onorbit-case-{i}", daemon=True)
            for i, one in enumerate(self._executors)
        ]
        for thread in self._threads:
            thread.start()

    def outcomes(self, count: int) -> Iterator[Outcome]:
        for _ in range(count):
            found = self._results.get()
            if isinstance(found, BaseException):
                raise found
            yield found

    def stop(self) -> None:
        self._is_stopped.set()
        for executor in self._executors:
            executor.stop()
        with self._idle:
            self._idle.notify_all()
        for thread in self._threads:
            thread.join()

    def _work(self, executor: Executor) -> None:
        """Run cases until the pool stops; if no case waits, wait for cases of workers that die."""
        try:
            while not self._is_stopped.is_set():
                cases = self._board.take()
                if cases:
                    self._run(executor, cases)
                else:
                    with self._idle:
                        self._idle.wait(timeout=0.2)
        except Stopped:
            return
        except BaseException as error:  # raised again by the thread that waits for the outcomes
            self._results.put(error)

    def _run(self, executor: Executor, cases: list[int]) -> None:
        left = list(cases)
        began = time.perf_counter()
        try:
            for outcome in executor.run(cases):
                left.remove(outcome.case)
                self._results.put(outcome)
                now = time.perf_counter()
                self._board.report(now - began)
                began = now
        except WorkerDied as death:
            if self._is_stopped.is_set() or not left:
                return
            if not self._board.give_back(left, during_case=death.during_case):
                text = f"{death}, {MOST_DEATHS} times during this case"
                self._results.put(Outcome(left[0], "failed", text, {}, {}))
            with self._idle:
                self._idle.notify_all()
