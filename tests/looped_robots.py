"""Robots with closed loops for tests."""

from __future__ import annotations

from typing import Any

import numpy as np

import onorbit_rs as oo

LENGTHS = 0.2, 0.5, 0.4, 0.5
"""Lengths of the left crank, the coupler and the right crank, and the distance of the pivots, m."""


def at_x(x: float) -> Any:
    """Return the pose (4, 4) of a frame that is shifted by ``x``, m, along x."""
    pose = np.eye(4)
    pose[0, 3] = x
    return pose


def rod(mass: float, length: float) -> dict[str, Any]:
    """Return the mass properties of a uniform rod along x; ``mass`` in kg, ``length`` in m."""
    inertia = np.diag([0.01, 1.0, 1.0]) * mass * length**2 / 12.0
    return {"mass": mass, "com": [length / 2.0, 0.0, 0.0], "inertia": inertia}


def linkage() -> oo.ModelBuilder:
    """Return a four-bar linkage on a free base whose loop is open: a tree with three joints about z."""
    left, coupler, right, apart = LENGTHS
    builder = oo.ModelBuilder("linkage", base="base", mass=4.0, inertia=np.diag([0.3, 0.4, 0.5]))
    builder.add_link("left_crank", parent="base", joint="left", xyz=[0.1, 0.2, 0.0], **rod(0.5, left))
    builder.add_link("coupler", parent="left_crank", joint="knee", xyz=[left, 0.0, 0.0], **rod(0.8, coupler))
    builder.add_link(
        "right_crank", parent="base", joint="right", xyz=[0.1 + apart, 0.2, 0.0], **rod(0.6, right)
    )
    return builder


def closing(name: str = "closing", kind: Any = "revolute", *, project: bool = False) -> oo.Loop:
    """Return the joint between the tips of the coupler and of the right crank."""
    _, coupler, right, _ = LENGTHS
    return oo.Loop(
        name, kind, "coupler", "right_crank", pose_a=at_x(coupler), pose_b=at_x(right), project=project
    )


def start(model: oo.Model) -> Any:
    """Return a configuration near a closed one: values for the joints left, knee and right, then zeros."""
    q = model.neutral()
    q[7:10] = [1.0, 0.1, 1.4]
    return q
