"""Closed loops of a scenario, and initial states that close them."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING, Annotated, ClassVar, Literal

import numpy as np
from pydantic import Field

from onorbit_rs import _core
from onorbit_rs.common.coordinates import JOINTS_Q, JOINTS_V
from onorbit_rs.common.suggestions import did_you_mean
from onorbit_rs.exceptions import InputError
from onorbit_rs.scenario.errors import inconsistent
from onorbit_rs.scenario.fields import Length, Positive
from onorbit_rs.scenario.locations import located
from onorbit_rs.scenario.part import Part
from onorbit_rs.scenario.pose import Pose

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from onorbit_rs.scenario.joint_values import JointValue
    from onorbit_rs.scenario.schema import Scenario

    Floats = NDArray[np.float64]

ACCEPTED = 1e-6
"""Largest deviation of a loop or a mimic joint that is accepted at the start: m or rad; rates: m/s, rad/s."""


class Loop(Part):
    """Joint that closes a kinematic loop between two frames of one robot; its axis, if it has one, is z."""

    synonyms: ClassVar = {"frames": "between", "type": "kind", "distance": "length"}

    name: str
    """Name, unique among the loops."""
    kind: Literal["weld", "revolute", "spherical", "prismatic", "distance"]
    """Type of the joint; ``distance`` keeps the distance of the two origins."""
    between: Annotated[list[str], Field(min_length=2, max_length=2)]
    """The two frames, on different bodies; in a scenario with ``systems``, ``SYSTEM/FRAME`` of one system."""
    pose_a: Pose | None = None
    """Pose of the joint in the first frame. Default: the frames coincide."""
    pose_b: Pose | None = None
    """Pose of the joint in the second frame. Default: the frames coincide."""
    length: Annotated[Length, Positive] | None = None
    """Distance of the origins, m, for ``kind: distance``. Default: that at zero joint positions."""
    project: bool = False
    """Whether the run starts in the nearest configuration that closes the loop. If false, a start that does
    not close the loop is an error."""

    def of_system(self, system: str) -> Loop | None:
        """Return the loop for the scenario of ``system`` alone; None if it belongs to another system.

        In that scenario, the frames are written without the name of the system.
        """
        if self.between[0].partition("/")[0] != system:
            return None
        return self.model_copy(update={"between": [path.partition("/")[2] for path in self.between]})

    def build(self) -> _core.Loop:
        """Return the loop as an object of the engine."""
        poses = [None if pose is None else pose.transform() for pose in (self.pose_a, self.pose_b)]
        return _core.Loop(
            self.name, self.kind, *self.between, pose_a=poses[0], pose_b=poses[1], length=self.length,
            project=self.project,
        )  # fmt: skip


def check_loops(loops: Sequence[Loop], systems: Sequence[str]) -> None:
    """Raise an error for empty or duplicate names, equal frames, and frames that are not of one system.

    ``systems`` are the names of the systems; empty for a scenario of one robot.
    """
    names = [loop.name for loop in loops]
    for index, loop in enumerate(loops):
        at = ("loops", index)
        if not loop.name:
            raise inconsistent((*at, "name"), "the name is empty; give the loop a name")
        if loop.name in names[:index]:
            raise inconsistent((*at, "name"), f"two loops are named {loop.name!r}; names must be unique")
        if loop.between[0] == loop.between[1]:
            message = f"both frames are {loop.between[0]!r}; give frames of two different bodies"
            raise inconsistent((*at, "between"), message)
        if systems:
            for side, path in enumerate(loop.between):
                _check_path((*at, "between", side), path, systems)
            ends = [path.partition("/")[0] for path in loop.between]
            if ends[0] != ends[1]:
                message = (
                    f"the frames belong to two systems, {ends[0]!r} and {ends[1]!r}; give two frames of one "
                    f"system, or connect the systems at the start by an event: {{name: {loop.name}, "
                    f"when: {{at: 0 s}}, do: {{capture: [{', '.join(loop.between)}]}}}}"
                )
                raise inconsistent((*at, "between"), message)


def _check_path(at: tuple[str | int, ...], path: str, systems: Sequence[str]) -> None:
    system, _, frame = path.partition("/")
    if not frame:
        message = f"{path!r} is not a frame of a system; write SYSTEM/FRAME, such as {systems[0]}/tool"
        raise inconsistent(at, message)
    if system not in systems:
        raise inconsistent(at, f"no system is named {system!r}{did_you_mean(system, systems)}")


def add_loops(scenario: Scenario, model: _core.Model) -> _core.Model:
    """Return the robot with the loops of its scenario."""
    for index, loop in enumerate(scenario.loops):
        with located(scenario, "loops", index):
            closing = loop.build()
        with located(scenario, "loops", index, "between"):
            model = model.with_loops([closing])
    return model


def closed_start(scenario: Scenario, model: _core.Model, q: Floats, v: Floats) -> tuple[Floats, Floats]:
    """Return the initial `q` and `v`, in which mimic joints follow their leaders and loops are closed.

    Loops are closed only if one of them has ``project``. If a loop without ``project`` is open, no loop is
    closed, and the simulation raises an error. ``q`` and ``v`` may be overwritten.

    Raises
    ------
    InputError
        If a given value of a mimic joint differs from the one that its leader prescribes.
    ConvergenceError
        If the loops cannot all be closed.
    """
    initial = scenario.initial
    with located(scenario, "initial", "joints"):
        q[JOINTS_Q] = followed("position", initial.joints, q[JOINTS_Q], model)
    with located(scenario, "initial", "joint_rates"):
        v[JOINTS_V] = followed("rate", initial.joint_rates, v[JOINTS_V], model)
    loops = model.loops
    if any(loop.project for loop in loops):
        errors, start = np.asarray(model.loop_errors(q)), 0
        for loop in loops:
            end = start + loop.rows
            if not loop.project and np.linalg.norm(errors[start:end]) > ACCEPTED:
                return q, v
            start = end
        with located(scenario, "loops"):
            q = np.asarray(model.closed_configuration(q))
    return q, v


def followed(
    what: str, given: list[JointValue] | dict[str, JointValue], values: Floats, model: _core.Model
) -> Floats:
    """Return joint ``values`` (n,), positions or rates; mimic joints that are not given follow their leaders.

    Raises
    ------
    InputError
        If a given value differs from the one that the leader prescribes.
    """
    joints = list(model.joint_names)
    followers = [(joints.index(joint.name), joint.mimic) for joint in model.joints if joint.mimic is not None]
    values = values.copy()
    for _ in followers:  # a chain of mimic joints requires several passes
        for index, (leader, ratio, offset) in followers:
            name, shift = joints[index], offset if what == "position" else 0.0
            expected = ratio * values[joints.index(leader)] + shift
            is_given = name in given if isinstance(given, dict) else bool(given)
            if not is_given:
                values[index] = expected
    for index, (leader, ratio, offset) in followers:
        shift = offset if what == "position" else 0.0
        expected = ratio * values[joints.index(leader)] + shift
        if abs(values[index] - expected) > ACCEPTED:
            unit = "m" if model.joints[index].kind == "prismatic" else "rad"
            unit += "" if what == "position" else "/s"
            raise InputError(
                f"the {what} of {joints[index]} is {values[index]:.12g} {unit}, but the joint mimics "
                f"{leader}, which prescribes {expected:.12g} {unit}; correct the value, or give the "
                f"joints as a mapping without {joints[index]}",
                name=joints[index],
            )
    return values
