"""Implements ``onorbit list``, which lists the bundled scenarios and robots."""

from __future__ import annotations

from onorbit_rs.cli.options import JsonOption


def list_(as_json: JsonOption = False) -> None:
    """List the bundled scenarios and robots."""
    from onorbit_rs import robots, scenarios
    from onorbit_rs.cli.console import new_console, new_table, print_json, print_table, text

    found = {name: description(name) for name in scenarios.names()}
    if as_json:
        listed = [{"name": name, "description": words} for name, words in found.items()]
        print_json({"scenarios": listed, "robots": robots.names()})
        return
    console = new_console()
    table = new_table()
    table.add_column(no_wrap=True)
    table.add_column()
    for name, words in found.items():
        table.add_row(f"[bold]{text(name)}[/bold]", text(words))
    console.print("scenarios (onorbit run NAME --out DIR):")
    print_table(console, table)
    console.print(
        f"robots (onorbit info NAME, onorbit new NAME): {', '.join(robots.names())}", soft_wrap=True
    )


def description(name: str) -> str:
    """Return the description of a bundled scenario without validating the scenario, which takes 0.5 s."""
    import yaml

    from onorbit_rs import scenarios

    loader = getattr(yaml, "CSafeLoader", yaml.SafeLoader)
    data = yaml.load(scenarios.path(name).read_text(encoding="utf-8"), Loader=loader)
    return str(data["description"]).strip()
