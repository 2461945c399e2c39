"""Implements ``onorbit ros2``, which runs a scenario as a live ROS 2 node."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from onorbit_rs.cli.options import JsonOption, QuietOption, ScenarioArgument
from onorbit_rs.cli.output_files import check_bag_file, check_output_file
from onorbit_rs.common.printable import printable

if TYPE_CHECKING:
    from onorbit_rs.ros2.node import Node

PaceOption = Annotated[
    str, typer.Option(metavar="PACE", help="real_time, fast, or stepped by messages on /step.")
]
DomainOption = Annotated[
    int | None, typer.Option(metavar="N", help="DDS domain, 0 to 232; default: ROS_DOMAIN_ID, or else 0.")
]
ForOption = Annotated[
    float | None,
    typer.Option("--for", metavar="SECONDS", help="Simulated time, s; default: as in the scenario."),
]
NetworkOption = Annotated[
    str,
    typer.Option(
        metavar="NETWORK",
        help="Networks on which the node is reachable: loopback (this machine only) or all.",
    ),
]
RecordOption = Annotated[
    Path | None, typer.Option(metavar="FILE", help="Record messages and applied commands in an MCAP file.")
]
RecordForceOption = Annotated[
    bool, typer.Option("--force", help="Replace existing files of --record and --log.")
]
PausedOption = Annotated[
    bool, typer.Option("--paused", help="Start paused; a message false on /pause starts the run.")
]
WrenchTimeoutOption = Annotated[
    float | None,
    typer.Option(
        metavar="SECONDS",
        help="Simulated time without a message after which a wrench ends, s; default: never.",
    ),
]
KeepRowsOption = Annotated[
    int | None, typer.Option(metavar="N", help="Keep only the first row and at least the last N in memory.")
]
PriorityOption = Annotated[
    bool,
    typer.Option("--priority", help="Use real-time priority; requires pace real_time, Linux and permission."),
]
LogOption = Annotated[
    Path | None,
    typer.Option(metavar="FILE", help="Write the received commands, for replay with onorbit run --commands."),
]


def ros2(
    scenario: ScenarioArgument,
    pace: PaceOption = "real_time",
    domain: DomainOption = None,
    for_: ForOption = None,
    network: NetworkOption = "loopback",
    paused: PausedOption = False,
    log: LogOption = None,
    record: RecordOption = None,
    wrench_timeout: WrenchTimeoutOption = None,
    keep_rows: KeepRowsOption = None,
    priority: PriorityOption = False,
    force: RecordForceOption = False,
    quiet: QuietOption = False,
    as_json: JsonOption = False,
) -> None:
    """Run a scenario as a live ROS 2 node.

    The node requires pip install 'onorbit-rs[ros2]', but no installation of ROS 2. Ctrl-C ends the run. The
    exit code is 1 if the certificate fails.
    """
    from onorbit_rs.cli.console import print_json
    from onorbit_rs.cli.exit_codes import fail
    from onorbit_rs.cli.text_output import print_error, print_text
    from onorbit_rs.ros2 import Node
    from onorbit_rs.ros2.node import check_duration

    def tell(text: str) -> None:
        if not quiet:
            print_error(text)

    check_duration(for_)  # before files are opened
    check_bag_file("--record", record, ".mcap", force=force)
    check_output_file(log, force=force)
    node = Node.of_scenario(
        scenario, pace=pace, domain=domain, network=network, is_paused=paused, log=log, record=record,
        wrench_timeout=wrench_timeout, keep_rows=keep_rows, has_priority=priority, on_message=tell,
    )  # fmt: skip
    try:
        if not quiet:
            print_error(_greeting(node))
        trace = node.spin(node.duration if for_ is None else for_)
    finally:
        node.close()
    report: dict[str, Any] = {
        "certificate_passed": all(passed for _, _, _, passed in trace.certificate()),
        "commands": len(node.commands), "jitter": node.jitter, "recording": record and str(record),
    }  # fmt: skip
    if as_json:
        print_json(report)
    elif not quiet:
        print_text(_closing(report))
    if not report["certificate_passed"]:
        failed = ", ".join(name for name, _, _, passed in trace.certificate() if not passed)
        fix = "try a shorter time_step, or a smaller tolerance with integrator: dormand_prince"
        fail(f"the certificate failed ({failed}); {fix}", 1)


def _greeting(node: Node) -> str:
    """Return the text that lists the topics of a node."""
    rows = [f"  {name:<32} {kind}" for name, kind in node.published]
    taken = [f"  {name:<32} {kind}" for name, kind in node.subscribed]
    return "\n".join([f"ROS 2 domain {node.domain}, publishing:", *rows, "listening:", *taken])


def _closing(report: dict[str, Any]) -> str:
    """Return the report of a run that has ended."""
    lines = [
        f"certificate: {'passed' if report['certificate_passed'] else 'failed'}",
        f"commands: {report['commands']}",
    ]
    if report["recording"]:
        lines.append(f"recording: {printable(report['recording'])}")
    if jitter := report["jitter"]:
        lines.append(
            f"real time: late by {1e3 * jitter['late_median_s']:.2f} ms (median), "
            f"{1e3 * jitter['late_99_s']:.2f} ms (99 %), {1e3 * jitter['late_max_s']:.2f} ms (largest); "
            f"{100 * jitter['missed']:.2f} % of {jitter['ticks']} ticks missed"
        )
        if jitter["slipped_s"] > 0.0:
            lines.append(f"the run was {jitter['slipped_s']:.2f} s slower than real time")
    return "\n".join(lines)
