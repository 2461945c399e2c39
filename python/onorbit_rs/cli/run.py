"""Implements ``onorbit run`` and ``onorbit resume``, which simulate a scenario."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from onorbit_rs.cli.exit_codes import fail, ignore_closed_pipe
from onorbit_rs.cli.options import (
    CheckpointOption,
    CommandsOption,
    CompressOption,
    DurationOption,
    FiguresOption,
    FolderArgument,
    ForceOption,
    JsonOption,
    OutOption,
    QuietOption,
    RecordingOption,
    ScenarioArgument,
    SetOption,
    ViewOption,
    check_is_scenario,
    scenario_changes,
)
from onorbit_rs.exceptions import InputError

if TYPE_CHECKING:
    from collections.abc import Callable

    from onorbit_rs.simulation.run import Run


def run(
    scenario: ScenarioArgument,
    out: OutOption = None,
    force: ForceOption = False,
    quiet: QuietOption = False,
    as_json: JsonOption = False,
    view: ViewOption = False,
    checkpoint_every: CheckpointOption = None,
    commands: CommandsOption = None,
    figures: FiguresOption = True,
    recording: RecordingOption = True,
    compress: CompressOption = False,
    assignments: SetOption = None,
    duration: DurationOption = None,
) -> None:
    """Run a scenario and certify its momentum and energy.

    The exit code is 1 if the certificate fails, 2 for errors, 130 after Ctrl-C, 143 after SIGTERM, and 129
    after SIGHUP.
    """
    from onorbit_rs.simulation.live import CHECKPOINT_EVERY
    from onorbit_rs.simulation.run import run as run_scenario

    if checkpoint_every is not None and out is None:
        raise InputError(
            f"--checkpoint-every {checkpoint_every:g} requires a folder for checkpoints; add --out DIR",
            name="checkpoint_every", got=checkpoint_every,
        )  # fmt: skip
    check_is_scenario(scenario)
    changes = scenario_changes(assignments, duration)
    every = CHECKPOINT_EVERY if checkpoint_every is None else checkpoint_every
    report_run(
        lambda: run_scenario(
            scenario,
            out,
            force=force,
            quiet=quiet or as_json,
            view=view,
            checkpoint_every=every,
            commands=commands,
            figures=figures,
            recording=recording,
            compress=compress,
            changes=changes,
        ),
        quiet=quiet,
        as_json=as_json,
    )


def resume(
    folder: FolderArgument,
    quiet: QuietOption = False,
    as_json: JsonOption = False,
    view: ViewOption = False,
    checkpoint_every: CheckpointOption = None,
    figures: FiguresOption = True,
    recording: RecordingOption = True,
    compress: CompressOption = False,
) -> None:
    """Resume an interrupted run, with bit-identical results.

    The run continues from the last checkpoint in DIR. Exit codes are those of onorbit run.
    """
    from onorbit_rs.simulation.live import CHECKPOINT_EVERY
    from onorbit_rs.simulation.run import resume as resume_run

    every = CHECKPOINT_EVERY if checkpoint_every is None else checkpoint_every
    report_run(
        lambda: resume_run(
            folder,
            quiet=quiet or as_json,
            view=view,
            checkpoint_every=every,
            figures=figures,
            recording=recording,
            compress=compress,
        ),
        quiet=quiet,
        as_json=as_json,
    )


def report_run(job: Callable[[], Run], *, quiet: bool, as_json: bool) -> None:
    """Run the simulation and print its summary; exit with code 1 if the certificate failed."""
    from onorbit_rs.cli.console import print_json
    from onorbit_rs.cli.summary import print_summary

    result = job()
    with ignore_closed_pipe():
        if as_json:
            print_json(result.summary)
        elif not quiet:
            print_summary(result.summary, result.out)
    if not result.summary["certificate_passed"]:
        fail(_failed_certificate(result.summary), 1)


def _failed_certificate(summary: dict[str, Any]) -> str:
    """Return the message about a run whose certificate failed, with advice."""
    from onorbit_rs.output.checks import advice

    what = f"the certificate failed ({summary['certificate_failures']})"
    return f"{what}: {fix}" if (fix := advice(summary)) else what
