"""The command ``onorbit``: run, resume, list, check, show, info, convert."""

from __future__ import annotations

import os
import sys
import traceback
import warnings
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any, NoReturn

import typer

from onorbit_rs.exceptions import OnOrbitError, RunInterrupted

if TYPE_CHECKING:
    from collections.abc import Callable

    from onorbit_rs.running import Run

app = typer.Typer(
    name="onorbit",
    help="Simulate free-floating robots in orbit.",
    no_args_is_help=True,
    add_completion=False,
    pretty_exceptions_enable=False,
)


def _print_version(is_asked: bool) -> None:
    if is_asked:
        from onorbit_rs import __version__

        typer.echo(f"onorbit {__version__}")
        raise typer.Exit


ScenarioArgument = Annotated[
    str, typer.Argument(metavar="NAME_OR_FILE", help="A bundled name or a YAML file.")
]
VersionOption = Annotated[
    bool, typer.Option("--version", callback=_print_version, is_eager=True, help="Print the version.")
]
FolderArgument = Annotated[Path, typer.Argument(metavar="DIR", help="A folder that a run has written.")]
OutOption = Annotated[Path | None, typer.Option("--out", "-o", metavar="DIR", help="Write results here.")]
ForceOption = Annotated[bool, typer.Option("--force", help="Replace the run that is in DIR.")]
QuietOption = Annotated[bool, typer.Option("--quiet", "-q", help="No progress bar, no summary.")]
ViewOption = Annotated[bool, typer.Option("--view", help="Watch it in the viewer while it runs.")]
CheckpointOption = Annotated[
    float, typer.Option(metavar="SECONDS", help="Wall-clock time between checkpoints in DIR.")
]

PackagesOption = Annotated[
    list[Path] | None,
    typer.Option("--package-path", metavar="DIR", help="Where ROS packages are; may be repeated."),
]
ArgumentsOption = Annotated[
    list[str] | None, typer.Option("--arg", metavar="NAME=VALUE", help="For a xacro; may be repeated.")
]


@app.callback()
def onorbit(version: VersionOption = False) -> None:
    """Simulate free-floating robots in orbit."""


@app.command()
def run(
    scenario: ScenarioArgument,
    out: OutOption = None,
    force: ForceOption = False,
    quiet: QuietOption = False,
    view: ViewOption = False,
    checkpoint_every: CheckpointOption = 30.0,
) -> None:
    """Run a scenario and certify its momentum and energy."""
    from onorbit_rs.running import run as run_scenario

    _report(
        lambda: run_scenario(
            scenario, out, force=force, quiet=quiet, view=view, checkpoint_every=checkpoint_every
        ),
        quiet=quiet,
    )


@app.command()
def resume(
    folder: FolderArgument, quiet: QuietOption = False, checkpoint_every: CheckpointOption = 30.0
) -> None:
    """Go on with a run that was killed or interrupted, to the same bits."""
    from onorbit_rs.running import resume as resume_run

    _report(lambda: resume_run(folder, quiet=quiet, checkpoint_every=checkpoint_every), quiet=quiet)


def _report(job: Callable[[], Run], *, quiet: bool) -> None:
    """Do it and print the summary."""
    from onorbit_rs import report

    try:
        result = job()
    except RunInterrupted as stop:  # caught here: typer would swallow a KeyboardInterrupt and its message
        _fail(str(stop), 130)
    except KeyboardInterrupt:  # the simulation was over
        _fail("stopped by Ctrl-C while the results were written; run it again with --force", 130)
    if not quiet:
        report.print_summary(result.summary, result.out)


@app.command(name="list")
def list_() -> None:
    """List the bundled scenarios and robots."""
    from onorbit_rs import report

    report.print_bundled()


@app.command()
def check(scenario: ScenarioArgument) -> None:
    """Check a scenario and everything it names, without running it."""
    from onorbit_rs import report
    from onorbit_rs.scenario import load
    from onorbit_rs.scenario.build import build

    report.print_checked(build(load(scenario)))


@app.command()
def show(
    folder: FolderArgument,
    viewer: Annotated[bool, typer.Option(help="Open the recording where there is a screen.")] = True,
    picture: Annotated[Path | None, typer.Option(metavar="FILE", help="Save a PNG of the viewer.")] = None,
    at: Annotated[float, typer.Option(metavar="SECONDS", help="Moment of the picture.")] = 0.0,
) -> None:
    """Print the summary of a run and open its recording, or save a picture of it."""
    from onorbit_rs import report

    summary = report.print_run(folder)
    if picture is not None:
        report.save_picture(folder, picture, at, float(summary.get("simulated_s") or 0.0))
    elif viewer:
        report.open_viewer(folder)


