"""Trial runs of drafted scenarios."""

from __future__ import annotations

import math
from collections import Counter
from collections.abc import Callable, Iterable
from dataclasses import replace
from time import perf_counter
from typing import TYPE_CHECKING

import numpy as np
import yaml

from onorbit_rs.common.coordinates import QUATERNION
from onorbit_rs.common.counting import count
from onorbit_rs.common.rotations import angle_between
from onorbit_rs.exceptions import OnOrbitError, SimulationError
from onorbit_rs.output.joints import effort_fractions, rate_fractions
from onorbit_rs.scenario import Scenario
from onorbit_rs.scenario.build import build
from onorbit_rs.tools.new_scenario.motion import fastest_damper
from onorbit_rs.tools.new_scenario.reaction import GENTLE
from onorbit_rs.tools.new_scenario.text import Plan, draft_text

if TYPE_CHECKING:
    from onorbit_rs._core import Model, Trace

NEAR_ENOUGH_M = 1e-3
"""Largest allowed distance of the tool from its line in a trial run, m."""

SLOWEST_S = 300.0
"""Longest duration of a motion, s; if limits require a longer one, a shorter displacement is tried."""

_ATTEMPTS = 4
"""Largest number of runs of one motion, each slower than the previous one."""
_INERTIAL = 0.9
"""Ratio of the efforts after a motion is slowed to those before; above it, they are not due to inertia."""
FAST = 500.0
"""Decay rate, 1/s, above which steps are adaptive: a fixed step of 1 ms exceeds half a time constant."""
_FIRST_ESTIMATE_S, _OVERTIME = 2.0, 1.2
"""Wall-clock time, s, after which a run that would take ``_OVERTIME`` times the remaining time is stopped."""
_FIXED, _ADAPTIVE = "rk4", "dormand_prince"


class Trials:
    """Runs plans for one robot and counts the reasons for failures.

    After a run with fixed steps has failed, all later runs use the adaptive integrator, since fast dampers
    are a property of the robot.
    """

    def __init__(self, model: Model) -> None:
        """Choose fixed steps, or adaptive steps if the dampers are too fast for fixed steps."""
        self._model = model
        self._damped, self._decay = fastest_damper(model)
        self._integrator = _ADAPTIVE if self._decay > FAST else _FIXED
        self._failures: Counter[str] = Counter()
        self._is_late = False

    def gentlest(self, plans: Iterable[Plan], seconds: float) -> Plan | None:
        """Return the first passing plan that rotates the base by at most ``GENTLE``.

        If there is none, return the passing plan with the smallest rotation, or None if no plan passes within
        ``seconds`` of wall-clock time.
        """
        ends = perf_counter() + seconds
        found: list[tuple[float, Plan]] = []
        self._is_late = False
        for plan in plans:
            tried = self._slowed(plan, ends)
            found += [tried] if tried is not None else []
            if self._is_late or perf_counter() >= ends or (tried is not None and tried[0] <= GENTLE):
                break
        return min(found, key=lambda one: one[0])[1] if found else None

    def failures(self) -> list[str]:
        """Return the most frequent reasons for failures, including a joint whose damping prevents motion."""
        reasons = [f"{what} ({count(times, 'run', 'runs')})" for what, times in self._failures.most_common(4)]
        if self._decay > FAST:
            reasons.append(f"the damping of {self._damped} stops the joint within {1.0 / self._decay:.1g} s")
        return reasons

    def _slowed(self, plan: Plan, ends: float) -> tuple[float, Plan] | None:
        """Return the largest base rotation, rad, and the plan, slowed down so that joints keep their limits.

        Returns None if no run passes with rates within their limits, in a motion of at most ``SLOWEST_S``.
        Joints that exceed their effort limits at any speed, for example because of friction, are listed in
        the plan.
        """
        done, before = None, math.inf
        for _ in range(_ATTEMPTS):
            trace = self._run(plan, ends)
            if trace is None:
                return done
            rate = rate_fractions(trace, self._model).max(initial=0.0)
            efforts = effort_fractions(trace, self._model)
            effort = efforts.max(initial=0.0)
            if rate <= 1.0:
                exceeding = np.array(self._model.joint_names)[efforts > 1.0].tolist()
                done = _rotation(trace), replace(plan, integrator=self._integrator, exceeding=exceeding)
            # rates scale with the inverse of the duration, inertial efforts with its square
            slower = max(rate, math.sqrt(effort) if effort < _INERTIAL * before else 0.0)
            move_s = float(f"{1.05 * slower * plan.move_s:.2g}")
            if slower <= 1.0 or move_s > SLOWEST_S:
                break
            before = effort
            plan = replace(plan, move_s=move_s, duration_s=round(1.5 * move_s, 3), is_slowed=True)
        if done is None:
            self._failures["rate limits require too slow a motion"] += 1
        return done

    def _run(self, plan: Plan, ends: float) -> Trace | None:
        """Return the trace of a plan; None if the run fails."""
        plan = replace(plan, integrator=self._integrator)
        try:
            trace = _trace(plan, ends)
        except OverTimeError:
            self._is_late = True  # later plans of this kind would also take too long
            self._failures["too slow to simulate"] += 1
            return None
        except OnOrbitError as error:
            # the message contains a time, which differs from run to run
            failed = [_stopped(error) if isinstance(error, SimulationError) else str(error)]
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
        """Return whether the joints stay within their position limits and the tool stays near its line."""
        beyond = trace.joint_limits_exceeded()
        self._failures.update(f"{name} exceeds its position limits" for name in beyond)
        if plan.displacement is None or beyond:
            return not beyond
        is_near = np.linalg.norm(np.asarray(trace.position_error), axis=1).max() < NEAR_ENOUGH_M
        self._failures.update([] if is_near else ["the tool deviates from its line"])
        return bool(is_near)


class OverTimeError(Exception):
    """Raised if a trial run would exceed its limit of wall-clock time."""


def _trace(plan: Plan, ends: float) -> Trace:
    """Return the trace of a plan.

    Raises OverTimeError if it would end after ``ends``, s; see :func:`clock`.
    """
    built = build(Scenario(**yaml.safe_load(draft_text(plan, "trial"))))
    return built.simulation.run(plan.duration_s, progress=clock(ends))


def clock(ends: float) -> Callable[[float, float], None]:
    """Return the progress callback that raises ``OverTimeError`` if the run would end after ``ends``, s.

    ``ends`` is a wall-clock time of ``perf_counter``.
    """
    began = perf_counter()

    def check(reached_s: float, total_s: float) -> None:
        now = perf_counter()
        is_slow = (now - began) * total_s > _OVERTIME * (ends - began) * reached_s
        if now >= ends or (is_slow and now - began > _FIRST_ESTIMATE_S):
            raise OverTimeError

    return check


def _stopped(error: SimulationError) -> str:
    """Return in words why a run stopped before its end; only a divergence has a last state ``q``."""
    return "the run diverged" if error.q is not None else "the simulation failed before the end of the run"


def _rotation(trace: Trace) -> float:
    """Return the largest rotation of the base from its first attitude, rad."""
    attitude = np.asarray(trace.q)[:, QUATERNION]
    return float(angle_between(attitude, attitude[0]).max())
