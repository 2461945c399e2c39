"""``--help`` and ``docs/cli.md`` list the same options."""

from __future__ import annotations

import re
from pathlib import Path

import pytest
from commands import onorbit

from onorbit_rs.cli.app import COMMANDS

PAGE = (Path(__file__).parents[1] / "docs" / "cli.md").read_text()


def rows(heading: str) -> list[list[str]]:
    """Returns the cells of the table below a heading, row by row."""
    section = PAGE.split(f"## {heading}\n")[1].split("\n## ")[0]
    lines = [line for line in section.splitlines() if line.startswith("| ")]
    return [[cell.strip() for cell in line.strip("|").split("|")] for line in lines[1:]]


def documented(command: str) -> set[str]:
    """Returns the options of a command on the page."""
    return {
        option
        for options, of, _ in rows("Options")
        if f"`{command}`" in of
        for option in re.findall(r"`(--?[a-z-]+)", options)
    }


def offered(command: str) -> set[str]:
    """Returns the options of a command in ``--help``."""
    words = [] if command == "onorbit" else [command]
    done = onorbit(*words, "--help")
    assert done.returncode == 0
    options = re.sub(r"(?s)^.*?\nOptions:\n|\nCommands:.*$", "", done.stdout)
    starts = [line[:45] for line in options.splitlines() if re.match(r"  -", line)]
    return {option for line in starts for option in re.findall(r"(?<![\w-])--?[a-z][a-z-]*", line)} - {
        "--help"
    }


@pytest.mark.parametrize("command", ["onorbit", *COMMANDS])
def test_the_page_lists_exactly_the_options_of_every_command(command: str) -> None:
    assert offered(command) == documented(command)


def test_the_page_lists_every_command_with_its_arguments() -> None:
    commands = {cells[0].strip("`").split()[1]: cells[0] for cells in first_table()}
    assert set(commands) == set(COMMANDS)
    for name, words in commands.items():
        usage = onorbit(name, "--help").stdout.splitlines()[0]
        for argument in re.findall(r"[A-Z_]{2,}", usage.replace("[OPTIONS]", "")):
            assert argument in words, name


def first_table() -> list[list[str]]:
    lines = [line for line in PAGE.split("```sh")[0].splitlines() if line.startswith("| `")]
    return [[cell.strip() for cell in line.strip("|").split("|")] for line in lines]


def test_the_help_of_a_command_starts_with_one_line() -> None:
    done = onorbit()
    assert (done.returncode, done.stderr) == (2, "")
    for name in COMMANDS:
        (line,) = [line for line in done.stdout.splitlines() if line.startswith(f"  {name} ")]
        assert line.endswith(".") and not line.endswith("..."), line
