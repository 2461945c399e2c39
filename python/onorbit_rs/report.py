"""What the command line prints."""

from __future__ import annotations

import json
import math
import shlex
from pathlib import Path
from typing import TYPE_CHECKING, Any

import typer
from rich.console import Console
from rich.markup import escape
from rich.table import Table

from onorbit_rs.exceptions import (
    InputError,
    NotFoundError,
    OnOrbitError,
    OutputFolderError,
    OutputNotEmptyError,
    ReadError,
)
from onorbit_rs.output.summary import CHECKS

if TYPE_CHECKING:
    from onorbit_rs.scenario.build import Built

_ROWS = (
    ("tracking_position_error_max_m", "tool position error, largest", "m"),
    ("tracking_attitude_error_max_rad", "tool attitude error, largest", "rad"),
    ("joint_torque_max_nm", "joint torque, largest", "N m"),
    ("base_rotation_max_rad", "base rotation, largest", "rad"),
    ("simulated_s", "simulated", "s"),
    ("wall_s", "wall clock of the simulation loop", "s"),
    ("real_time_factor", "times real time", ""),
)
_FILES = (
    ("summary.json", "these numbers and more"),
    ("trace.npz", "every column of the trace, for numpy"),
    ("figures", "the figures, PNG"),
    ("run.rrd", "the recording, for the rerun viewer"),
    ("scenario.yaml", "the scenario with every default; it runs again"),
)


def print_summary(summary: dict[str, Any], out: Path | None, *, is_new: bool = True) -> None:
    """The main numbers, the verdict, where the files are and what to do next."""
    console = Console(highlight=False)
    table = Table(show_header=False, box=None, padding=(0, 2, 0, 0))
    for key, name, unit in _ROWS:
        if isinstance(summary.get(key), (int, float)):
            table.add_row(name, f"{summary[key]:.4g} {unit}")
    console.print(f"[bold]{_text(summary.get('scenario', ''))}[/bold]: {_text(summary.get('status', ''))}")
    console.print(table)
    console.print(_verdict(summary), soft_wrap=True)
    if summary.get("certificate_not_evaluated"):
        console.print(
            f"[yellow]certificate not evaluated[/yellow]: {_text(summary['certificate_not_evaluated'])}",
            soft_wrap=True,
        )
    if out is None:
        console.print("nothing was written; keep the results with --out DIR", soft_wrap=True)
        return
    for name, what in _FILES:
        if (out / name).exists():
            console.print(f"  {_text(out / name)}  [dim]{what}[/dim]", soft_wrap=True)
    if is_new:
        console.print(f"next: onorbit show {_text(shlex.quote(str(out)))}", soft_wrap=True)


def _verdict(summary: dict[str, Any]) -> str:
    """Green or red, with the balances behind it."""
    balances = [
        f"{name.removesuffix('_rel').removesuffix('_rad').replace('_', ' ')} {value:.1e}"
        for name, value in summary.items()
        if name in CHECKS and isinstance(value, float)
    ]
    if summary.get("certificate_passed"):
        return f"[green]certificate passed[/green]: {', '.join(balances)}"
    failures = _text(summary.get("certificate_failures"))
    return f"[red]certificate FAILED[/red] ({failures}): {', '.join(balances)}"


def _text(value: object) -> str:
    """Text of the user's, in which rich must see no markup."""
    return escape(str(value))


def print_bundled() -> None:
    """Scenarios with their descriptions, and robots."""
    from onorbit_rs import robots, scenarios
    from onorbit_rs.scenario import load

    console = Console(highlight=False)
    table = Table(show_header=False, box=None, padding=(0, 2, 0, 0))
    for name in scenarios.names():
        table.add_row(f"[bold]{_text(name)}[/bold]", _text(load(name).description))
    console.print("scenarios (onorbit run NAME --out DIR):")
    console.print(table)
    console.print(f"robots: {', '.join(robots.names())}")


