"""Defines the application ``onorbit``, its commands, and its entry point."""

from __future__ import annotations

import sys
import warnings
from contextlib import contextmanager
from typing import TYPE_CHECKING, Annotated

import typer

from onorbit_rs.cli.campaign import campaign
from onorbit_rs.cli.check import check
from onorbit_rs.cli.compare import compare
from onorbit_rs.cli.convert import convert
from onorbit_rs.cli.copy import copy
from onorbit_rs.cli.exit_codes import controller_error, discard_stdout, exit_stopped, fail, with_exit_codes
from onorbit_rs.cli.export import export
from onorbit_rs.cli.info import info
from onorbit_rs.cli.list import list_
from onorbit_rs.cli.new import new
from onorbit_rs.cli.report import report
from onorbit_rs.cli.ros2 import ros2
from onorbit_rs.cli.run import resume, run
from onorbit_rs.cli.show import show
from onorbit_rs.cli.signals import ending_signals
from onorbit_rs.cli.text_output import (
    escape_unencodable,
    print_error,
    print_failure,
    print_text,
    show_warning,
)
from onorbit_rs.cli.validate import validate
from onorbit_rs.common import user_code
from onorbit_rs.common.printable import printable
from onorbit_rs.exceptions import OnOrbitError, ScenarioError

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator

app = typer.Typer(
    name="onorbit",
    help="Simulate free-floating robots in orbit.",
    pretty_exceptions_enable=False,
    rich_markup_mode=None,  # boxes take half a second to load and wrap names on a narrow terminal
)

# in the order of the help; a command imports its modules when it is called
COMMANDS: dict[str, Callable[..., None]] = {
    "run": run,
    "resume": resume,
    "campaign": campaign,
    "ros2": ros2,
    "list": list_,
    "check": check,
    "show": show,
    "info": info,
    "convert": convert,
    "new": new,
    "copy": copy,
    "report": report,
    "export": export,
    "compare": compare,
    "validate": validate,
}
for name, command in COMMANDS.items():
    app.command(name=name)(with_exit_codes(command))


def _print_version(is_asked: bool) -> None:
    if is_asked:
        from onorbit_rs import __version__

        print_text(f"onorbit {__version__}")
        raise typer.Exit


VersionOption = Annotated[
    bool, typer.Option("--version", callback=_print_version, is_eager=True, help="Print the version.")
]


@app.callback(invoke_without_command=True)
def onorbit(context: typer.Context, version: VersionOption = False) -> None:
    """Simulate free-floating robots in orbit."""
    if context.invoked_subcommand is None:
        print_text(context.get_help())
        raise typer.Exit(2)


def main(arguments: list[str] | None = None) -> None:
    """Run a command and exit.

    Errors are printed and give exit code 2. Ctrl-C gives 130, SIGTERM 143 and SIGHUP 129.
    """
    escape_unencodable()
    try:
        with ending_signals(), warnings.catch_warnings(), _announcing_user_code():
            warnings.showwarning = show_warning
            code = app(arguments, standalone_mode=False, prog_name="onorbit")
            if sys.stdout is not None:
                sys.stdout.flush()
    except OnOrbitError as error:
        *others, last = error.errors or (error,) if isinstance(error, ScenarioError) else (error,)
        for other in others:
            print_failure(str(other))
        fail(str(last), 2)
    except (KeyboardInterrupt, typer.Abort) as stop:
        cause = stop if isinstance(stop, KeyboardInterrupt) else stop.__context__
        exit_stopped(cause if isinstance(cause, KeyboardInterrupt) else KeyboardInterrupt())
    except typer.TyperException as error:
        fail(_with_suggestion(error), 2)
    except BrokenPipeError:
        discard_stdout()
        sys.exit(0)
    except OSError as error:
        if error.filename is not None:  # the error concerns a file
            fail(f"cannot use {error.filename}: {error.strerror or error}", 2)
        discard_stdout()  # the error concerns stdout, for example a full disk
        fail(f"cannot write the output: {error.strerror or error}", 2)
    except Exception as error:
        if not hasattr(error, "trace"):
            raise
        fail(controller_error(error), 2)
    sys.exit(code if isinstance(code, int) else 0)


@contextmanager
def _announcing_user_code() -> Iterator[None]:
    """Print the name of each Python file or module of a scenario once, before it is executed in the block."""
    announced: set[str] = set()

    def announce(source: str) -> None:
        if source not in announced:
            announced.add(source)
            print_error(f"onorbit: executing Python code of this scenario: {printable(source)}")

    user_code.listeners.append(announce)
    try:
        yield
    finally:
        user_code.listeners.remove(announce)


def _with_suggestion(error: typer.TyperException) -> str:
    """Return the message of a usage error, followed by the list of commands or the help command."""
    message = error.format_message()
    if message.startswith("No such command"):
        return f"{message} Commands are: {', '.join(COMMANDS)}"
    context = getattr(error, "ctx", None)
    return message if context is None else f"{message.rstrip('.')}; see: {context.command_path} --help"
