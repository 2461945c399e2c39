"""The report page of a run with several systems: events, numbers, certificates and figures by system."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping, Sequence
from html import escape
from typing import Any

from onorbit_rs.common.event_kinds import OF_CONTACT
from onorbit_rs.output.checks import checks, world_checks
from onorbit_rs.report.numbers import Row, groups, row
from onorbit_rs.report.page import (
    Content,
    checks_table,
    data_html,
    filled,
    numbers_section,
    warnings_of,
)
from onorbit_rs.report.template import Picture, figure_html

_PARTS = ("events", "contacts", "latches", "systems", "certificate")
"""Entries of the summary of a world that are shown outside the tables of numbers."""

_COLUMNS = ("time_s", "impulse_ns", "angular_impulse_nms", "energy_lost_j", "linear_momentum_error_rel",
            "angular_momentum_error_rel")  # fmt: skip
_HEADS = ("event", "kind", "systems", "time", "impulse", "angular impulse", "energy lost",
          "error of linear momentum", "error of angular momentum")  # fmt: skip

_TOTALS = ("first_touch_down_s", "normal_force_max_n", "impulse_ns", "dissipated_j", "gap_min_m")
_TOTALS_HEADS = ("contact", "touches", "first touch-down", "largest normal force", "impulse",
                 "energy dissipated", "smallest gap")  # fmt: skip

_LATCH = (
    "time_s",
    "nearest_m",
    "nearest_rad",
    "nearest_s",
    "parted_s",
    "parted_speed_m_s",
    "parted_spin_rad_s",
)
_LATCH_HEADS = ("latch", "closed", "smallest distance", "angle then", "time then", "parted", "relative speed",
                "angular rate")  # fmt: skip

_OF_THE_ORBIT = ("inertial_axes", "velocity_eci_source", "gravity_mode")
"""Entries of a system's summary that describe the common orbit, and are therefore shown once."""


def world_page(
    summary: dict[str, Any],
    *,
    description: str,
    scenario: str,
    pictures: Mapping[str, Sequence[Picture]],
    remarks: Sequence[str],
    again: str,
    version: str,
) -> str:
    """Return the HTML of a report; ``pictures`` maps systems to figures, ``""`` to those of all systems."""
    systems: dict[str, dict[str, Any]] = summary["systems"]
    own = {key: value for key, value in summary.items() if key not in _PARTS}
    first = next(iter(systems.values()))
    own |= {key: first[key] for key in _OF_THE_ORBIT if key in first}
    contacts = summary.get("contacts", ())
    events = [event for event in summary["events"] if event["kind"] not in OF_CONTACT]
    parts = [] if contacts and not events else [_events(events)]
    parts += [_contacts(contacts)] if contacts else []
    parts += [_latches(latches)] if (latches := summary.get("latches", ())) else []
    parts.append(numbers_section("All systems", groups(own)))
    for name, system in systems.items():
        alone = {key: value for key, value in system.items() if key not in own}
        parts.append(numbers_section(name, [(title, _named(name, rows)) for title, rows in groups(alone)]))
    warnings = [*warnings_of(summary), *(f"{name}: {text}" for name, system in systems.items()
                                         for text in warnings_of(system))]  # fmt: skip
    content = Content("\n".join(parts), _certificates(summary), _figures(pictures))
    return filled(summary, content, description, scenario, warnings, remarks, again, version)


def _named(system: str, rows: Sequence[Row]) -> list[Row]:
    """Return the rows with the name of the system prepended to their keys."""
    return [entry._replace(key=f"{system}/{entry.key}") for entry in rows]


def _events(events: Sequence[dict[str, Any]]) -> str:
    """Return an HTML table of the events with their balances of momentum and energy."""
    if not events:
        return "<h2>Events</h2>\n<p>No event happened.</p>"
    about = (
        "The impulse acts on the second system. If the energy lost is negative, a spring added energy. The "
        "errors are the changes of the momentum of the group, relative to the sum of the magnitudes of the "
        "momenta of its bodies."
    )
    return _table("Events", about, _HEADS, map(_cells, events))


