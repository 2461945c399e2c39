"""References that controllers track.

To add a kind of reference, write its class in a new file, and add the class to the union.
"""

from __future__ import annotations

from typing import Annotated

from pydantic import Field

from onorbit_rs.scenario.part import of_kind
from onorbit_rs.scenario.reference.bag import BagReference
from onorbit_rs.scenario.reference.circle import CircleReference, ScrewReference
from onorbit_rs.scenario.reference.hold import HoldReference
from onorbit_rs.scenario.reference.joint_hold import JointHoldReference
from onorbit_rs.scenario.reference.joint_ramps import JointRampsReference
from onorbit_rs.scenario.reference.joint_sampled import JointSampledReference
from onorbit_rs.scenario.reference.joint_waypoints import JointWaypointsReference
from onorbit_rs.scenario.reference.line import LineReference
from onorbit_rs.scenario.reference.line_parabola import LineParabolaReference
from onorbit_rs.scenario.reference.sampled import SampledReference
from onorbit_rs.scenario.reference.task import TaskReference
from onorbit_rs.scenario.reference.waypoints import WaypointsReference

__all__ = [
    "AnyReference",
    "BagReference",
    "HoldReference",
    "JointHoldReference",
    "JointRampsReference",
    "JointSampledReference",
    "JointWaypointsReference",
    "Reference",
    "SampledReference",
    "TaskReference",
]

AnyReference = (
    HoldReference
    | LineParabolaReference
    | LineReference
    | CircleReference
    | ScrewReference
    | WaypointsReference
    | SampledReference
    | JointHoldReference
    | JointWaypointsReference
    | JointRampsReference
    | JointSampledReference
    | BagReference
)
Reference = Annotated[AnyReference, Field(discriminator="kind"), of_kind(AnyReference)]