def print_checked(built: Built) -> None:
    """What would run."""
    scenario, model = built.scenario, built.model
    settings = scenario.simulation
    parts = [
        f"{model.name} ({len(model.joint_names)} joints, {model.mass:.4g} kg)",
        f"orbit {scenario.orbit.kind}" if scenario.orbit else "no orbit",
        *(effect.kind for effect in scenario.environment),
        ", ".join(law.kind for law in scenario.laws) or "no controller",
        f"{settings.duration:g} s at {settings.time_step:g} s with {settings.integrator}",
    ]
    typer.echo(f"ok: {scenario.name}: {', '.join(parts)}")


def print_run(folder: Path) -> dict[str, Any]:
    """Print a finished run's summary, and return it.

    Raises
    ------
    NotFoundError
        No such folder, or no run in it.
    ReadError
        Its summary cannot be read.
    """
    file = folder / "summary.json"
    try:
        is_there = file.is_file()
    except OSError as error:  # a name too long
        raise ReadError(f"cannot read {file}: {error.strerror}", path=str(file), kind="summary") from error
    if not is_there:
        what = "no run in this folder (no summary.json)" if folder.is_dir() else "no such folder"
        raise NotFoundError(f"{what}: {folder}", path=str(folder), kind="run")
    try:
        summary = dict(json.loads(file.read_text(encoding="utf-8")))
    except (ValueError, TypeError, OSError) as error:
        raise ReadError(f"cannot read {file}: {error}", path=str(file), kind="summary") from error
    print_summary(summary, folder, is_new=False)
    return summary


def open_viewer(folder: Path) -> None:
    """Open the recording of a run where there is a screen, or say how."""
    from onorbit_rs.viewer.screen import has_screen, open_recording

    recording = folder / "run.rrd"
    if recording.is_file() and has_screen():
        open_recording(recording)
    elif recording.is_file():
        typer.echo(f"no screen here; open the recording with: rerun {shlex.quote(str(recording))}")


def save_picture(folder: Path, picture: Path, at_s: float, end_s: float) -> None:
    """Save what the viewer shows at a moment of a run that lasted ``end_s``.

    Raises
    ------
    InputError
        The moment is outside the run.
    OutputFolderError
        The picture cannot be written.
    """
    from onorbit_rs import viewer

    if not (math.isfinite(at_s) and 0.0 <= at_s <= end_s):
        raise InputError(
            f"--at {at_s:g} s is outside the run, which goes from 0 to {end_s:g} s",
            name="at", got=at_s, expected=f"0 to {end_s:g} s",
        )  # fmt: skip
    try:
        viewer.take_screenshot(folder / "run.rrd", picture, at_s=at_s)
    except OSError as error:
        if isinstance(error, OnOrbitError):
            raise
        reason = error.strerror or error
        raise OutputFolderError(f"cannot write {picture}: {reason}", path=str(picture)) from error
    typer.echo(f"picture: {picture}")


def print_converted(
    files: list[Path], out: Path | None, *, controller: str | None, keep_going: bool, force: bool
) -> None:
    """Convert files of OnOrbitROS: remarks on stderr, the scenario to ``out`` or stdout.

    Raises
    ------
    OutputFolderError
        ``out`` is there already, or cannot be written.
    """
    from onorbit_rs.interop.onorbitros import convert
    from onorbit_rs.interop.write_scenario import scenario_text
    from onorbit_rs.scenario.load import check

    if out is not None and out.exists() and not force:
        raise OutputNotEmptyError(f"{out} is there already; replace it with --force", path=str(out))
    done = convert(files, controller=controller, keep_going=keep_going, beside=out.parent if out else None)
    check(done.scenario, None, {})
    for note in done.notes:
        typer.echo(str(note), err=True)
    made_of = ", ".join(file.name for file in files)
    text = scenario_text(
        done.scenario, done.comments, f"Made by onorbit convert of {made_of}. SI and radians."
    )
    if out is None:
        typer.echo(text, nl=False)
        return
    try:
        out.write_text(text, encoding="utf-8")
    except OSError as error:
        raise OutputFolderError(f"cannot write {out}: {error.strerror or error}", path=str(out)) from error
    typer.echo(f"scenario: {out}\nnext: onorbit check {shlex.quote(str(out))}")