def _contacts(contacts: Sequence[dict[str, Any]]) -> str:
    """Return an HTML table of the totals of the contacts."""
    about = (
        "The impulse acts on the second side; it is the total of all touches. The smallest gap is the "
        "smallest in the rows of the trace; a negative gap is a depth. The events of each touch are in "
        "summary.json."
    )
    return _table("Contacts", about, _TOTALS_HEADS, map(_total_cells, contacts))


def _total_cells(contact: dict[str, Any]) -> Iterator[str]:
    """Yield the cells of a contact's table row as HTML."""
    yield f"<td>{escape(contact['name'])}</td>"
    yield f"<td>{data_html(row('touches', contact['touches'])._replace(key=_path(contact, 'touches')))}</td>"
    for key in _TOTALS:
        if contact[key] is None and key == "first_touch_down_s":
            yield "<td>never</td>"
            continue
        entry = row(key, contact[key])
        yield f"<td>{data_html(entry._replace(key=_path(contact, key)))} {escape(entry.unit)}</td>"


def _latches(latches: Sequence[dict[str, Any]]) -> str:
    """Return an HTML table of the results of the latches."""
    about = (
        "The distance and the angle are those between the frames. The systems parted when all contacts "
        "between them had ended, for the last time before the capture. The relative speed is that of their "
        "centres of mass, the angular rate that of the captured system."
    )
    return _table("Latches", about, _LATCH_HEADS, map(_latch_cells, latches))


def _latch_cells(latch: dict[str, Any]) -> Iterator[str]:
    """Yield the cells of a latch's table row as HTML."""
    yield f"<td>{escape(latch['name'])}</td>"
    for key in _LATCH:
        if latch[key] is None:
            yield f"<td>{'not met' if key == 'time_s' else '–'}</td>"
            continue
        entry = row(key, latch[key])._replace(key=f"latches/{latch['name']}/{key}")
        yield f"<td>{data_html(entry)} {escape(entry.unit)}</td>"


def _path(contact: dict[str, Any], key: str) -> str:
    return f"contacts/{contact['name']}/{key}"


def _table(title: str, about: str, heads: Sequence[str], rows: Iterable[Iterable[str]]) -> str:
    """Return the HTML of a section with a table; ``rows`` are the cells of each row."""
    head = "".join(f'<th scope="col">{name}</th>' for name in heads)
    lines = "\n".join(f"<tr>{''.join(cells)}</tr>" for cells in rows)
    table = f'<table class="events"><thead><tr>{head}</tr></thead>{lines}</table>'
    return f'<h2>{title}</h2>\n<p class="faint">{about}</p>\n<div class="scroll">{table}</div>'


def _cells(event: dict[str, Any]) -> Iterator[str]:
    """Yield the cells of an event's table row as HTML."""
    for text in (event["name"], event["kind"], ", ".join(event["systems"])):
        yield f"<td>{escape(text)}</td>"
    for key in _COLUMNS:
        entry = row(key, event[key])
        shown = f"{event[key]:.2g}" if key.endswith("_rel") and event[key] is not None else entry.shown
        value = data_html(entry._replace(key=f"events/{event['name']}/{key}", shown=shown))
        yield f"<td>{value} {escape(entry.unit)}</td>"


def _certificates(summary: dict[str, Any]) -> str:
    """Return HTML tables of the checks of groups and events, and of each system."""
    found = [check._replace(name=check.name.replace("/", ": ")) for check in world_checks(summary)]
    parts = ["<h3>Groups of systems and events</h3>", checks_table(found)] if found else []
    for name, system in summary["systems"].items():
        own = [check._replace(key=f"{name}/{check.key}") for check in checks(system)]
        parts += [f"<h3>{escape(name)}</h3>", checks_table(own)]
    return "\n".join(parts)


def _figures(pictures: Mapping[str, Sequence[Picture]]) -> str:
    """Return the HTML of the figures of all systems together, then of each system's figures."""
    parts = []
    for name, own in pictures.items():
        if own:
            parts += [f"<h3>{escape(name or 'All systems')}</h3>", *map(figure_html, own)]
    return "\n".join(parts)
