"""Drafts and tests a scenario for a robot."""

from __future__ import annotations

import warnings
from collections.abc import Iterable, Iterator
from dataclasses import dataclass, replace
from pathlib import Path
from time import perf_counter
from typing import TYPE_CHECKING

from onorbit_rs.exceptions import FrameError, ScenarioError
from onorbit_rs.robots.wording import option
from onorbit_rs.tools.new_scenario.arm import FULL_POSE_JOINTS, Arm, find_arm
from onorbit_rs.tools.new_scenario.motion import configuration, joint_goals, lines, start_positions
from onorbit_rs.tools.new_scenario.source import Source
from onorbit_rs.tools.new_scenario.text import Plan, draft_text
from onorbit_rs.tools.new_scenario.trial import Trials

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray

    from onorbit_rs._core import Model

    Floats = NDArray[np.float64]

LONGEST_S = 30.0
"""Limit on the wall-clock time of all trials together, s."""


@dataclass(frozen=True)
class Draft:
    """Text of a drafted scenario, and the choices made for it."""

    text: str
    tool: str | None
    """Tool frame; None if no joint moves a frame."""
    joints: list[str]
    """Joints that move the tool; empty if the scenario only holds joints or the robot rotates freely."""
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
    """Return a commented scenario in which the robot's arm moves; its trial run passed the certificate.

    All trial runs together take at most ``LONGEST_S`` of wall-clock time, s. If every trial of a motion
    fails, all joints are held, and a comment in the scenario gives the reasons. A robot without an arm
    rotates freely.

    Parameters
    ----------
    source : Source or str
        The robot, optionally with a bus. A string is a bundled name, a URDF or a xacro file.
    tool : str, optional
        Frame to move. Default: the most likely tool frame.
    beside : Path, optional
        Folder of the new scenario, to which paths are relative. Default: absolute paths.
    command : str
        Text of the first comment.

    Returns
    -------
    Draft

    Raises
    ------
    OnOrbitError
        If the robot cannot be read or lacks the frame, no joint moves the frame, or every trial run fails.
    """
    source = Source(source) if isinstance(source, str) else source
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")  # the warnings are repeated when the scenario is checked
        model = source.model()
        if tool is not None:
            model.frame_pose(model.neutral(), tool)  # raises FrameError with the known frames
        arm = find_arm(model, tool)
        if tool is not None and arm is None:
            raise FrameError(
                f"no joint moves the frame {tool!r}; give another frame with {option('--tool', 'tool=')}",
                name=tool, kind="frame", known=list(model.frame_names), suggestion=None,
            )  # fmt: skip
        plan = _first_passing(model, arm, Plan(source.name(model), source.entry(None, model)))
    text = draft_text(replace(plan, robot=source.entry(beside, model)), command)
    return Draft(text, plan.tool, plan.arm, model, configuration(model, plan.home))


def _first_passing(model: Model, arm: Arm | None, plan: Plan) -> Plan:
    """Return the first passing plan; kinds of motion are tried one after another.

    Each kind may use half of the remaining time, so that simpler kinds are always tried.
    """
    trials, ends = Trials(model), perf_counter() + LONGEST_S
    for plans in _kinds(model, arm, plan):
        found = trials.gentlest(plans, 0.5 * (ends - perf_counter()))
        if found is not None:
            return found if found.arm else replace(found, failures=trials.failures() or [_NO_ROOM])
    held = ", including one that holds all joints for 1 s"
    other = f", or give another frame with {option('--tool', 'tool=')}"
    if arm is None:
        held = other = ""
    raise ScenarioError(
        f"every trial run of {plan.name} failed{held}; check the inertias, damping and limits with "
        f"'onorbit info' and correct the file{other}; reasons: {', '.join(trials.failures())}",
        file=None, path=None, line=None,
    )  # fmt: skip


_NO_ROOM = "position limits leave no range of motion"


def _kinds(model: Model, arm: Arm | None, plan: Plan) -> Iterator[Iterable[Plan]]:
    """Yield plans of each kind: lines of the tool, joint motions, small joint motions, all joints held.

    Without an arm, the only plan is a free motion of the robot. Lines require an arm of six joints.
    """
    if arm is None:
        yield [replace(plan, duration_s=60.0, time_step_s=1e-2)]
        return
    pose = start_positions(model, arm)
    others = [name for name in model.joint_names if name not in arm.joints]
    plan = replace(plan, tool=arm.tool, arm=arm.joints, others=others, home=pose)
    if len(arm.joints) >= FULL_POSE_JOINTS:
        yield (
            replace(plan, displacement=displacement, move_s=seconds, duration_s=1.5 * seconds)
            for displacement, seconds in lines(model, arm, pose)
        )
    here = {name: pose[name] for name in arm.joints}
    yield (replace(plan, goal=goal) for goal in joint_goals(model, here, (0.5, 0.2, 0.05)))
    yield (replace(plan, goal=goal, move_s=1.0, duration_s=1.5) for goal in joint_goals(model, here, (0.02,)))
    yield [replace(plan, arm=[], others=list(model.joint_names), duration_s=1.0)]
