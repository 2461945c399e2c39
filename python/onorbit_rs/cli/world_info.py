"""Prints the systems, contacts, events and trees of connected systems of a scenario with several systems."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Any

from onorbit_rs.cli.console import new_table, print_table, text
from onorbit_rs.common.counting import count
from onorbit_rs.common.display_units import amount

if TYPE_CHECKING:
    from collections.abc import Mapping

    from rich.console import Console

    from onorbit_rs._core import Model
    from onorbit_rs.scenario import WorldScenario
    from onorbit_rs.scenario.contact import Contact
    from onorbit_rs.scenario.event_stages import Stage
    from onorbit_rs.scenario.events import Event


def describe_world(scenario: WorldScenario, models: Mapping[str, Model]) -> dict[str, Any]:
    """Return the content of ``onorbit info`` for a scenario with several systems, in SI units."""
    from onorbit_rs.scenario.event_stages import stages

    return {
        "scenario": scenario.name,
        "systems": [
            {
                "name": name, "robot": model.name, "mass_kg": model.mass, "joints": list(model.joint_names),
                "controllers": [law.kind for law in scenario.scenarios[name].laws],
            }
            for name, model in models.items()
        ],
        "contacts": [
            {"name": contact.label, "between": contact.between, "normal": _law(contact),
             "friction": contact.friction is not None}
            for contact in scenario.contacts
        ],
        "events": [
            {"name": event.name, "when": _when(event), "what": _what(event)} for event in scenario.events
        ],
        "trees": [
            {
                "after": stage.event, "time_s": stage.time, "remark": stage.remark,
                "trees": _trees(stage, models),
            }
            for stage in stages(scenario)
        ],
    }  # fmt: skip


def _trees(stage: Stage, models: Mapping[str, Model]) -> list[dict[str, Any]]:
    """Return the trees of connected systems after an event, or at the start, as data.

    ``joints`` is the number of joints, including those of seatings.
    """
    seatings = stage.seating_joints or (0,) * len(stage.trees)
    return [
        {
            "systems": list(systems), "root": systems[0],
            "joints": seating + sum(len(models[name].joint_names) for name in systems),
            "seating_joints": seating, "mass_kg": math.fsum(models[name].mass for name in systems),
        }
        for systems, seating in zip(stage.trees, seatings, strict=True)
    ]  # fmt: skip


def print_world(scenario: WorldScenario, models: Mapping[str, Model], console: Console) -> None:
    """Print tables of systems, contacts and events, and the trees of connected systems after each event."""
    from onorbit_rs.scenario.event_stages import stages

    events, contacts = scenario.events, scenario.contacts
    touches = [count(len(contacts), "contact", "contacts")] if contacts else []
    parts = [count(len(models), "system", "systems"), *touches, count(len(events), "event", "events")]
    counts = ", ".join(parts)
    console.print(f"[bold]{text(scenario.name)}[/bold]: {counts}\n")
    table = new_table("system", "robot", "mass, kg", "joints", "controllers")
    _left(table, 0, 1, 4)
    for name, model in models.items():
        laws = ", ".join(law.kind for law in scenario.scenarios[name].laws) or "-"
        cells = (name, model.name, f"{model.mass:.5g}", str(len(model.joint_names)), laws)
        table.add_row(*map(text, cells))
    print_table(console, table)
    if contacts:
        console.print()
        _print_contacts(contacts, console)
    if not events:
        console.print("\nno events" if contacts else "\nno events: every system moves alone")
        return
    console.print()
    table = new_table("event", "when", "what")
    _left(table, 0, 1, 2)
    for event in events:
        table.add_row(*map(text, (event.name, _when(event), _what(event))))
    print_table(console, table)
    console.print("\n[bold]trees of connected systems[/bold]: the first system of a tree is its root")
    found = stages(scenario)
    table = new_table("after", "t, s", "tree", "joints", "mass, kg")
    _left(table, 0, 2)
    for stage in found:
        _add_stage(table, stage, models)
    print_table(console, table)
    if any(sum(stage.seating_joints) for stage in found):
        console.print(
            "+ 2: a prismatic and a revolute joint, which move until the seating ends", soft_wrap=True
        )
    if any(stage.time is None for stage in found):
        console.print(
            "events without a time depend on the motion or on a command; they are listed in the order of the "
            "scenario and may happen in another order", soft_wrap=True,
        )  # fmt: skip


def _print_contacts(contacts: list[Contact], console: Console) -> None:
    """Print a table of the contacts."""
    table = new_table("contact", "between", "and", "normal force", "friction")
    _left(table, 0, 1, 2, 3)
    for contact in contacts:
        sides = (", ".join(side) for side in contact.between)
        friction = "-" if contact.friction is None else f"{contact.friction.build().static:g}"
        table.add_row(*map(text, (contact.label, *sides, _law(contact), friction)))
    print_table(console, table)


def _law(contact: Contact) -> str:
    """Return the kind of the normal force, or ``distance only`` for a contact without forces."""
    return "distance only" if contact.normal is None else contact.normal.kind


def _add_stage(table: Any, stage: Stage, models: Mapping[str, Model]) -> None:
    """Add a row for each tree of connected systems after an event, or a remark if the event changes none."""
    after = text(stage.event or "the start")
    time = "-" if stage.time is None else f"{stage.time:.6g}"
    if stage.remark:
        table.add_row(after, time, f"[yellow]{text(stage.remark)}[/yellow]", "", "")
        return
    for number, tree in enumerate(_trees(stage, models)):
        names, seating = text(" + ".join(tree["systems"])), tree["seating_joints"]
        shown = f"[bold]{names}[/bold]" if len(tree["systems"]) > 1 else names
        first = (after, time) if number == 0 else ("", "")
        joints = f"{tree['joints'] - seating} + {seating}" if seating else str(tree["joints"])
        table.add_row(*first, shown, joints, f"{tree['mass_kg']:.5g}")


def _left(table: Any, *columns: int) -> None:
    for column in columns:
        table.columns[column].justify = "left"


def _when(event: Event) -> str:
    """Return the condition of an event in words."""
    when = event.when
    if when.latch is not None:
        latch = when.latch
        words = f"latch: within {_pair(latch.within, 'm', 'deg')}"
        if latch.slower_than is not None:
            words += f", slower than {_pair(latch.slower_than, 'm/s', 'deg/s')}"
        return words + (f", held for {latch.held_for:g} s" if latch.held_for else "")
    if when.after is not None:
        return f"{when.delay:g} s after {when.after}" if when.delay else f"immediately after {when.after}"
    return "on command" if when.on_command else f"at {when.at:g} s"


def _what(event: Event) -> str:
    """Return the action of an event in words."""
    if event.do.capture is not None:
        by, of = event.do.capture
        seated = "" if event.do.seat is None else f", and seats it in {event.do.seat:g} s"
        return f"{by} captures {of}{seated}"
    if event.do.engage is not None:
        return f"engages {event.do.engage}"
    if event.do.disengage is not None:
        return f"disengages {event.do.disengage}"
    words = f"releases {event.do.release}"
    if event.do.impulse is None:
        return words
    parts = ((math.hypot(*event.do.impulse[:3]), "N s"), (math.hypot(*event.do.impulse[3:]), "N m s"))
    pushes = [f"{size:.4g} {unit}" for size, unit in parts if size]
    return f"{words} with {' and '.join(pushes)}" if pushes else words


def _pair(values: list[float], unit: str, angle_unit: str) -> str:
    return f"{amount(values[0], unit)} and {math.degrees(values[1]):.4g} {angle_unit}"
