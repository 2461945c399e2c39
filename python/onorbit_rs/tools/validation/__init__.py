"""Published cases and conservation laws, checked through the public API: ``onorbit validate``.

Files with cases list them in ``CASES``: short tables of numbers with their sources.
"""

from __future__ import annotations

import os
import warnings
from collections.abc import Callable, Sequence
from concurrent.futures import ThreadPoolExecutor, as_completed

from onorbit_rs.exceptions import InputError
from onorbit_rs.tools.validation import (
    against_mujoco,
    against_pinocchio,
    against_pinocchio_loops,
    against_sgp4,
    against_spart,
    air_and_light,
    bodies,
    brakes,
    capture,
    conservation,
    contact,
    contact_boxes,
    contact_friction,
    contact_grasp,
    contact_rigid,
    earth,
    grasp,
    gravity,
    kepler,
    loops,
    loops_drift,
    loops_gauss,
    nasa,
    order,
    relative,
    robots,
    rotation,
    seating,
    secular,
    sgp4,
    springs,
    worlds,
)
from onorbit_rs.tools.validation.case import Case, Check, Gate, Verdict

__all__ = ["CASES", "Case", "Check", "Gate", "Verdict", "run", "select"]

CASES: tuple[Case, ...] = tuple(
    case
    for module in (
        kepler, sgp4, nasa, rotation, earth, gravity, secular, air_and_light, relative, bodies, robots,
        conservation, capture, seating, brakes, springs, loops, loops_gauss,
        loops_drift, against_pinocchio_loops, contact, contact_boxes,
        contact_friction, contact_grasp, contact_rigid, grasp, worlds, order,
        against_pinocchio, against_mujoco, against_sgp4, against_spart,
    )
    for case in module.CASES
)  # fmt: skip
"""All cases, grouped by family."""


def select(only: Sequence[str] = ()) -> list[Case]:
    """Return the cases whose family or name contains one of the words; without words, all cases.

    Raises
    ------
    InputError
        If a word matches no case.
    """
    families = ", ".join(dict.fromkeys(case.family for case in CASES))
    for word in only:
        if not any(_matches(case, word) for case in CASES):
            raise InputError(
                f"no case matches {word!r}; give part of the name of a case, or one of the families: "
                f"{families}",
                name="only", got=word, expected=families,
            )  # fmt: skip
    return [case for case in CASES if not only or any(_matches(case, word) for word in only)]


def _matches(case: Case, word: str) -> bool:
    return word.lower() in f"{case.family} {case.name}".lower()


def run(
    cases: Sequence[Case] = CASES,
    *,
    threads: int | None = None,
    each: Callable[[Case], object] = lambda case: None,
) -> list[Verdict]:
    """Run the cases in parallel and return their verdicts in the same order.

    Parameters
    ----------
    cases : sequence of Case
        Cases to run.
    threads : int, optional
        Number of cases that run at the same time; default: the number of cores.
    each : callable
        Called with each completed case, in any order.
    """
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")  # warnings about robot files are shown by another command
        with ThreadPoolExecutor(threads or os.cpu_count()) as pool:
            jobs = {pool.submit(case.judge): case for case in cases}
            try:
                for job in as_completed(jobs):
                    each(jobs[job])
            except BaseException:  # on Ctrl-C, cases that wait are not started
                pool.shutdown(cancel_futures=True)
                raise
    return [job.result() for job in jobs]
