"""Published cases, and what must be so anyway, run through the public API: ``onorbit validate``.

One file per family; each lists its ``CASES``. The numbers are short tables with their sources.
"""

from __future__ import annotations

import os
import warnings
from collections.abc import Callable, Sequence
from concurrent.futures import ThreadPoolExecutor, as_completed

from onorbit_rs.exceptions import InputError
from onorbit_rs.validation import (
    against_mujoco,
    against_pinocchio,
    against_sgp4,
    against_spart,
    air_and_light,
    bodies,
    conservation,
    earth,
    gravity,
    kepler,
    nasa,
    order,
    relative,
    robots,
    rotation,
    secular,
    sgp4,
)
from onorbit_rs.validation.case import Case, Check, Gate, Verdict

__all__ = ["CASES", "Case", "Check", "Gate", "Verdict", "run", "select"]

CASES: tuple[Case, ...] = tuple(
    case
    for module in (
        kepler, sgp4, nasa, rotation, earth, gravity, secular, air_and_light, relative, bodies, robots,
        conservation, order, against_pinocchio, against_mujoco, against_sgp4, against_spart,
    )
    for case in module.CASES
)  # fmt: skip
"""Every case, by family."""


def select(only: Sequence[str] = ()) -> list[Case]:
    """The cases whose family or name holds one of the words; without words all.

    Raises
    ------
    InputError
        A word that none holds.
    """
    families = ", ".join(dict.fromkeys(case.family for case in CASES))
    for word in only:
        if not any(_holds(case, word) for case in CASES):
            raise InputError(
                f"no case is called {word!r}; families are {families}",
                name="only", got=word, expected=families,
            )  # fmt: skip
    return [case for case in CASES if not only or any(_holds(case, word) for word in only)]


def _holds(case: Case, word: str) -> bool:
    return word.lower() in f"{case.family} {case.name}".lower()


def run(
    cases: Sequence[Case] = CASES,
    *,
    threads: int | None = None,
    each: Callable[[Case], object] = lambda case: None,
) -> list[Verdict]:
    """Run cases side by side; their verdicts come in their order.

    Parameters
    ----------
    cases : sequence of Case
    threads : int, optional
        How many at a time; as many as there are cores.
    each : callable
        Called with each case that is done, in any order.
    """
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")  # what the robots' files are like is another command's
        with ThreadPoolExecutor(threads or os.cpu_count()) as pool:
            jobs = {pool.submit(case.judge): case for case in cases}
            try:
                for job in as_completed(jobs):
                    each(jobs[job])
            except BaseException:  # Ctrl-C: what has not begun need not
                pool.shutdown(cancel_futures=True)
                raise
    return [job.result() for job in jobs]
