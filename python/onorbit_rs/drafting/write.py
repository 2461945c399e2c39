"""A scenario for a robot, tried before it is handed out."""

from __future__ import annotations

import warnings
from collections.abc import Iterable, Iterator
from dataclasses import dataclass, replace
from pathlib import Path
from time import perf_counter
from typing import TYPE_CHECKING

from onorbit_rs.drafting.arm import ENOUGH, Arm, find_arm
from onorbit_rs.drafting.motion import at_rest, configuration, home, lines, turns
from onorbit_rs.drafting.source import Source
from onorbit_rs.drafting.text import Plan, draft_text
from onorbit_rs.drafting.trial import Trials
from onorbit_rs.exceptions import FrameError, ScenarioError

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray

    from onorbit_rs._core import Model

    Floats = NDArray[np.float64]

LONGEST_S = 30.0
"""Wall-clock time for all trials together, s."""


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
    """Draft a commented scenario in which the robot's arm moves; it has run with its certificate green.

    Trials take at most ``LONGEST_S``. If no motion passes, all joints hold, and a comment states the reasons.

    Parameters
    ----------
    source : Source or str
        The robot, optionally with a bus. A string is a bundled name, a URDF or a xacro file.
    tool : str, optional
        The frame to move; the one that looks most like a tool where not given.
    beside : Path, optional
        The folder that the scenario will lie in: paths are written from there. Absolute where not given.
    command : str
        Written into the first comment.

    Raises
    ------
    OnOrbitError
        If the robot cannot be read, has no such frame, or no plan passes.
    """
    source = Source(source) if isinstance(source, str) else source
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")  # they are repeated when the scenario is checked
        model = source.model()
        if tool is not None:
            model.frame_pose(model.neutral(), tool)  # raises FrameError with the known frames
        arm = find_arm(model, tool)
        if tool is not None and arm is None:
            raise FrameError(
                f"no joint moves the frame {tool!r}; name another with --tool",
                name=tool, kind="frame", known=list(model.frame_names), suggestion=None,
            )  # fmt: skip
        plan = _first_passing(model, arm, Plan(source.name(model), source.entry(None, model)))
    text = draft_text(replace(plan, robot=source.entry(beside, model)), command)
    return Draft(text, plan.tool, plan.arm, model, configuration(model, plan.home))


def _first_passing(model: Model, arm: Arm | None, plan: Plan) -> Plan:
    """Return a plan of the first kind of motion that has one that passes.

    Each kind may use half of the remaining time, so that simpler kinds are always tried.
    """
    trials, ends = Trials(model), perf_counter() + LONGEST_S
    for plans in _kinds(model, arm, plan):
        found = trials.gentlest(plans, 0.5 * (ends - perf_counter()))
        if found is not None:
            return found if found.arm else replace(found, failures=trials.failures() or [_NO_ROOM])
    raise ScenarioError(
        f"no plan for {plan.name} passed, not even holding all joints for a second: "
        f"{', '.join(trials.failures())}. Look at inertias, dampings and limits in 'onorbit info'; "
        "change the file, or name another frame with --tool",
        file=None, path=None, line=None,
    )  # fmt: skip


_NO_ROOM = "the limits of position leave them no room"


def _kinds(model: Model, arm: Arm | None, plan: Plan) -> Iterator[Iterable[Plan]]:
    """Yield the plans of each kind: lines of the tool, turns of its joints, a small turn, all joints held."""
    if arm is None:
        yield [replace(plan, duration_s=60.0, time_step_s=1e-2)]
        return
    pose = _start(model, arm)
    others = [name for name in model.joint_names if name not in arm.joints]
    plan = replace(plan, tool=arm.tool, arm=arm.joints, others=others, home=pose)
    if len(arm.joints) >= ENOUGH:
        yield (
            replace(plan, displacement=displacement, move_s=seconds, duration_s=1.5 * seconds)
            for displacement, seconds in lines(model, arm, pose)
        )
    here = {name: pose[name] for name in arm.joints}
    yield (replace(plan, goal=goal) for goal in turns(model, here, (0.5, 0.2, 0.05)))
    yield (replace(plan, goal=goal, move_s=1.0, duration_s=1.5) for goal in turns(model, here, (0.02,)))
    yield [replace(plan, arm=[], others=list(model.joint_names), duration_s=1.0)]


def _start(model: Model, arm: Arm) -> dict[str, float]:
    """Return the start positions of the arm's joints, and of others that cannot rest at zero."""
    pose = home(model, arm)
    for joint in model.joints:
        if joint.name not in arm.joints and at_rest(joint) != 0.0:
            pose[joint.name] = float(f"{at_rest(joint):.3g}")
    return pose
