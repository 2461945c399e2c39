"""Implements ``onorbit list``, which lists the bundled scenarios, campaigns and robots."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from onorbit_rs.cli.options import JsonOption

if TYPE_CHECKING:
    from onorbit_rs.common.bundled_files import BundledFiles


def list_(as_json: JsonOption = False) -> None:
    """List the bundled scenarios, campaigns and robots."""
    from onorbit_rs import robots
    from onorbit_rs.campaigns.bundled import CAMPAIGNS
    from onorbit_rs.cli.console import new_console, new_table, print_json, print_table, text
    from onorbit_rs.scenarios import SCENARIOS

    found = {"scenarios": descriptions(SCENARIOS), "campaigns": descriptions(CAMPAIGNS)}
    if as_json:
        listed: dict[str, Any] = {
            kind: [{"name": name, "description": words} for name, words in texts.items()]
            for kind, texts in found.items()
        }
        print_json(listed | {"robots": robots.names()})
        return
    console = new_console()
    for kind, command in (("scenarios", "run"), ("campaigns", "campaign")):
        table = new_table()
        table.add_column(no_wrap=True)
        table.add_column()
        for name, words in found[kind].items():
            table.add_row(f"[bold]{text(name)}[/bold]", text(words))
        console.print(f"{kind} (onorbit {command} NAME --out DIR):")
        print_table(console, table)
    console.print(
        f"robots (onorbit info NAME, onorbit new NAME): {', '.join(robots.names())}", soft_wrap=True
    )


def descriptions(files: BundledFiles) -> dict[str, str]:
    """Return the descriptions of bundled files by name, without validation, which takes 0.5 s."""
    import yaml

    loader = getattr(yaml, "CSafeLoader", yaml.SafeLoader)
    texts = {name: files.path(name).read_text(encoding="utf-8") for name in files.names()}
    return {name: str(yaml.load(text, Loader=loader)["description"]).strip() for name, text in texts.items()}
