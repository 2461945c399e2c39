"""Simulates a thousand arms with perturbed initial states on all cores: how far does the base rotate?

Run: python examples/monte_carlo.py [COUNT]
"""

from __future__ import annotations

import sys
import time

import numpy as np

import onorbit_rs as oo


def main(count: int = 1000, steps: int = 1000, time_step: float = 2e-3) -> None:
    model = oo.robots.load("humanoid_torso")
    rng = np.random.default_rng(1)
    q = np.tile(model.neutral(), (count, 1))
    v = np.zeros((count, model.nv))
    nominal = np.array([0.5342, -2.341, -2.0077, -2.2249, -2.2693, -0.1342, -0.1974])
    q[:, 7:] = nominal + rng.normal(0.0, 0.02, (count, nominal.size))  # rad
    v[:, 3:6] = rng.normal(0.0, 0.01, (count, 3))  # rad/s: slow tumbling of the base

    start = q[0].copy()
    start[7:] = nominal
    pose = model.frame_pose(start, "tool")
    reach = oo.LineParabola(pose, displacement=[0.3, 0, 0], height=[0, 0, 0.2], duration=1.5)
    law = oo.ComputedTorque(model, "tool", kp=100, kd=20, null_space_damping=2)

    began = time.perf_counter()
    end, _ = oo.rollout(model, q, v, steps=steps, time_step=time_step, controller=law, reference=reach)
    took = time.perf_counter() - began

    tool = model.frame_pose(end, "tool")[:, :3, 3]
    off = np.linalg.norm(tool - (pose[:3, 3] + [0.3, 0, 0]), axis=1)
    turn = np.degrees(2 * np.arccos(np.clip(abs(end[:, 6]), 0, 1)))
    print(f"{count} arms for {steps * time_step:g} s in {took:.2f} s: {count * steps / took:.2g} steps per s")
    print(f"tool error at the goal: median {1e3 * np.median(off):.2g} mm, largest {1e3 * off.max():.2g} mm")
    print(f"rotation of the base: {turn.mean():.2f} ± {turn.std():.2f} degrees")


if __name__ == "__main__":
    main(*map(int, sys.argv[1:]))
