"""Planar linkages on a free base, as robots and as closed forms."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Any, Literal

import numpy as np

import onorbit_rs as oo
from onorbit_rs.common.coordinates import BASE_NV, JOINTS_Q, JOINTS_V
from onorbit_rs.tools.validation.planar import Body, Reduced, arm, four_bar, reduce, rod, slider_crank
from onorbit_rs.tools.validation.trees import Array

BASE_MASS, BASE_INERTIA = 4.0, (0.3, 0.4, 0.5)  # kg, kg m²
PIVOT = 0.1 + 0.2j
"""Pivot of the crank in the base, m."""
LENGTHS = (0.2, 0.5, 0.4, 0.5)
"""Lengths of crank, coupler and rocker, and the distance of the pivots, m; the crank can turn fully."""
MASSES = (0.5, 0.8, 0.6)  # kg, of crank, coupler and rocker, or of crank, rod and slider
CRANK, ROD = 0.2, 0.5  # m, of the slider-crank
SLIDER_INERTIA = 0.01  # kg m²

FreeKind = Literal["weld", "revolute", "spherical", "prismatic", "distance"]


def at(x: float = 0.0, turned: Sequence[Sequence[float]] | None = None) -> Array:
    """Return the pose (4, 4) of a frame shifted by ``x``, m, and rotated by ``turned`` (3, 3), if given."""
    pose = np.eye(4)
    pose[0, 3] = x
    pose[:3, :3] = np.eye(3) if turned is None else turned
    return pose


ALONG_X = ((0.0, 0.0, 1.0), (1.0, 0.0, 0.0), (0.0, 1.0, 0.0))
"""Rotation that turns z to x."""


def base(name: str) -> oo.ModelBuilder:
    """Return a builder of a robot that has only the base so far."""
    return oo.ModelBuilder(name, base="base", mass=BASE_MASS, inertia=np.diag(BASE_INERTIA))


def add_rod(builder: oo.ModelBuilder, name: str, parent: str, x: complex, mass: float, length: float) -> None:
    """Add a uniform rod along x with a joint about z at ``x``, m, in its parent."""
    across = mass * length**2 / 12.0
    builder.add_link(
        name, parent=parent, joint=f"{name}_joint", xyz=[x.real, x.imag, 0.0], mass=mass,
        com=[length / 2.0, 0.0, 0.0], inertia=np.diag([0.01 * across, across, across]),
    )  # fmt: skip


@dataclass(frozen=True)
class Linkage:
    """A robot with a closed loop, and its motion as functions of the angle ``θ`` of its first joint.

    ``joints(θ)`` returns (3, n): the positions of all joints, and their first and second derivatives with
    respect to ``θ``. ``bodies(θ)`` returns the bodies in the plane, the base first.
    """

    model: oo.Model
    joints: Callable[[float], Array]
    bodies: Callable[[float], list[Body]]

    def reduced(self, crank: float) -> Reduced:
        """Return the equation of motion at zero total momentum."""
        return reduce(self.bodies(crank))

    def state(self, crank: float, rate: float) -> tuple[Array, Array]:
        """Return the configuration and the velocity at zero total momentum, for an angle and its rate."""
        q, v = self.model.neutral(), np.zeros(self.model.nv)
        q[JOINTS_Q], slope, _ = self.joints(crank)
        reduced = self.reduced(crank)
        v[:2] = rate * reduced.velocity.real, rate * reduced.velocity.imag
        v[BASE_NV - 1], v[JOINTS_V] = rate * reduced.spin, rate * slope
        return q, v


def _base_body() -> Body:
    return Body(BASE_MASS, BASE_INERTIA[2], (0.0, 0.0, 0.0))


def four_bar_linkage(kind: Any = "revolute") -> Linkage:
    """Return a four-bar linkage that is closed between coupler and rocker, by a pin or a ball joint."""
    a, b, c, d = LENGTHS
    builder = base("four_bar")
    add_rod(builder, "crank", "base", PIVOT, MASSES[0], a)
    add_rod(builder, "coupler", "crank", a, MASSES[1], b)
    add_rod(builder, "rocker", "base", PIVOT + d, MASSES[2], c)
    builder.close(oo.Loop("pin", kind, "coupler", "rocker", pose_a=at(b), pose_b=at(c)))

    def joints(crank: float) -> Array:
        (phi, phi1, phi2), psi = four_bar(crank, LENGTHS)
        return np.array([(crank, 1.0, 0.0), (phi - crank, phi1 - 1.0, phi2), psi]).T

    def bodies(crank: float) -> list[Body]:
        first = (crank, 1.0, 0.0)
        coupler, rocker = four_bar(crank, LENGTHS)
        tip, tip1, tip2 = arm(first, a)
        return [
            _base_body(),
            rod(first, a, MASSES[0], (PIVOT, 0.0, 0.0)),
            rod(coupler, b, MASSES[1], (PIVOT + tip, tip1, tip2)),
            rod(rocker, c, MASSES[2], (PIVOT + d, 0.0, 0.0)),
        ]

    return Linkage(builder.build(), joints, bodies)


def cranks_with_rod() -> Linkage:
    """Return two cranks whose tips a massless rod connects: a loop that keeps their distance."""
    a, b, c, d = LENGTHS
    builder = base("two_cranks")
    add_rod(builder, "crank", "base", PIVOT, MASSES[0], a)
    add_rod(builder, "rocker", "base", PIVOT + d, MASSES[2], c)
    builder.close(oo.Loop("rod", "distance", "crank", "rocker", pose_a=at(a), pose_b=at(c), length=b))

    def joints(crank: float) -> Array:
        return np.array([(crank, 1.0, 0.0), four_bar(crank, LENGTHS)[1]]).T

    def bodies(crank: float) -> list[Body]:
        _, rocker = four_bar(crank, LENGTHS)
        first = rod((crank, 1.0, 0.0), a, MASSES[0], (PIVOT, 0.0, 0.0))
        return [_base_body(), first, rod(rocker, c, MASSES[2], (PIVOT + d, 0.0, 0.0))]

    return Linkage(builder.build(), joints, bodies)


def slider_crank_linkage(kind: Any = "revolute") -> Linkage:
    """Return a slider-crank, closed at the pin between rod and slider or, if prismatic, at the slide."""
    builder = base("slider_crank")
    add_rod(builder, "crank", "base", PIVOT, MASSES[0], CRANK)
    add_rod(builder, "rod", "crank", CRANK, MASSES[1], ROD)
    slider: Any = {"mass": MASSES[2], "inertia": SLIDER_INERTIA * np.eye(3)}
    if kind == "prismatic":
        builder.add_link("slider", parent="rod", joint="slider_joint", xyz=[ROD, 0.0, 0.0], **slider)
        builder.add_frame("slide", "base", xyz=[PIVOT.real, PIVOT.imag, 0.0])
        builder.close(
            oo.Loop("slide", kind, "slide", "slider", pose_a=at(turned=ALONG_X), pose_b=at(turned=ALONG_X))
        )
    else:
        builder.add_link(
            "slider", parent="base", joint="slider_joint", kind="prismatic", axis=[1, 0, 0],
            xyz=[PIVOT.real, PIVOT.imag, 0.0], **slider,
        )  # fmt: skip
        builder.close(oo.Loop("pin", kind, "rod", "slider", pose_a=at(ROD)))

    def joints(crank: float) -> Array:
        (beta, beta1, beta2), x = slider_crank(crank, CRANK, ROD)
        last = (-beta, -beta1, -beta2) if kind == "prismatic" else x
        return np.array([(crank, 1.0, 0.0), (beta - crank, beta1 - 1.0, beta2), last]).T

    def bodies(crank: float) -> list[Body]:
        angle, (x, x1, x2) = slider_crank(crank, CRANK, ROD)
        tip, tip1, tip2 = arm((crank, 1.0, 0.0), CRANK)
        return [
            _base_body(),
            rod((crank, 1.0, 0.0), CRANK, MASSES[0], (PIVOT, 0.0, 0.0)),
            rod(angle, ROD, MASSES[1], (PIVOT + tip, tip1, tip2)),
            Body(MASSES[2], SLIDER_INERTIA, (PIVOT + x, x1, x2)),
        ]

    return Linkage(builder.build(), joints, bodies)


def geared_wheels(ratio: float, inertias: tuple[float, float]) -> oo.Model:
    """Return two wheels about z on the base, of which the second mimics the first with this ratio."""
    builder = base("geared_wheels")
    for index, inertia in enumerate(inertias):
        mimic: Any = None if index == 0 else ("wheel0_joint", ratio, OFFSET)
        builder.add_link(
            f"wheel{index}", parent="base", joint=f"wheel{index}_joint", kind="continuous", mass=1.0,
            xyz=[0.3 * index, 0.0, 0.0], inertia=inertia * np.eye(3), mimic=mimic,
        )  # fmt: skip
    return builder.build()


OFFSET = 0.3  # rad


def two_fingers(masses: tuple[float, float, float], *, axis: Sequence[float] = (0.0, 1.0, 0.0)) -> oo.Model:
    """Return two sliding fingers; the first carries a load that the second grasps.

    ``masses``, kg, are those of the fingers and the load; the fingers slide along ``axis``.
    """
    builder = base("two_fingers")
    for index in range(2):
        builder.add_link(
            f"finger{index}", parent="base", joint=f"finger{index}_joint", kind="prismatic", axis=axis,
            mass=masses[index], inertia=0.01 * np.eye(3),
        )  # fmt: skip
    builder.add_link(
        "load", parent="finger0", joint="grip", kind="fixed", mass=masses[2], inertia=0.02 * np.eye(3)
    )
    builder.close(oo.Loop("grasp", "weld", "load", "finger1"))
    return builder.build()
