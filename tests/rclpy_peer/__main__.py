"""Unmodified rclpy beside the simulator: losses, latencies, commands, QoS and the graph, against their gates.

Run from the repository's root: python tests/rclpy_peer [--seconds 60]
"""

from __future__ import annotations

import argparse
import sys

from environment import MissingError, interpreter
from report import Report
from roles import commands, example, graph, listening, messages


def main() -> int:
    """Returns 0 if no sample was lost, the medians are below their gates, and all messages are right."""
    parser = argparse.ArgumentParser()
    parser.add_argument(
        "--seconds", type=float, default=60.0, help="duration of the measurement of joint states, s"
    )
    seconds = parser.parse_args().seconds
    try:
        python = interpreter()
    except MissingError as error:
        print(f"skipped: {error}")
        return 0
    report = Report()
    for part in (graph, messages, commands, example):
        part(python, report)
    listening(python, report, seconds)
    report.show()
    return 1 if report.has_failed else 0


if __name__ == "__main__":
    sys.exit(main())
