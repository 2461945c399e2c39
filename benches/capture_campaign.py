"""Runs a campaign of captures and measures its cost per step.

Run it with ``make capture-campaign CASES=10000``. In each case a servicer with seven joints (nv = 13), which
a controller at 100 Hz holds, meets a satellite (nv = 6) that approaches and tumbles at speeds that depend on
the number of the case alone. A pad at the tool touches the satellite, and a latch connects both. A case lasts
30 s in steps of 1 ms, without rows. Drawn cases are then run again on their own; their final states must have
the same bits. The limit is 8 us of processor time per step.
"""

from __future__ import annotations

import argparse
import os
import time
from collections.abc import Callable

import numpy as np

import onorbit_rs as oo
from onorbit_rs.common.rotations import quaternion_from_matrix

DURATION, STEP = 30.0, 1e-3  # s
STEPS = round(DURATION / STEP)
LIMIT_US = 8.0  # processor time per step
REPEATED = 5  # number of cases that are run again
SEED = 20261127

PAD_RADIUS = 0.08  # m
LATCH = 1e-3  # compression of the pad at which the latch closes, m
GAP = 0.05  # initial distance between the pad and the handle, m
JOINTS = [0.0, 1.4260, 0.0, 1.3391, 0.0, -1.1943, 0.0]  # rad


def models() -> tuple[oo.Model, oo.Model]:
    """Return the servicer with a spherical pad at its tool, and the satellite with a plate at its handle."""
    servicer = oo.robots.load("servicer")
    q = servicer.neutral()
    gripper = np.linalg.inv(servicer.frame_pose(q, "gripper")) @ servicer.frame_pose(q, "tool")
    target = oo.robots.load("target_satellite")
    handle = target.frame_pose(target.neutral(), "handle")
    plate = handle.copy()
    plate[:3, 3] += handle[:3, 2] * 0.01  # the surface of the plate contains the origin of the handle
    return (
        servicer.with_collision("gripper", oo.Shape.sphere(PAD_RADIUS), pose=gripper),
        target.with_collision("bus", oo.Shape.box(0.2, 0.2, 0.02), pose=plate),
    )


def captures(servicer: oo.Model, target: oo.Model) -> Callable[[int], oo.Simulation]:
    """Return the function that creates the simulation of a case from its number."""
    q = servicer.neutral()
    q[7:] = JOINTS
    tool = servicer.frame_pose(q, "tool")
    handle = target.frame_pose(target.neutral(), "handle")
    start = tool.copy()
    start[:3, 3] += tool[:3, 2] * (PAD_RADIUS + GAP)
    base = start @ np.linalg.inv(handle)

    def simulation(case: int) -> oo.Simulation:
        draw = np.random.default_rng((SEED, case))
        turn = draw.normal(0.0, 2e-3, 3)  # rad/s
        speed = -tool[:3, 2] * draw.uniform(0.01, 0.02) + draw.normal(0.0, 5e-4, 3)  # m/s, axes of W
        arm = start[:3, 3] - base[:3, 3]
        velocity = np.r_[base[:3, :3].T @ (speed - np.cross(turn, arm)), base[:3, :3].T @ turn]
        systems = [
            oo.System(
                "servicer", servicer, q, np.zeros(servicer.nv),
                controller=oo.JointComputedTorque(kp=1.0, kd=2.0),
                reference=oo.JointHold(JOINTS), control_period=0.01,
            ),
            oo.System("target", target, np.r_[base[:3, 3], quaternion_from_matrix(base[:3, :3])], velocity),
        ]  # fmt: skip
        pad = oo.Contact(
            "servicer/gripper",
            "target/bus",
            normal=oo.HuntCrossley(1e5, restitution=0.3, speed=0.02),
            friction=oo.Friction(0.4, 0.3),
            name="pad",
        )
        latch = oo.Capture("latch", "servicer/tool", "target/handle", within=(PAD_RADIUS - LATCH, 0.2))
        world = oo.World(systems, contacts=[pad], events=[latch])
        return oo.Simulation(world, time_step=STEP, record_every=STEPS)

    return simulation


def main() -> None:
    """Print the cost of a step, the number of captures and whether repeated cases have the same bits."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--cases", type=int, default=200)
    parser.add_argument("--threads", type=int, default=os.cpu_count())
    arguments = parser.parse_args()
    simulation = captures(*models())
    repeated = sorted(
        np.random.default_rng(SEED).choice(arguments.cases, min(REPEATED, arguments.cases), False)
    )
    ends: dict[int, bytes] = {}
    captured, touched = 0, 0
    wall, cpu = time.perf_counter(), time.process_time()
    sources = [lambda case=case: simulation(case) for case in range(arguments.cases)]
    for case, trace in enumerate(oo.run_batch(sources, DURATION, threads=arguments.threads)):
        kinds = [event.kind for event in trace.events]
        captured += "capture" in kinds
        touched += "touch_down" in kinds
        if case in repeated:
            ends[case] = end_of(trace)
    wall, cpu = time.perf_counter() - wall, time.process_time() - cpu
    for case in repeated:
        if end_of(simulation(int(case)).run(DURATION)) != ends[case]:
            raise SystemExit(f"case {case} has other bits when it is repeated alone")
    threads, per_case = arguments.threads, cpu / arguments.cases
    minutes = per_case * 1e4 / 120
    print(f"{arguments.cases} cases: {touched} touched, {captured} captured, {wall:.0f} s, {threads} threads")
    print(f"{per_case / STEPS * 1e6:.2f} us of processor time per step; the limit is {LIMIT_US:.0f} us")
    print(f"10 000 cases take {minutes:.0f} min on two idle cores")
    print(f"cases {', '.join(map(str, repeated))} repeated alone: the same bits")


def end_of(trace: oo.WorldTrace) -> bytes:
    """Return the bits of the final state of both systems."""
    return b"".join(
        trace[name].q[-1].tobytes() + trace[name].v[-1].tobytes() for name in ("servicer", "target")
    )


if __name__ == "__main__":
    main()
