"""Prints the summary of a run: numbers, certificate, files and next commands."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

from onorbit_rs.cli.console import new_console, new_table, print_table, text
from onorbit_rs.common.display_units import digits
from onorbit_rs.common.event_kinds import OF_CONTACT
from onorbit_rs.common.printable import shell_word
from onorbit_rs.output.checks import Check, checks, is_incomplete, world_checks
from onorbit_rs.output.summary_labels import EXCEEDED, goal_of, tracking

if TYPE_CHECKING:
    from rich.console import Console
    from rich.table import Table

_ROWS = (
    ("joint_torque_max_nm", "joint torque, largest", "N m"),
    ("joint_force_max_n", "force of a prismatic joint, largest", "N"),
    ("base_rotation_max_rad", "base rotation in W, largest", "rad"),
    ("base_displacement_max_m", "base displacement in W, largest", "m"),
    ("simulated_s", "simulated", "s"),
    ("wall_s", "wall-clock time of the simulation loop", "s"),
    ("real_time_factor", "real-time factor", ""),
)
_FILES = (
    ("summary.json", "these numbers and more"),
    ("trace.npz", "every column of the trace, for numpy"),
    ("figures", "the figures, PNG"),
    ("report.html", "self-contained report, for a browser"),
    ("run.rrd", "the recording, for the rerun viewer"),
    ("scenario.yaml", "the scenario with all defaults, ready to run"),
    ("commands.jsonl", "the commands given to the run"),
)
_AUDIT = (("impulse_ns", "N s"), ("energy_lost_j", "J"))
_TOTALS = (("normal_force_max_n", "N"), ("impulse_ns", "N s"), ("dissipated_j", "J"), ("gap_min_m", "m"))
_OF_THE_RUN = ("simulated_s", "wall_s", "real_time_factor")
"""Summary keys whose values apply to all systems of a run."""
_VERDICTS = {True: "[green]holds[/green]", False: "[red]BROKEN[/red]", None: "[yellow]not evaluated[/yellow]"}


def print_summary(summary: dict[str, Any], out: Path | None, *, is_new: bool = True) -> None:
    """Print the main numbers, the certificate, the files and the next commands."""
    console = new_console()
    console.print(f"[bold]{text(summary.get('scenario', ''))}[/bold]: {text(summary.get('status', ''))}")
    systems = summary.get("systems")
    if systems is None:
        _print_run(console, summary)
    else:
        _print_world(console, summary, systems)
    if out is None:
        console.print("nothing was written; save the results with --out DIR", soft_wrap=True)
        return
    for name, what in _FILES:
        if (out / name).exists():
            console.print(f"  {text(out / name)}  [dim]{what}[/dim]", soft_wrap=True)
    if is_new:
        folder = text(shell_word(out))
        console.print(f"next: onorbit show {folder}    [dim]opens the recording[/dim]", soft_wrap=True)
        console.print(
            f"      onorbit report {folder}  [dim]self-contained report, figures as PDF[/dim]",
            soft_wrap=True,
        )


def _print_run(console: Console, summary: dict[str, Any]) -> None:
    """Print the numbers and the certificate of one robot."""
    table = new_table()
    for name, value in (*_errors(summary), *_goals(summary), *_numbers(summary)):
        table.add_row(text(name), text(value))
    print_table(console, table)
    for key, what in EXCEEDED.items():
        if summary.get(key):
            console.print(f"[yellow]{what} were exceeded[/yellow]: {text(summary[key])}", soft_wrap=True)
    if summary.get("joint_efforts_at_limit"):
        limited = text(summary["joint_efforts_at_limit"])
        console.print(f"[yellow]joint efforts were at their limits[/yellow]: {limited}", soft_wrap=True)
    console.print(_verdict(summary), soft_wrap=True)
    lines = checks(summary)
    if lines:
        print_table(console, _certificate(lines))


def _print_world(console: Console, summary: dict[str, Any], systems: dict[str, Any]) -> None:
    """Print the events, the contacts, each system, and the certificate of the world."""
    _print_events(console, [event for event in summary["events"] if event["kind"] not in OF_CONTACT])
    _print_contacts(console, summary.get("contacts", ()))
    _print_latches(console, summary.get("latches", ()))
    for name, system in systems.items():
        console.print(f"[bold]{text(name)}[/bold]:", soft_wrap=True)
        _print_run(console, {key: value for key, value in system.items() if key not in _OF_THE_RUN})
    console.print("[bold]all systems[/bold]:")
    table = new_table()
    for name, value in _numbers(summary):
        table.add_row(text(name), text(value))
    print_table(console, table)
    console.print(_verdict(summary), soft_wrap=True)
    lines = world_checks(summary)
    if lines:
        print_table(console, _certificate(lines))


def _print_events(console: Console, events: Sequence[dict[str, Any]]) -> None:
    """Print a table of captures, releases and brake events."""
    if not events:
        return
    table = new_table("event", "kind", "time", "systems", "impulse", "energy lost")
    for event in events:
        impulse, lost = (_formatted(event[key], unit) for key, unit in _AUDIT)
        names = ", ".join(dict.fromkeys(event["systems"]))
        cells = (event["name"], event["kind"], _formatted(event["time_s"], "s"), names, impulse, lost)
        table.add_row(*map(text, cells))
    print_table(console, table)


def _print_contacts(console: Console, contacts: Sequence[dict[str, Any]]) -> None:
    """Print a table of the totals of the contacts."""
    if not contacts:
        return
    table = new_table("contact", "touches", "first", "largest normal force", "impulse", "energy dissipated",
                      "smallest gap")  # fmt: skip
    for contact in contacts:
        first = contact["first_touch_down_s"]
        totals = (_formatted(contact[key], unit) for key, unit in _TOTALS)
        begun = "never" if first is None else _formatted(first, "s")
        table.add_row(*map(text, (contact["name"], str(contact["touches"]), begun, *totals)))
    print_table(console, table)


def _print_latches(console: Console, latches: Sequence[dict[str, Any]]) -> None:
    """Print a table of the latches: result, nearest approach, and last separation before the capture."""
    if not latches:
        return
    table = new_table("latch", "result", "nearest", "at", "parted", "relative speed", "spin")
    for latch in latches:
        result = "not met" if latch["time_s"] is None else "closed"
        values = (
            "" if latch[key] is None else _formatted(latch[key], unit)
            for key, unit in (
                ("nearest_m", "m"), ("nearest_s", "s"), ("parted_s", "s"), ("parted_speed_m_s", "m/s"),
                ("parted_spin_rad_s", "rad/s"),
            )
        )  # fmt: skip
        table.add_row(*map(text, (latch["name"], result, *values)))
    print_table(console, table)


def _errors(summary: dict[str, Any]) -> list[tuple[str, str]]:
    """Return labels and values of the largest tracking errors, per controller if there are several."""
    found = [(tracking(key), value) for key, value in summary.items()]
    largest = [(error, value) for error, value in found if error is not None and error.is_largest]
    named = [(error, value) for error, value in largest if error.owner]
    # the tool's errors are also those of the controller that moves it
    return [(error.label, _formatted(value, error.unit)) for error, value in named or largest]


def _goals(summary: dict[str, Any]) -> Iterator[tuple[str, str]]:
    """Yield the label and the outcome of each controller's goal."""
    for key, value in summary.items():
        if (whose := goal_of(key)) is not None:
            yield f"{whose}: goal", str(value).replace("_", " ")


