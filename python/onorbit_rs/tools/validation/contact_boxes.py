"""Tests momentum, energy and recorded forces of two boxes that tumble and collide with friction."""

from __future__ import annotations

import numpy as np

import onorbit_rs as oo
from onorbit_rs.tools.validation.case import Case, Gate
from onorbit_rs.tools.validation.contact_bodies import at, body
from onorbit_rs.tools.validation.trees import Array

SIZES = {"a": (0.4, 0.3, 0.5), "b": (0.5, 0.4, 0.3)}  # m
MASSES = {"a": 8.0, "b": 12.0}  # kg
STARTS = {
    "a": ([0.0, 0.0, 0.0], [0.1, 0.01, 0.0, 0.4, -0.3, 0.2]),
    "b": ([0.7, 0.08, 0.05], [-0.1, 0.0, 0.01, -0.2, 0.5, 0.3]),
}
"""Initial positions, m, and velocities, m/s and rad/s, of the boxes."""


def box(name: str) -> oo.Model:
    """Return the uniform box with this name; :data:`SIZES` and :data:`MASSES` define its size and mass."""
    x, y, z = SIZES[name]
    moments = MASSES[name] / 12.0 * np.array([y * y + z * z, x * x + z * z, x * x + y * y])
    return body(f'<box size="{x} {y} {z}"/>', MASSES[name], moments)


def collide() -> oo.WorldTrace:
    """Simulate two boxes that touch at edges and corners."""
    systems = [at(name, box(name), *start) for name, start in STARTS.items()]
    law = oo.HuntCrossley(1e5, restitution=0.7, speed=0.2)
    contact = oo.Contact("a/body", "b/body", normal=law, friction=oo.Friction(0.4), name="touch")
    trace = oo.Simulation(oo.World(systems, contacts=[contact]), time_step=0.01).run(3.0)
    assert isinstance(trace, oo.WorldTrace)
    if not trace.contacts["touch"].force.any():
        raise ValueError("the contact force of the boxes is zero at all times; they must touch")
    return trace


def angular(trace: oo.Trace) -> Array:
    """Return the angular momentum (T, 3) of a body about the origin of W, N m s."""
    return trace.momentum[:, 3:] + np.cross(trace.center_of_mass, trace.momentum[:, :3])


def balances() -> tuple[float, float, float]:
    """Return the errors of linear and angular momentum, relative to the impulse, and of the energy.

    The energy is relative to the elastic energy that the contact has stored.
    """
    trace = collide()
    touch = trace.contacts["touch"]
    impulse = np.trapezoid(np.linalg.norm(touch.force, axis=1), trace["a"].time)
    linear = trace["a"].momentum[:, :3] + trace["b"].momentum[:, :3]
    turning = angular(trace["a"]) + angular(trace["b"])
    energy = trace.kinetic_energy + touch.elastic + touch.dissipated
    exchanged = float(touch.elastic.max())
    return (
        float(np.abs(linear - linear[0]).max() / impulse),
        float(np.abs(turning - turning[0]).max() / impulse),
        float(np.abs(energy - energy[0]).max() / exchanged),
    )


def records() -> tuple[float, float]:
    """Return the errors of the impulse and of its moment on both boxes, from recorded forces and points.

    Both are relative to the impulse. The integrals are sums over the rows by the trapezoidal rule, with an
    error of 3e-4 at the jumps of friction.
    """
    trace = collide()
    touch, time = trace.contacts["touch"], trace["a"].time
    impulse = np.trapezoid(touch.force, time, axis=0)
    size = np.trapezoid(np.linalg.norm(touch.force, axis=1), time)
    errors = []
    for name, sign in (("a", -1.0), ("b", 1.0)):
        moment = sign * np.trapezoid(np.cross(acts_at(trace, name), touch.force), time, axis=0)
        gained = trace[name].momentum[-1, :3] - trace[name].momentum[0, :3]
        turned = angular(trace[name])
        errors.append(
            (
                np.abs(gained - sign * impulse).max() / size,
                np.abs(turned[-1] - turned[0] - moment).max() / size,
            )
        )
    linear, moments = np.max(errors, axis=0)
    return float(linear), float(moments)


def acts_at(trace: oo.WorldTrace, name: str) -> Array:
    """Return the points (T, 3) in W at which the contact acts on a box, m."""
    return trace.contacts["touch"].point


CASES = (
    Case(
        "contact", "two tumbling boxes collide", "Newton and Euler: no external wrench",
        (Gate("linear momentum", 1e-12), Gate("angular momentum", 1e-12), Gate("energy", 1e-8)), balances,
    ),
    Case(
        "contact", "recorded forces of two boxes", "Newton and Euler: impulse and its moment",
        (Gate("impulse", 1e-3), Gate("moment of the impulse", 1e-3, "m")), records,
    ),
)  # fmt: skip
