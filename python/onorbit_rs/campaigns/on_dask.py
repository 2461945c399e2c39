"""Runs the cases of a campaign on a Dask cluster, in tasks of a few cases each."""

from __future__ import annotations

import importlib
import logging
import queue
import time
import warnings
from collections.abc import Iterator, Sequence
from contextlib import contextmanager, suppress
from functools import lru_cache
from typing import TYPE_CHECKING, Any

from onorbit_rs.campaigns.cases import Outcome, run_case
from onorbit_rs.campaigns.plan import Plan, software
from onorbit_rs.campaigns.pool import MOST_DEATHS, Board
from onorbit_rs.common.processes import packed, unpacked
from onorbit_rs.exceptions import CampaignError, InputError

if TYPE_CHECKING:
    from types import ModuleType

LOCAL = "local"
"""Address that stands for a cluster on this machine, which is started for the campaign only."""
_SETTINGS = {
    "distributed.worker.profile.enabled": False,  # samples the stacks of Python a hundred times a second
    # replaces the default MALLOC_TRIM_THRESHOLD_, with which every case releases and maps memory again
    "distributed.nanny.pre-spawn-environ": {"OMP_NUM_THREADS": 1, "MALLOC_ARENA_MAX": 1},
    # the default, 15 s after the death of a worker, ends the process that restarts it, if the worker that
    # replaced it has just died too
    "distributed.deploy.lost-worker-timeout": "365 days",
}
"""Settings of Dask for a cluster on this machine."""
_CONNECT_S = 10.0
_WITHOUT_WORKERS_S = 60.0
"""Wall-clock time for which a campaign waits for the first worker, or for another one if all are lost, s."""
_LOST_S = 15.0
"""Wall-clock time without a connection after which it counts as lost, s."""
_RESULT_S = 1.0
"""Wall-clock time for which a result is awaited before the connection is checked, s.

The time doubles with each attempt: a large result takes long to arrive, but the result of a worker that died
must be requested again.
"""
_RETRY_S = 0.2
"""Wall-clock time after which a transfer that was cut off is tried again, s."""
_LONGEST_RESULT_S = 60.0
_BATCH_S = 1.0
"""Intended wall-clock time of the cases of one task, s."""
_AHEAD = 1
"""Number of tasks in the queue of every thread of the cluster, so that no thread is idle."""


def run_cases(plan: bytes, cases: list[int]) -> tuple[list[Outcome], float]:
    """Run cases on a worker; return their outcomes, and the mean wall-clock time of a case, s.

    Raises CampaignError if version or instruction set of the worker differ from those of the campaign.
    """
    began = time.perf_counter()
    loaded = _plan(plan)
    if (here := software()) != loaded.software:
        raise CampaignError(
            f"a worker of the cluster has {here}, but the campaign was started with {loaded.software}; use "
            "workers of the same version and instruction set, so that a case has the same results everywhere",
            reason="version",
        )
    found = [run_case(loaded, case) for case in cases]
    return found, (time.perf_counter() - began) / len(cases)


@lru_cache(maxsize=4)
def _plan(plan: bytes) -> Plan:
    warnings.simplefilter("ignore")  # the nominal scenario has issued them
    loaded: Plan = unpacked(plan)
    return loaded


def distributed() -> ModuleType:
    """Return the module ``distributed``; raise InputError if it is not installed."""
    try:
        import distributed as module
    except ImportError:
        raise InputError(
            "a cluster requires Dask; install it with: pip install 'onorbit-rs[campaign]'", name="cluster"
        ) from None
    return module  # type: ignore[no-any-return]


@contextmanager
def on_dask(plan: Plan, cases: Sequence[int], workers: int, address: str) -> Iterator[Iterator[Outcome]]:
    """Run cases on a Dask cluster during the block; yield an iterator of outcomes in order of completion.

    Parameters
    ----------
    plan : Plan
        Campaign.
    cases : sequence of int
        Numbers of the cases.
    workers : int
        Number of processes of the cluster, if it is ``local``.
    address : str
        Address of a scheduler, such as ``tcp://10.0.0.1:8786``, or ``local``.

    Raises
    ------
    InputError
        If Dask is not installed.
    CampaignError
        If no cluster answers at the address, it has no workers, its workers cannot run the cases, or the
        connection to it is lost.
    """
    with _client(address, workers) as client:
        tasks = _Tasks(client, plan, cases, address)
        try:
            yield tasks.outcomes(len(cases))
        finally:
            tasks.cancel()


@contextmanager
def _client(address: str, workers: int) -> Iterator[Any]:
    """Connect to a cluster, or start one whose sockets are bound to 127.0.0.1."""
    module = distributed()
    logger = logging.getLogger("distributed")
    level = logger.level
    logger.setLevel(logging.CRITICAL)  # the death of a worker is handled below
    try:
        if address == LOCAL:
            with (
                importlib.import_module("dask").config.set(_SETTINGS),
                module.LocalCluster(
                    n_workers=workers,
                    threads_per_worker=1,
                    processes=True,
                    host="127.0.0.1",
                    dashboard_address="127.0.0.1:0",  # any free port
                    worker_dashboard_address=None,
                    memory_limit=0,
                    silence_logs=logging.CRITICAL,
                ) as cluster,
                module.Client(cluster, set_as_default=False) as client,
            ):
                yield client
            return
        try:
            client = module.Client(address, timeout=_CONNECT_S, set_as_default=False)
        except (OSError, TimeoutError, ValueError) as error:
            raise CampaignError(
                f"no Dask scheduler answers at {address} ({type(error).__name__}); start one with 'dask "
                "scheduler', or give 'local' for a cluster on this machine",
                reason="no cluster",
            ) from error
        try:
            yield client
        finally:
            with suppress(Exception):  # the cluster may be gone
                client.close(timeout=2)
    finally:
        logger.setLevel(level)