@app.command()
def info(
    robot: Annotated[str, typer.Argument(metavar="ROBOT", help="A bundled name, a URDF or a xacro file.")],
    packages: PackagesOption = None,
    arguments: ArgumentsOption = None,
    as_json: Annotated[bool, typer.Option("--json", help="As data, for programs.")] = False,
) -> None:
    """Print a robot's tree, masses, joints, frames and what was odd."""
    import json

    from onorbit_rs import robots
    from onorbit_rs.robots.describe import describe, print_info

    with warnings.catch_warnings():
        warnings.simplefilter("ignore")  # they are printed with the rest
        model = robots.load(robot, package_paths=packages, xacro_arguments=_as_mapping(arguments))
    if as_json:
        typer.echo(json.dumps(describe(model), indent=1))
    else:
        print_info(model)


@app.command()
def convert(
    files: Annotated[
        list[Path], typer.Argument(metavar="FILE...", help="YAML files of OnOrbitROS, and the robot's URDF.")
    ],
    out: Annotated[Path | None, typer.Option("--out", "-o", metavar="FILE", help="Write it here.")] = None,
    controller: Annotated[
        str | None, typer.Option(metavar="NAME", help="Which of several controllers.")
    ] = None,
    keep_going: Annotated[bool, typer.Option("--keep-going", help="Pass over unknown keys.")] = False,
    force: Annotated[bool, typer.Option("--force", help="Replace the file that is there.")] = False,
) -> None:
    """Make a scenario of OnOrbitROS' YAML files, and say what became of every line."""
    from onorbit_rs import report

    report.print_converted(files, out, controller=controller, keep_going=keep_going, force=force)


def _as_mapping(arguments: list[str] | None) -> dict[str, str] | None:
    """``name=value`` or, as xacro writes it, ``name:=value``."""
    pairs = [argument.replace(":=", "=", 1).partition("=") for argument in arguments or []]
    for name, equals, _ in pairs:
        if not equals or not name:
            raise typer.BadParameter(f"write an argument of a xacro as name=value, not {name!r}")
    return {name: value for name, _, value in pairs} or None


def main(arguments: list[str] | None = None) -> None:
    """Entry point: an error is one line on stderr and exit code 2, Ctrl-C is 130."""
    try:
        with warnings.catch_warnings():
            warnings.showwarning = _show_warning
            code = app(arguments, standalone_mode=False)
            sys.stdout.flush()
    except OnOrbitError as error:
        _fail(str(error), 2)
    except (KeyboardInterrupt, typer.Abort):
        _fail("stopped by Ctrl-C", 130)
    except typer.TyperException as error:
        _fail(_with_commands(error.format_message()), 2)
    except BrokenPipeError:
        _leave_stdout()
        sys.exit(0)
    except OSError as error:  # printing: the disk behind stdout is full
        _leave_stdout()
        _fail(f"cannot write: {error.strerror or error}", 2)
    except Exception as error:
        if not hasattr(error, "trace"):
            raise
        _fail(_of_controller(error), 2)
    sys.exit(code if isinstance(code, int) else 0)


def _of_controller(error: Exception) -> str:
    """What a controller of the user's raised, and where."""
    frames = traceback.extract_tb(error.__traceback__)
    where = f" ({frames[-1].filename}:{frames[-1].lineno})" if frames else ""
    notes = "".join(f"; {note}" for note in getattr(error, "__notes__", ()))
    return f"the controller raised {type(error).__name__}{where}: {error}{notes}"


def _with_commands(message: str) -> str:
    """An unknown command is answered with those there are."""
    names = [command.name or getattr(command.callback, "__name__", "") for command in app.registered_commands]
    return f"{message} Commands are: {', '.join(names)}" if message.startswith("No such command") else message


def _show_warning(message: Warning | str, *_: Any, **__: Any) -> None:
    """One line, without the place in our code."""
    typer.echo(f"onorbit: warning: {' '.join(str(message).split())}", err=True)


def _leave_stdout() -> None:
    """Nothing more goes to a stdout that is closed or full, not even when Python exits."""
    os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())


def _fail(message: str, code: int) -> NoReturn:
    if message:
        typer.echo(f"onorbit: {' '.join(message.split())}", err=True)
    sys.exit(code)


if __name__ == "__main__":
    main()
