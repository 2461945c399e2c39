"""Drafts and tests a scenario in which one spacecraft captures another."""

from __future__ import annotations

import warnings
from collections.abc import Iterator
from dataclasses import dataclass, replace
from functools import partial
from pathlib import Path
from time import perf_counter
from typing import TYPE_CHECKING, cast

import yaml

from onorbit_rs import _core
from onorbit_rs.exceptions import OnOrbitError, ScenarioError
from onorbit_rs.robots.wording import option
from onorbit_rs.scenario import WorldScenario
from onorbit_rs.scenario.build_world import build_world
from onorbit_rs.tools.new_scenario.approach import approach, find_handle, outwardness
from onorbit_rs.tools.new_scenario.arm import find_arm
from onorbit_rs.tools.new_scenario.capture_text import SPEEDS, CapturePlan, capture_text
from onorbit_rs.tools.new_scenario.motion import configuration, fastest_damper, start_positions
from onorbit_rs.tools.new_scenario.source import Source
from onorbit_rs.tools.new_scenario.trial import FAST, OverTimeError, clock
from onorbit_rs.tools.new_scenario.write import LONGEST_S

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray

    from onorbit_rs._core import Model, WorldTrace

    Floats = NDArray[np.float64]


@dataclass(frozen=True)
class CaptureDraft:
    """Text of a drafted scenario with two spacecraft, and the choices made for it."""

    text: str
    tool: str
    handle: str
    model: Model
    """Both spacecraft as one robot, in their initial relative pose."""
    q: Floats
    """Initial configuration of ``model``, (nq,)."""


def draft_capture(
    chaser: Source,
    target: Source,
    *,
    tool: str | None = None,
    handle: str | None = None,
    beside: Path | None = None,
    command: str = "onorbit new",
) -> CaptureDraft:
    """Return a commented scenario of a capture and a release; its trial run passed the certificate.

    All trial runs together take at most ``LONGEST_S`` of wall-clock time, s.

    Parameters
    ----------
    chaser, target : Source
        The spacecraft that captures, and the spacecraft that is captured.
    tool : str, optional
        Frame of the chaser. Default: the most likely tool frame; if there is none, as for ``handle``.
    handle : str, optional
        Frame of the target. Default: the frame that :func:`find_handle` returns.
    beside : Path, optional
        Folder of the new scenario, to which paths are relative. Default: absolute paths.
    command : str
        Text of the first comment.

    Returns
    -------
    CaptureDraft

    Raises
    ------
    OnOrbitError
        If a robot cannot be read or lacks a given frame, or if every trial run fails.
    """
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")  # the warnings are repeated when the scenario is checked
        models = chaser.model(), target.model()
        arm = find_arm(models[0], tool)
        tool = tool or (find_handle(models[0]) if arm is None else arm.tool)
        handle = handle or find_handle(models[1])
        facing = partial(outwardness, models[0], tool)
        homes = start_positions(models[0], arm, facing), start_positions(models[1], None)
        q = [configuration(model, home) for model, home in zip(models, homes, strict=True)]
        for model, frame, at in zip(models, (tool, handle), q, strict=True):
            model.frame_pose(at, frame)  # raises FrameError with the known frames
        placed = approach(models[0], tool, q[0], models[1], handle, q[1])
        plan = _first_passing(models, CapturePlan(
            name=f"{_stem(chaser, models[0])}_captures_{_stem(target, models[1])}",
            chaser=chaser.entry(None, models[0]), target=target.entry(None, models[1]),
            tool=tool, handle=handle, approach=placed, home=homes[0], target_home=homes[1],
            chaser_joints=len(models[0].joint_names), target_joints=len(models[1].joint_names),
        ))  # fmt: skip
    entries = chaser.entry(beside, models[0]), target.entry(beside, models[1])
    text = capture_text(replace(plan, chaser=entries[0], target=entries[1]), command)
    return CaptureDraft(text, tool, handle, *_attached(models, plan, q))


def _stem(source: Source, model: Model) -> str:
    return source.name(model).removesuffix("_first")


def _attached(models: tuple[Model, Model], plan: CapturePlan, q: list[Floats]) -> tuple[Model, Floats]:
    """Return both spacecraft as one robot in their initial relative pose, and its configuration."""
    import numpy as np

    from onorbit_rs.common.coordinates import BASE_NQ
    from onorbit_rs.common.rotations import matrix_from_quaternion

    pose = np.eye(4)
    pose[:3, :3] = matrix_from_quaternion(np.array(plan.approach.quaternion))
    pose[:3, 3] = plan.approach.position
    base = models[1].body_names[0]
    whole = _core.attach(models[0], plan.tool, models[1], base, pose=pose, prefix="target_")
    return whole, np.concatenate([q[0], q[1][BASE_NQ:]])


def _first_passing(models: tuple[Model, Model], plan: CapturePlan) -> CapturePlan:
    """Return the first plan whose trial run passes, in the order of :func:`_plans`."""
    ends = perf_counter() + LONGEST_S
    reasons: dict[str, list[str]] = {}
    for tried in _plans(models, plan):
        reason = _failure(tried, perf_counter() + 0.5 * (ends - perf_counter()))
        if reason is None:
            return tried
        step = f"{1e3 * tried.time_step_s:g} ms"
        setting = f"{tried.integrator} with {step} at {100 * tried.speed:g} cm/s"
        reasons.setdefault(reason, []).append(setting)
    listed = "; ".join(f"{reason} ({', '.join(settings)})" for reason, settings in reasons.items())
    frames = option("--tool and --target-frame", "tool= and handle=")
    raise ScenarioError(
        f"every trial run of {plan.name} failed; check inertias, damping and limits with 'onorbit info', "
        f"change the files, or give other frames with {frames}; reasons: {listed}",
        file=None, path=None, line=None,
    )  # fmt: skip


def _plans(models: tuple[Model, Model], plan: CapturePlan) -> Iterator[CapturePlan]:
    """Yield plans from the fastest approach to the slowest, each with fixed and then with adaptive steps.

    Fixed steps are omitted if a joint is strongly damped.
    """
    is_damped = any(fastest_damper(model)[1] > FAST for model in models)
    step = 1e-3 if plan.chaser_joints + plan.target_joints else 1e-2
    for speed in SPEEDS:
        for time_step in () if is_damped else (step, step / 5.0):
            yield replace(plan, speed=speed, time_step_s=time_step)
        yield replace(plan, speed=speed, time_step_s=step, integrator="dormand_prince")


def _failure(plan: CapturePlan, ends: float) -> str | None:
    """Return the reason why the trial run of a plan fails; None if the run passes."""
    try:
        built = build_world(WorldScenario(**yaml.safe_load(capture_text(plan, "trial"))))
        trace = cast("WorldTrace", built.simulation.run(plan.duration_s, progress=clock(ends)))
    except OverTimeError:
        return "too slow to simulate"
    except OnOrbitError as error:
        return str(error)
    if [record.name for record in trace.events] != ["grasp", "let_go"]:
        return "the frames do not meet"
    failed = [name for name, _, _, passed in trace.certificate() if not passed]
    beyond = []
    for system in trace.names:
        failed += [f"{system}/{name}" for name, _, _, passed in trace[system].certificate() if not passed]
        exceeded = trace[system].joint_limits_exceeded()
        beyond += [f"{system}/{joint} exceeds its position limits" for joint in exceeded]
    return ", ".join([*failed, *beyond]) or None