class _Tasks:
    """Tasks on the cluster, of which at most ``1 + _AHEAD`` per thread are submitted at a time."""

    def __init__(self, client: Any, plan: Plan, cases: Sequence[int], address: str) -> None:
        self._client, self._address = client, address
        self._plan = packed(plan)
        self._done: queue.SimpleQueue[Any] = queue.SimpleQueue()
        self._running: dict[Any, list[int]] = {}
        self._threads = self._wait_for_workers()
        self._board = Board(cases, self._threads, batch_s=_BATCH_S)
        self._lost_since: float | None = None
        self._idle_since: float | None = None

    def outcomes(self, count: int) -> Iterator[Outcome]:
        """Yield the outcomes of ``count`` cases."""
        while count:
            self._submit()
            future = self._next()
            cases = self._running.pop(future)
            for outcome in self._results(future, cases):
                count -= 1
                yield outcome

    def cancel(self) -> None:
        """Cancel the tasks that have not ended."""
        with suppress(Exception):  # the cluster may be gone
            self._client.cancel(list(self._running), force=True)

    def _submit(self) -> None:
        """Submit tasks until every thread has one to run and one in its queue."""
        while len(self._running) < (1 + _AHEAD) * self._threads and (cases := self._board.take()):
            future = self._client.submit(run_cases, self._plan, cases, pure=False)
            self._running[future] = cases
            future.add_done_callback(self._done.put)

    def _next(self) -> Any:
        """Return the next task that has ended; raise CampaignError if the cluster or all workers are lost."""
        while True:
            try:
                return self._done.get(timeout=1.0)
            except queue.Empty:
                self._check_connection()

    def _check_connection(self) -> None:
        now = time.monotonic()
        if self._client.status == "running":
            self._lost_since = None
        else:
            self._lost_since = self._lost_since or now
        if self._client.status == "closed" or (self._lost_since and now - self._lost_since > _LOST_S):
            raise self._gone()
        if self._client.status == "running":
            self._check_workers(now)

    def _check_workers(self, now: float) -> None:
        """Raise CampaignError if the cluster has had no workers for a long time."""
        with suppress(OSError, TimeoutError):  # the connection may break at any time
            if self._client.nthreads():
                self._idle_since = None
                return
        self._idle_since = self._idle_since or now
        if now - self._idle_since > _WITHOUT_WORKERS_S:
            raise self._no_workers("has lost all of its workers, and no other has joined for")

    def _results(self, future: Any, cases: list[int]) -> list[Outcome]:
        """Return the outcomes of a task.

        If its worker died, the cases are run again and the list is empty; after ``MOST_DEATHS`` deaths, the
        list has a failed outcome of the first case. Raises CampaignError if the task cannot run or the
        connection is lost.
        """
        module = distributed()
        try:
            found, seconds = self._result(future)
        except module.KilledWorker as error:
            if self._board.give_back(cases):
                return []
            text = f"{MOST_DEATHS} tasks with this case lost their workers: {_first(error)}"
            return [Outcome(cases[0], "failed", text, {}, {})]
        except (CampaignError, KeyboardInterrupt):
            raise
        except Exception as error:
            if self._client.status != "running" or future.status in ("cancelled", "lost"):
                raise self._gone() from error
            raise CampaignError(
                f"the cluster at {self._address} cannot run the cases: {type(error).__name__}: {error}; its "
                "workers need the same onorbit_rs, Python and scenario files as this machine",
                reason="worker",
            ) from error
        self._board.report(seconds)
        return list(found)

    def _result(self, future: Any) -> Any:
        """Return the result of a task; Dask reruns the task if its worker died before sending the result."""
        seconds = _RESULT_S
        while True:
            try:
                return future.result(timeout=seconds)
            except TimeoutError:
                self._check_connection()
                seconds = min(2.0 * seconds, _LONGEST_RESULT_S)
            except distributed().comm.CommClosedError:  # the scheduler or a worker died during the transfer
                self._check_connection()
                time.sleep(_RETRY_S)

    def _gone(self) -> CampaignError:
        return CampaignError(
            f"the connection to the cluster at {self._address} was lost; check that its scheduler is running",
            reason="cluster gone",
        )

    def _wait_for_workers(self) -> int:
        """Wait for the first worker, and return the number of threads of the cluster."""
        end = time.monotonic() + _WITHOUT_WORKERS_S
        while time.monotonic() < end:
            if threads := sum(self._client.nthreads().values()):
                return int(threads)
            time.sleep(0.2)
        raise self._no_workers("has no workers after")

    def _no_workers(self, what: str) -> CampaignError:
        if self._address == LOCAL:
            where, fix = "the cluster on this machine", "run the campaign again without a cluster"
        else:
            where, fix = f"the cluster at {self._address}", f"start one with 'dask worker {self._address}'"
        return CampaignError(f"{where} {what} {_WITHOUT_WORKERS_S:g} s; {fix}", reason="no workers")


def _first(error: Exception) -> str:
    return " ".join(str(error).split())[:200] or type(error).__name__