def _numbers(summary: dict[str, Any]) -> Iterator[tuple[str, str]]:
    for key, name, unit in _ROWS:
        if key in summary:
            yield name, _formatted(summary[key], unit)


def _formatted(value: Any, unit: str) -> str:
    if not isinstance(value, (int, float)):
        return "not finite"
    return f"{digits(value)} {unit}".rstrip()


def _verdict(summary: dict[str, Any]) -> str:
    """Return the result of the certificate in green or red, or in yellow if a check is missing."""
    has_passed = summary.get("certificate_passed")
    if has_passed is None:
        return "[yellow]certificate absent[/yellow]: nothing was checked"
    if has_passed and is_incomplete(summary):
        absent = text(summary.get("certificate_not_evaluated"))
        return f"[yellow]certificate incomplete[/yellow]: no value exceeds its gate, not evaluated: {absent}"
    if has_passed:
        return "[green]certificate passed[/green]: every value is within its gate"
    return f"[red]certificate FAILED[/red] ({text(summary.get('certificate_failures'))})"


def _certificate(lines: list[Check]) -> Table:
    """Return a table of the checks of a certificate, with their values, gates and outcomes."""
    table = new_table("", "value", "gate", "unit", "")
    for check in lines:
        value = "not finite" if check.holds is False and check.value is None else _short(check.value)
        table.add_row(f"  {check.name}", value, _short(check.gate), check.unit, _VERDICTS[check.holds])
    return table


def _short(value: float | None) -> str:
    return "-" if value is None else f"{value:.2g}"
