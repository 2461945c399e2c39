"""Notes beside the 3-D view, in Markdown; names and values from the user are escaped."""

from __future__ import annotations

import re
from typing import TYPE_CHECKING, Any

from onorbit_rs.common.event_kinds import OF_CONTACT
from onorbit_rs.common.printable import printable
from onorbit_rs.visuals.shapes import missing_meshes

if TYPE_CHECKING:
    from onorbit_rs._core import Model
    from onorbit_rs.scenario import Scenario, WorldScenario

_MARKUP = re.compile(r"([!#&()*+<>\[\]\\^`{|}~$])|(?<!\w)_|_(?!\w)")
"""Characters with a meaning in Markdown, except underscores within a name."""

_MOST_MESHES = 10


def notes(summary: dict[str, Any], scenario: Scenario | WorldScenario) -> str:
    """Return name and description of a scenario, and the summary of its run, as Markdown."""
    lines = "\n".join(f"| {escaped(key)} | {escaped(_short(value))} |" for key, value in summary.items())
    about = escaped(" ".join(scenario.description.split()))
    return f"# {escaped(scenario.name)}\n\n{about}\n\n| | |\n|-|-|\n{lines}\n"


def world_notes(summary: dict[str, Any], scenario: WorldScenario) -> str:
    """Return the summary of a run with several systems as Markdown, with the events first."""
    own = {key: value for key, value in summary.items() if not isinstance(value, (dict, list))}
    text = notes(own, scenario)
    events = [event for event in summary["events"] if event["kind"] not in OF_CONTACT]
    if events:
        rows = [_event(event) for event in events]
        head = "| event | t [s] | lost [J] | impulse [N s] | [N m s] | momentum errors |\n|-|-|-|-|-|-|\n"
        title, _, rest = text.partition("\n\n| |")
        text = f"{title}\n\n{head}" + "\n".join(rows) + f"\n\n| |{rest}"
    if summary.get("contacts"):
        head = ("| contact | touches | first [s] | largest force [N] | impulse [N s] | dissipated [J] "
                "| smallest gap [m] |\n|-|-|-|-|-|-|-|\n")  # fmt: skip
        text += "\n## Contacts\n\n" + head + "\n".join(map(_contact, summary["contacts"])) + "\n"
    for name, system in summary["systems"].items():
        lines = "\n".join(f"| {escaped(key)} | {escaped(_short(value))} |" for key, value in system.items())
        text += f"\n## {escaped(name)}\n\n| | |\n|-|-|\n{lines}\n"
    return text


def _event(event: dict[str, Any]) -> str:
    """Return the row of an event in a Markdown table."""
    errors = ", ".join(_short(event[f"{part}_momentum_error_rel"]) for part in ("linear", "angular"))
    numbers = (event[key] for key in ("time_s", "energy_lost_j", "impulse_ns", "angular_impulse_nms"))
    cells = [f"{event['name']} ({event['kind']})", *map(_short, numbers), errors]
    return "| " + " | ".join(map(escaped, cells)) + " |"


def _contact(contact: dict[str, Any]) -> str:
    """Return the row of a contact in a Markdown table."""
    first = contact["first_touch_down_s"]
    numbers = (contact[key] for key in ("normal_force_max_n", "impulse_ns", "dissipated_j", "gap_min_m"))
    begun = "never" if first is None else _short(first)
    cells = (contact["name"], str(contact["touches"]), begun, *map(_short, numbers))
    return "| " + " | ".join(map(escaped, cells)) + " |"


def about_rows(recorded: int, rows: int) -> str:
    """Return a note on rows of the trace that are not recorded; empty if all rows are recorded."""
    if recorded == rows:
        return ""
    return f"\n\nThe recording contains {recorded} of the {rows} rows of the trace.\n"


def about_meshes(model: Model) -> str:
    """Return a note on meshes that are not drawn; empty if all meshes are drawn."""
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
