"""The app and its commands, and the entry point."""

from __future__ import annotations

import sys
import warnings
from contextlib import contextmanager
from typing import TYPE_CHECKING, Annotated

import typer

from onorbit_rs import foreign_code
from onorbit_rs.cli.check import check
from onorbit_rs.cli.compare import compare
from onorbit_rs.cli.convert import convert
from onorbit_rs.cli.failing import ending_well, fail, leave_stdout, of_controller
from onorbit_rs.cli.info import info
from onorbit_rs.cli.list import list_
from onorbit_rs.cli.new import new
from onorbit_rs.cli.report import report
from onorbit_rs.cli.run import resume, run
from onorbit_rs.cli.saying import complain, encode_all, say_all, show_warning
from onorbit_rs.cli.show import show
from onorbit_rs.cli.validate import validate
from onorbit_rs.exceptions import OnOrbitError
from onorbit_rs.printable import printable

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator

app = typer.Typer(
    name="onorbit",
    help="Simulate free-floating robots in orbit.",
    pretty_exceptions_enable=False,
    rich_markup_mode=None,  # boxes take half a second to load, and break names on a narrow terminal
)

# in the order of the help; a command loads what it needs when it is called
COMMANDS: dict[str, Callable[..., None]] = {
    "run": run,
    "resume": resume,
    "list": list_,
    "check": check,
    "show": show,
    "info": info,
    "convert": convert,
    "new": new,
    "report": report,
    "compare": compare,
    "validate": validate,
}
for name, command in COMMANDS.items():
    app.command(name=name)(ending_well(command))


def _print_version(is_asked: bool) -> None:
    if is_asked:
        from onorbit_rs import __version__

        say_all(f"onorbit {__version__}")
        raise typer.Exit


VersionOption = Annotated[
    bool, typer.Option("--version", callback=_print_version, is_eager=True, help="Print the version.")
]


@app.callback(invoke_without_command=True)
def onorbit(context: typer.Context, version: VersionOption = False) -> None:
    """Simulate free-floating robots in orbit."""
    if context.invoked_subcommand is None:
        say_all(context.get_help())
        raise typer.Exit(2)


def main(arguments: list[str] | None = None) -> None:
    """Entry point: an error is one line on stderr and exit code 2, Ctrl-C is 130."""
    encode_all()
    try:
        with warnings.catch_warnings(), _executed_code_named():
            warnings.showwarning = show_warning
            code = app(arguments, standalone_mode=False, prog_name="onorbit")
            if sys.stdout is not None:
                sys.stdout.flush()
    except OnOrbitError as error:
        fail(str(error), 2)
    except (KeyboardInterrupt, typer.Abort):
        fail("stopped by Ctrl-C", 130)
    except typer.TyperException as error:
        fail(_with_way_out(error), 2)
    except BrokenPipeError:
        leave_stdout()
        sys.exit(0)
    except OSError as error:
        if error.filename is not None:  # nobody may look there
            fail(f"cannot use {error.filename}: {error.strerror or error}", 2)
        leave_stdout()  # printing: the disk behind it is full
        fail(f"cannot write: {error.strerror or error}", 2)
    except Exception as error:
        if not hasattr(error, "trace"):
            raise
        fail(of_controller(error), 2)
    sys.exit(code if isinstance(code, int) else 0)


@contextmanager
def _executed_code_named() -> Iterator[None]:
    """Print each file of Python that a scenario brings before it is executed."""
    named: set[str] = set()

    def name(source: str) -> None:
        if source not in named:
            named.add(source)
            complain(f"onorbit: executes Python of this scenario: {printable(source)}")

    foreign_code.listeners.append(name)
    try:
        yield
    finally:
        foreign_code.listeners.remove(name)


def _with_way_out(error: typer.TyperException) -> str:
    """An unknown command is answered with those there are, a wrong option with where they are told."""
    message = error.format_message()
    if message.startswith("No such command"):
        return f"{message} Commands are: {', '.join(COMMANDS)}"
    context = getattr(error, "ctx", None)
    return message if context is None else f"{message.rstrip('.')}; see: {context.command_path} --help"
