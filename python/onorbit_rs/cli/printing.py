"""What several commands print."""

from __future__ import annotations

import json
import shlex
from pathlib import Path
from typing import Any

import typer
from rich.console import Console
from rich.markup import escape
from rich.table import Table

from onorbit_rs.output.summary import CHECKS

_ROWS = (
    ("tracking_position_error_max_m", "tool position error, largest", "m"),
    ("tracking_attitude_error_max_rad", "tool attitude error, largest", "rad"),
    ("tracking_joint_error_max_rad", "joint error, largest", "rad"),
    ("tracking_joint_error_max_m", "error of a sliding joint, largest", "m"),
    ("joint_torque_max_nm", "joint torque, largest", "N m"),
    ("joint_force_max_n", "force of a sliding joint, largest", "N"),
    ("base_rotation_max_rad", "base rotation, largest", "rad"),
    ("simulated_s", "simulated", "s"),
    ("wall_s", "wall clock of the simulation loop", "s"),
    ("real_time_factor", "times real time", ""),
)
_FILES = (
    ("summary.json", "these numbers and more"),
    ("trace.npz", "every column of the trace, for numpy"),
    ("figures", "the figures, PNG"),
    ("report.html", "one page with everything, for a browser"),
    ("run.rrd", "the recording, for the rerun viewer"),
    ("scenario.yaml", "the scenario with every default; it runs again"),
)


def print_summary(summary: dict[str, Any], out: Path | None, *, is_new: bool = True) -> None:
    """The main numbers, the verdict, where the files are and what to do next."""
    console = new_console()
    table = new_table()
    for key, name, unit in _ROWS:
        if isinstance(summary.get(key), (int, float)):
            table.add_row(name, f"{summary[key]:.4g} {unit}")
    console.print(f"[bold]{text(summary.get('scenario', ''))}[/bold]: {text(summary.get('status', ''))}")
    console.print(table)
    console.print(_verdict(summary), soft_wrap=True)
    if summary.get("certificate_not_evaluated"):
        console.print(
            f"[yellow]certificate not evaluated[/yellow]: {text(summary['certificate_not_evaluated'])}",
            soft_wrap=True,
        )
    if out is None:
        console.print("nothing was written; keep the results with --out DIR", soft_wrap=True)
        return
    for name, what in _FILES:
        if (out / name).exists():
            console.print(f"  {text(out / name)}  [dim]{what}[/dim]", soft_wrap=True)
    if is_new:
        folder = text(shlex.quote(str(out)))
        console.print(f"next: onorbit show {folder}    [dim]opens the recording[/dim]", soft_wrap=True)
        console.print(
            f"      onorbit report {folder}  [dim]one page with everything, figures as PDF[/dim]",
            soft_wrap=True,
        )


def _verdict(summary: dict[str, Any]) -> str:
    """Green or red, with the balances behind it."""
    balances = [
        f"{name.removesuffix('_rel').removesuffix('_rad').replace('_', ' ')} {value:.1e}"
        for name, value in summary.items()
        if name in CHECKS and isinstance(value, float)
    ]
    if summary.get("certificate_passed"):
        return f"[green]certificate passed[/green]: {', '.join(balances)}"
    failures = text(summary.get("certificate_failures"))
    return f"[red]certificate FAILED[/red] ({failures}): {', '.join(balances)}"


def text(value: object) -> str:
    """Text of the user's, in which rich must see no markup."""
    return escape(str(value))


def print_json(data: object) -> None:
    """Data, and nothing else, on stdout."""
    typer.echo(json.dumps(data, indent=2, ensure_ascii=False, allow_nan=False))


def new_console() -> Console:
    """Stdout, with no colours but ours; lines are as long as they are where nobody looks."""
    console = Console(highlight=False)
    if not console.is_terminal:
        console.width = 10_000
    return console


def new_table() -> Table:
    """Columns side by side, no lines."""
    return Table(show_header=False, box=None, padding=(0, 2, 0, 0))
