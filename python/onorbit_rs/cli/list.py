"""``onorbit list``."""

from __future__ import annotations

from onorbit_rs.cli.options import JsonOption


def list_(as_json: JsonOption = False) -> None:
    """List the bundled scenarios and robots."""
    from onorbit_rs import robots, scenarios
    from onorbit_rs.cli.printing import new_console, new_table, print_json, text
    from onorbit_rs.scenario import load

    found = {name: load(name).description for name in scenarios.names()}
    if as_json:
        listed = [{"name": name, "description": description} for name, description in found.items()]
        print_json({"scenarios": listed, "robots": robots.names()})
        return
    console = new_console()
    table = new_table()
    for name, description in found.items():
        table.add_row(f"[bold]{text(name)}[/bold]", text(description))
    console.print("scenarios (onorbit run NAME --out DIR):")
    console.print(table)
    console.print(
        f"robots (onorbit info NAME, onorbit new NAME): {', '.join(robots.names())}", soft_wrap=True
    )
