"""Tests drift, momentum and energy of closed loops over long runs, and the order of convergence."""

from __future__ import annotations

from typing import Any

import numpy as np

import onorbit_rs as oo
from onorbit_rs.common.coordinates import BASE_V, JOINTS_Q, JOINTS_V
from onorbit_rs.tools.validation.case import Case, Gate
from onorbit_rs.tools.validation.linkages import Linkage, at, four_bar_linkage
from onorbit_rs.tools.validation.trees import Array

DURATION = 100.0  # s
JOINTS = ((0, 0, 1), (0, 1, 0), (1, 0, 0), (0, 1, 0), (1, 0, 0), (0, 1, 0))
"""Axes of the joints of one arm."""


def simulate(model: oo.Model, q: Array, v: Array, duration: float) -> oo.Trace:
    """Return the trace of free motion with steps of 1 ms."""
    return oo.Simulation(model, q, v, time_step=1e-3, record_every=50).run(duration)


def two_arms() -> tuple[oo.Model, Array, Array]:
    """Return a craft with two arms of six joints, which hold a load, and its initial `q` and `v`.

    The load is a link of the first arm; a weld connects it with the second.
    """
    builder = oo.ModelBuilder("two_arms", base="base", mass=200.0, inertia=np.diag([30.0, 40.0, 50.0]))
    for side, y in (("left", 0.3), ("right", -0.3)):
        parent, xyz = "base", [0.5, y, 0.0]
        for i, axis in enumerate(JOINTS):
            builder.add_link(
                f"{side}{i}", parent=parent, joint=f"{side}{i}_joint", axis=axis, xyz=xyz, mass=3.0,
                com=[0.15, 0.0, 0.0], inertia=np.diag([0.01, 0.04, 0.04]),
            )  # fmt: skip
            parent, xyz = f"{side}{i}", [0.3, 0.0, 0.0]
    builder.add_link(
        "load", parent="left5", joint="grasp", kind="fixed", xyz=[0.1, -0.3, 0.0], mass=20.0,
        inertia=np.diag([1.0, 0.8, 0.9]),
    )  # fmt: skip
    weld = oo.Loop("second_grasp", "weld", "load", "right5", pose_a=at(-0.1) @ shifted(-0.3), project=True)
    builder.close(weld)
    model = builder.build()
    q = model.neutral()
    q[JOINTS_Q] = [0.3, 0.5, 0.1, -1.1, 0.2, 0.6, -0.3, 0.5, -0.1, -1.1, -0.2, 0.6]
    v = 0.05 * np.sin(np.arange(1.0, model.nv + 1.0))
    v[JOINTS_V] *= 3.0
    q = np.asarray(model.closed_configuration(q))
    return model, q, np.asarray(model.closed_velocity(q, v))


def shifted(y: float) -> Array:
    """Return the pose of a frame shifted along y, m."""
    pose = np.eye(4)
    pose[1, 3] = y
    return pose


def drift() -> tuple[float, float, float, float, float]:
    """Return the opening of the loop, m and rad, and the drifts of both momenta and of the energy.

    The opening is that of frames placed by forward kinematics. Drifts are relative to the largest magnitude.
    """
    model, q, v = two_arms()
    trace = simulate(model, q, v, DURATION)
    (loop,) = model.loops
    first = model.frame_pose(trace.q, loop.frame_a) @ np.array(loop.pose_a)
    second = model.frame_pose(trace.q, loop.frame_b) @ np.array(loop.pose_b)
    turned = np.swapaxes(first[:, :3, :3], 1, 2) @ second[:, :3, :3]
    skew = (turned - np.swapaxes(turned, 1, 2))[:, [2, 0, 1], [1, 2, 0]] / 2.0
    h = np.array([momentum(model, q, v) for q, v in zip(trace.q[::20], trace.v[::20], strict=True)])
    sizes = np.linalg.norm(h.reshape(-1, 2, 3), axis=2).max(axis=0)
    drifts = np.linalg.norm((h - h[0]).reshape(-1, 2, 3), axis=2).max(axis=0) / sizes
    energy = trace.kinetic_energy
    return (
        float(np.linalg.norm(first[:, :3, 3] - second[:, :3, 3], axis=1).max()),
        float(np.linalg.norm(skew, axis=1).max()),
        *(float(x) for x in drifts),
        float(np.abs(energy / energy[0] - 1.0).max()),
    )  # type: ignore[return-value]


def momentum(model: oo.Model, q: Array, v: Array) -> Array:
    """Return the momentum (6,) about the origin of W, N s and N m s, summed over the links."""
    total = np.zeros(6)
    for body in model.bodies:
        pose, twist = model.frame_pose(q, body.name), model.frame_velocity(q, v, body.name)
        rot, arm = pose[:3, :3], pose[:3, :3] @ np.array(body.com)
        linear = body.mass * (twist[:3] + np.cross(twist[3:], arm))
        spin = rot @ np.array(body.inertia) @ rot.T @ twist[3:]
        total += np.concatenate([linear, np.cross(pose[:3, 3] + arm, linear) + spin])
    return total


STEPS, LASTS = (0.04, 0.02, 0.01), 4.0
INTEGRATOR, ORDER = "rk4", 4.0


def state_after(linkage: Linkage, step: float) -> tuple[Any, float]:
    """Return the final configuration of a tumbling four-bar linkage and the relative change of energy."""
    q, v = linkage.state(1.0, 2.0)
    v[BASE_V] += [0.01, -0.02, 0.03, 0.2, -0.1, 0.3]
    settings: Any = {"integrator": INTEGRATOR, "time_step": step}
    trace = oo.Simulation(linkage.model, q, v, **settings).run(LASTS)
    return trace.q[-1], abs(float(trace.kinetic_energy[-1] / trace.kinetic_energy[0]) - 1.0)


def orders() -> tuple[float, float]:
    """Return the shortfalls from four of the orders of convergence of the configuration and the energy."""
    linkage = four_bar_linkage()
    exact, _ = state_after(linkage, 1e-3)
    ends = [state_after(linkage, step) for step in STEPS]
    off = [float(np.linalg.norm(linkage.model.difference(exact, q))) for q, _ in ends]
    energies = [energy for _, energy in ends]
    found = [np.log2(np.array(errors[:-1]) / np.array(errors[1:])).min() for errors in (off, energies)]
    return tuple(max(0.0, ORDER - float(order)) for order in found)  # type: ignore[return-value]


CASES = (
    Case(
        "loops", "two arms hold a load, 100 s at 1 ms", "Newton and Euler: closed loop, no external wrench",
        (
            Gate("opening", 1e-12, "m"), Gate("opening, rotation", 1e-12, "rad"),
            Gate("linear momentum", 1e-12), Gate("angular momentum", 1e-12), Gate("kinetic energy", 1e-8),
        ), drift,
    ),
    Case(
        "loops", "a tumbling four-bar linkage, step halved twice", "order 4",
        (
            Gate("shortfall of the convergence order, configuration", 0.3),
            Gate("shortfall of the convergence order, energy", 0.3),
        ), orders,
    ),
)  # fmt: skip
