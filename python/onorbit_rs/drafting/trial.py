"""Runs of a drafted scenario, which say whether it will do."""

from __future__ import annotations

import math
from collections import Counter
from collections.abc import Iterable
from dataclasses import replace
from time import perf_counter
from typing import TYPE_CHECKING

import numpy as np
import yaml

from onorbit_rs.counting import count
from onorbit_rs.drafting.motion import quickest_damper
from onorbit_rs.drafting.reaction import GENTLE
from onorbit_rs.drafting.text import Plan, draft_text
from onorbit_rs.exceptions import OnOrbitError, SimulationError
from onorbit_rs.output.joints import effort_shares, rate_shares
from onorbit_rs.rotations import angle_between
from onorbit_rs.scenario import load
from onorbit_rs.scenario.build import build

if TYPE_CHECKING:
    from onorbit_rs._core import Model, Trace

NEAR_ENOUGH_M = 1e-3
"""Largest distance of the tool from its line in a trial."""

SLOWEST_S = 300.0
"""Longest motion that is drafted; where limits ask for more, a shorter one is tried."""

_ATTEMPTS = 4
"""Runs of one motion, each slower than the one before."""
_HELPED = 0.9
"""Efforts that a slower motion leaves above this share of what they were do not come from inertia."""
_QUICK = 500.0
"""Rate of decay, 1/s, of which a fixed step of a millisecond is half a time constant."""
_TO_SEE_S, _PATIENCE = 2.0, 1.2
"""After how much wall clock a run is stopped that at its pace would take so many times what is left."""
_FIXED, _ADAPTIVE = "rk4", "dormand_prince"


class Trials:
    """Runs of the plans for one robot, and what they failed by.

    Once fixed steps have failed, the adaptive integrator is used for all that follows: quick dampers are the
    robot's, whatever its motion.
    """

    def __init__(self, model: Model) -> None:
        """Start with fixed steps, unless dampers are too quick for them."""
        self._model = model
        self._damped, self._decay = quickest_damper(model)
        self._integrator = _ADAPTIVE if self._decay > _QUICK else _FIXED
        self._failures: Counter[str] = Counter()
        self._is_late = False

    def gentlest(self, plans: Iterable[Plan], seconds: float) -> Plan | None:
        """Return the first plan that passes and hardly turns the base, else the gentlest that passes.

        None where none does within ``seconds`` of wall clock.
        """
        ends = perf_counter() + seconds
        found: list[tuple[float, Plan]] = []
        self._is_late = False
        for plan in plans:
            tried = self._slow_enough(plan, ends)
            found += [tried] if tried is not None else []
            if self._is_late or perf_counter() >= ends or (tried is not None and tried[0] <= GENTLE):
                break
        return min(found, key=lambda one: one[0])[1] if found else None

    def failures(self) -> list[str]:
        """What the runs failed by, the most frequent first."""
        said = [f"{what} ({count(times, 'run', 'runs')})" for what, times in self._failures.most_common(4)]
        if self._decay > _QUICK:
            said.append(f"the damper of {self._damped} stops it within {1.0 / self._decay:.1g} s")
        return said

    def _slow_enough(self, plan: Plan, ends: float) -> tuple[float, Plan] | None:
        """Return by how much the base turns in a run, rad, and the plan, slowed to the limits of the joints.

        None where the run will not do, or would have to be slower than ``SLOWEST_S`` for the limits of rate.
        Efforts beyond their limits that a slower motion does not mend, as against friction, are noted in the
        plan.
        """
        done, before = None, math.inf
        for _ in range(_ATTEMPTS):
            trace = self._run(plan, ends)
            if trace is None:
                return done
            rate = rate_shares(trace, self._model).max(initial=0.0)
            efforts = effort_shares(trace, self._model)
            effort = efforts.max(initial=0.0)
            if rate <= 1.0:
                exceeding = np.array(self._model.joint_names)[efforts > 1.0].tolist()
                done = _turn(trace), replace(plan, integrator=self._integrator, exceeding=exceeding)
            # rates go with the inverse of the duration, inertial efforts with its square
            slower = max(rate, math.sqrt(effort) if effort < _HELPED * before else 0.0)
            move_s = float(f"{1.05 * slower * plan.move_s:.2g}")
            if slower <= 1.0 or move_s > SLOWEST_S:
                break
            before = effort
            plan = replace(plan, move_s=move_s, duration_s=round(1.5 * move_s, 3), is_slowed=True)
        if done is None:
            self._failures["too slow for the limits of rate"] += 1
        return done

    def _run(self, plan: Plan, ends: float) -> Trace | None:
        """Return the trace of a plan, None where it will not do."""
        plan = replace(plan, integrator=self._integrator)
        try:
            trace = _trace(plan, ends)
        except _OverTimeError:
            self._is_late = True  # and the next of its kind would be, too
            self._failures["not simulated in time"] += 1
            return None
        except OnOrbitError as error:
            # its text names an instant, another one in every run
            failed = ["the integration broke down" if isinstance(error, SimulationError) else str(error)]
        else:
            failed = [name for name, *_, passed in trace.certificate() if not passed]
            if not failed:
                return trace if self._is_within(trace, plan) else None
        if self._integrator == _FIXED:
            self._integrator = _ADAPTIVE
            return self._run(plan, ends)
        self._failures.update(failed)
        return None

    def _is_within(self, trace: Trace, plan: Plan) -> bool:
        """Whether joints stay within their limits of position, and the tool near its line."""
        beyond = trace.joint_limits_exceeded()
        self._failures.update(f"limits of {name}" for name in beyond)
        if plan.displacement is None or beyond:
            return not beyond
        is_near = np.linalg.norm(np.asarray(trace.position_error), axis=1).max() < NEAR_ENOUGH_M
        self._failures.update([] if is_near else ["the tool leaves its line"])
        return bool(is_near)


class _OverTimeError(Exception):
    """The time for a run is over."""


def _trace(plan: Plan, ends: float) -> Trace:
    """Run a plan, or as much of it as tells that it will not be done by ``ends``."""
    began = perf_counter()

    def look_at_clock(reached_s: float, total_s: float) -> None:
        now = perf_counter()
        is_slow = (now - began) * total_s > _PATIENCE * (ends - began) * reached_s
        if now >= ends or (is_slow and now - began > _TO_SEE_S):
            raise _OverTimeError

    built = build(load(yaml.safe_load(draft_text(plan, "trial"))))
    return built.simulation.run(plan.duration_s, progress=look_at_clock)


def _turn(trace: Trace) -> float:
    """Return by how much the base turns, rad."""
    attitude = np.asarray(trace.q)[:, 3:7]
    return float(angle_between(attitude, attitude[0]).max())
