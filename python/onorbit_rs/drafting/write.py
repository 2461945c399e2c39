"""A scenario for a robot, tried before it is handed out."""

from __future__ import annotations

import warnings
from collections.abc import Iterator
from dataclasses import dataclass, replace
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
import yaml

from onorbit_rs.drafting.arm import ENOUGH, Arm, find_arm
from onorbit_rs.drafting.motion import at_rest, configuration, home, lines, time_step, turns
from onorbit_rs.drafting.reaction import GENTLE
from onorbit_rs.drafting.source import Source
from onorbit_rs.drafting.text import Plan, draft_text
from onorbit_rs.exceptions import FrameError, OnOrbitError, ScenarioError
from onorbit_rs.output.joints import rate_shares
from onorbit_rs.rotations import angle_between
from onorbit_rs.scenario import load
from onorbit_rs.scenario.build import build

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from onorbit_rs._core import Model, Trace

    Floats = NDArray[np.float64]

NEAR_ENOUGH_M = 1e-3
"""Largest distance of the tool from its line in a trial."""

SLOWEST_S = 300.0
"""Longest motion that is drafted; where rate limits ask for more, a shorter displacement is tried."""

_ATTEMPTS = 4
"""Runs of one motion, each slower than the one before."""


@dataclass(frozen=True)
class Draft:
    """The text of a scenario, and what was chosen."""

    text: str
    tool: str | None
    joints: list[str]
    model: Model
    q: Floats
    """Initial configuration (nq,)."""


def draft(
    source: Source | str,
    *,
    tool: str | None = None,
    beside: Path | None = None,
    command: str = "onorbit new",
) -> Draft:
    """A commented scenario in which the robot's arm moves; it has run with its certificate green.

    Parameters
    ----------
    source : Source or str
        The robot, and a bus that carries it; a bundled name, a URDF or a xacro file alone will do.
    tool : str, optional
        The frame to move; the one that looks most like a tool where not given.
    beside : Path, optional
        The folder that the scenario will lie in: paths are written from there. Absolute where not given.
    command : str
        Written into the first comment.

    Raises
    ------
    OnOrbitError
        The robot cannot be read, has no such frame, or nothing that was tried runs.
    """
    source = Source(source) if isinstance(source, str) else source
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")  # said when the scenario is checked
        model = source.model()
        if tool is not None:
            model.frame_pose(model.neutral(), tool)  # says which frames there are
        arm = find_arm(model, tool)
        if tool is not None and arm is None:
            raise FrameError(
                f"no joint moves the frame {tool!r}; name another with --tool",
                name=tool, kind="frame", known=list(model.frame_names), suggestion=None,
            )  # fmt: skip
        plan = _settled(model, arm, source.written(None, model), source.name(model))
    text = draft_text(replace(plan, robot=source.written(beside, model)), command)
    return Draft(text, plan.tool, plan.arm, model, configuration(model, plan.home))


def _settled(model: Model, arm: Arm | None, robot: Any, name: str) -> Plan:
    """The first plan that runs as it should and leaves the base nearly as it is, else the gentlest."""
    last: OnOrbitError | None = None
    found: list[tuple[float, Plan]] = []
    for plan in _plans(model, arm, Plan(name, robot)):
        try:
            tried = _tried(model, plan)
        except OnOrbitError as error:
            last = error
            continue
        if tried is None:
            continue
        if tried[0] <= GENTLE or arm is None:
            return tried[1]
        found.append(tried)
    if found:
        return min(found, key=lambda one: one[0])[1]
    if last is not None:
        raise last
    raise ScenarioError(
        f"no motion of {name} that was tried stays within its joints' limits of position and rate and "
        "certifies; write one by hand, beginning with 'onorbit info'",
        file=None, path=None, line=None,
    )  # fmt: skip


def _plans(model: Model, arm: Arm | None, plan: Plan) -> Iterator[Plan]:
    if arm is None:
        yield replace(plan, duration_s=60.0, time_step_s=1e-2)
        return
    pose = home(model, arm)
    others = [name for name in model.joint_names if name not in arm.joints]
    for joint in model.joints:  # zero may be out of bounds, or at one
        if joint.name in others and at_rest(joint) != 0.0:
            pose[joint.name] = float(f"{at_rest(joint):.3g}")
    plan = replace(
        plan, tool=arm.tool, arm=arm.joints, others=others, home=pose, time_step_s=time_step(model),
    )  # fmt: skip
    if len(arm.joints) >= ENOUGH:
        for displacement, seconds in lines(model, arm, pose):
            yield replace(plan, displacement=displacement, move_s=seconds, duration_s=1.5 * seconds)
    for goal in turns(model, {name: pose[name] for name in arm.joints}):
        yield replace(plan, goal=goal)


def _tried(model: Model, plan: Plan) -> tuple[float, Plan] | None:
    """Return by how much the base turns in a run, rad, and the plan, slowed to the joints' rate limits.

    None where the run does not certify, leaves the joints' limits or its line, or would have to be slower
    than ``SLOWEST_S``.
    """
    for _ in range(_ATTEMPTS):
        run = _run(plan)
        if run is None:
            return None
        trace, turn = run
        share = rate_shares(trace, model).max(initial=0.0)
        if share <= 1.0:
            return turn, plan
        # rates go with the inverse of the duration
        move_s = float(f"{1.05 * share * plan.move_s:.2g}")
        if move_s > SLOWEST_S:
            return None
        plan = replace(plan, move_s=move_s, duration_s=round(1.5 * move_s, 3), is_slowed=True)
    return None


def _run(plan: Plan) -> tuple[Trace, float] | None:
    """Return the trace of a plan, and by how much its base turns, rad.

    None where the run does not certify, leaves the joints' limits or its line.
    """
    built = build(load(yaml.safe_load(draft_text(plan, "trial"))))
    trace = built.simulation.run(plan.duration_s)
    if not all(passed for *_, passed in trace.certificate()) or trace.joint_limits_exceeded():
        return None
    is_tracked = plan.displacement is not None
    if is_tracked and np.linalg.norm(np.asarray(trace.position_error), axis=1).max() >= NEAR_ENOUGH_M:
        return None
    attitude = np.asarray(trace.q)[:, 3:7]
    return trace, float(angle_between(attitude, attitude[0]).max())
