"""Runs a scenario from Python and plots the motion of the tool and the rotation of the base.

Run: python examples/run_and_plot.py [OUT.png]
"""

from __future__ import annotations

import sys

import matplotlib.pyplot as plt
import numpy as np

import onorbit_rs as oo


def main(file: str = "reach.png") -> None:
    run = oo.run("humanoid_reach")
    trace, summary = run.trace, run.summary
    print(f"largest position error of the tool: {1e6 * summary['tracking_position_error_max_m']:.1f} µm")
    print(f"largest joint torque: {summary['joint_torque_max_nm']:.2f} N m")
    print("certificate", "passed" if summary["certificate_passed"] else "BROKEN")

    base = 2 * np.arccos(
        np.clip(abs(trace.q[:, 6]), 0, 1)
    )  # rad relative to the start; q[6] is w of the quaternion
    figure, (above, below) = plt.subplots(2, sharex=True, layout="constrained")
    above.plot(trace.time, trace.tool_pose[:, :3, 3] - trace.tool_pose[0, :3, 3], label=["x", "y", "z"])
    above.set(ylabel="tool displacement (m)")
    above.legend()
    below.plot(trace.time, np.degrees(base))
    below.set(xlabel="time (s)", ylabel="base rotation (deg)")
    figure.savefig(file, dpi=150)
    print("written:", file)


if __name__ == "__main__":
    main(*sys.argv[1:])
