"""``onorbit list``."""

from __future__ import annotations


def list_() -> None:
    """List the bundled scenarios and robots."""
    from onorbit_rs import robots, scenarios
    from onorbit_rs.cli.printing import new_console, new_table, text
    from onorbit_rs.scenario import load

    console = new_console()
    table = new_table()
    for name in scenarios.names():
        table.add_row(f"[bold]{text(name)}[/bold]", text(load(name).description))
    console.print("scenarios (onorbit run NAME --out DIR):")
    console.print(table)
    console.print(f"robots: {', '.join(robots.names())}")
