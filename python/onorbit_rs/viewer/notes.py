"""Notes beside the 3-D view, in Markdown; names and values from the user are escaped."""

from __future__ import annotations

import re
from typing import TYPE_CHECKING, Any

from onorbit_rs.common.printable import printable
from onorbit_rs.visuals.shapes import missing_meshes

if TYPE_CHECKING:
    from onorbit_rs._core import Model
    from onorbit_rs.scenario import Scenario

_MARKUP = re.compile(r"([!#&()*+<>\[\]\\^`{|}~$])|(?<!\w)_|_(?!\w)")
"""Characters with a meaning in Markdown, except underscores within a name."""

_MOST_MESHES = 10


def notes(summary: dict[str, Any], scenario: Scenario) -> str:
    """Return the summary of a run as Markdown."""
    lines = "\n".join(f"| {escaped(key)} | {escaped(_short(value))} |" for key, value in summary.items())
    about = escaped(" ".join(scenario.description.split()))
    return f"# {escaped(scenario.name)}\n\n{about}\n\n| | |\n|-|-|\n{lines}\n"


def about_meshes(model: Model) -> str:
    """Return a note on the meshes that are not drawn; empty if all are."""
    missing = missing_meshes(model)
    if not missing:
        return ""
    more = "" if len(missing) <= _MOST_MESHES else f" and {len(missing) - _MOST_MESHES} more"
    named = ", ".join(escaped(name) for name in missing[:_MOST_MESHES])
    lost = "meshes that were not found or cannot be read"
    return f"\n\nCollision shapes and rods replace {lost}: {named}{more}.\n"


def escaped(text: str) -> str:
    """Return the text on one line with Markdown and invisible characters escaped."""
    return _MARKUP.sub(r"\\\g<0>", printable(text))


def _short(value: Any) -> str:
    return f"{value:.4g}" if isinstance(value, float) else str(value)
