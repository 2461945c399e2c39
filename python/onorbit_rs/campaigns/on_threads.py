"""Runs cases without Python code in the loop, on threads of this process."""

from __future__ import annotations

import threading
import warnings
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from typing import TYPE_CHECKING

from onorbit_rs.campaigns.cases import Outcome, Stopped, run_case
from onorbit_rs.campaigns.pool import pooled

if TYPE_CHECKING:
    from onorbit_rs.campaigns.plan import Plan


class _InThread:
    """Runs cases in the calling thread; the engine releases the GIL during a run."""

    def __init__(self, plan: Plan, stop: threading.Event) -> None:
        self._plan, self._stop = plan, stop

    def run(self, cases: Sequence[int]) -> Iterator[Outcome]:
        for case in cases:
            self._check()
            yield run_case(self._plan, case, self._check)

    def stop(self) -> None:
        self._stop.set()

    def _check(self) -> None:
        if self._stop.is_set():
            raise Stopped


@contextmanager
def on_threads(plan: Plan, cases: Sequence[int], workers: int) -> Iterator[Iterator[Outcome]]:
    """Run cases on threads during the block; yield an iterator of outcomes in order of completion."""
    stop = threading.Event()
    with (
        warnings.catch_warnings(),
        pooled(cases, workers, lambda: _InThread(plan, stop)) as outcomes,
    ):
        warnings.simplefilter("ignore")  # the nominal scenario has issued them
        yield outcomes
