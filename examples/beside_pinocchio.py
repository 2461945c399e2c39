"""Dynamics of a URDF here and in Pinocchio: the same numbers, and the time that each takes.

Needs: pip install pin

Run: python examples/beside_pinocchio.py [ROBOT.urdf]
"""

from __future__ import annotations

import sys
import time
from collections.abc import Callable

import numpy as np
import pinocchio as pin

import onorbit_rs as oo


def microseconds(call: Callable[[], object], repeats: int = 2000) -> float:
    """One call, the best of five rounds."""
    rounds = []
    for _ in range(5):
        began = time.perf_counter()
        for _ in range(repeats // 5):
            call()
        rounds.append((time.perf_counter() - began) / (repeats // 5))
    return 1e6 * min(rounds)


def main(urdf: str = str(oo.robots.path("humanoid_torso"))) -> None:
    model = oo.Model.from_urdf(urdf)
    theirs = pin.buildModelFromUrdf(urdf, pin.JointModelFreeFlyer())
    theirs.gravity.setZero()  # dynamics here are those in free fall
    data = theirs.createData()

    rng = np.random.default_rng(1)
    q = model.integrate(model.neutral(), rng.uniform(-1, 1, model.nv))
    v = rng.uniform(-1, 1, model.nv)
    q_pin, v_pin = oo.layouts.to_pinocchio(model, q, v, theirs)  # joints in their order
    tau_pin = np.zeros(theirs.nv)
    tau = np.zeros(model.nv)

    ours = model.forward_dynamics(q, v, tau)
    a_pin = pin.aba(theirs, data, q_pin, v_pin, tau_pin)
    _, ours = oo.layouts.to_pinocchio(model, q, ours, theirs)  # in their order; laid out as a velocity
    print(f"accelerations differ by {abs(ours - a_pin).max() / abs(a_pin).max():.1e} of the largest")

    here = microseconds(lambda: model.forward_dynamics(q, v, tau))
    there = microseconds(lambda: pin.aba(theirs, data, q_pin, v_pin, tau_pin))
    print(f"one state, from Python: {here:.1f} µs here, {there:.1f} µs there")
    many_q, many_v, many_tau = (np.tile(x, (4096, 1)) for x in (q, v, tau))
    out = np.empty_like(many_v)
    batch = microseconds(lambda: model.forward_dynamics(many_q, many_v, many_tau, out=out), 50) / len(many_q)
    print(f"a state in a batch of {len(many_q)}: {batch:.2f} µs")


if __name__ == "__main__":
    main(*sys.argv[1:])
