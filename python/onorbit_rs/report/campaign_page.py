"""Fills the report page of a campaign."""

from __future__ import annotations

from collections.abc import Sequence
from html import escape
from typing import Any, NamedTuple

from onorbit_rs.common.display_units import digits
from onorbit_rs.common.printable import printable
from onorbit_rs.report import template
from onorbit_rs.report.template import Picture, Verdict, figure_html


class HtmlTable(NamedTuple):
    """A table of text and numbers, with a heading and a sentence that explains it."""

    title: str
    about: str
    header: Sequence[str]
    rows: Sequence[Sequence[Any]]


def campaign_page(
    *,
    name: str,
    description: str,
    verdict: Verdict,
    numbers: Sequence[HtmlTable],
    cases: Sequence[HtmlTable],
    pictures: Sequence[Picture],
    campaign: str,
    again: str,
    version: str,
) -> str:
    """Return the HTML of the report of a campaign, without references to other files.

    ``numbers`` are the tables before the figures, and ``cases`` those after them.
    """
    return template.filled(
        name=name,
        what="onorbit campaign",
        description=description,
        verdict=verdict,
        warnings=(),
        numbers="\n".join(map(_table, numbers)),
        figures="\n".join(map(figure_html, pictures)) or "<p>No result varies.</p>",
        cases="\n".join(map(_table, cases)),
        source="Campaign",
        text=campaign,
        again=again,
        version=version,
    )


def _table(table: HtmlTable) -> str:
    head = "".join(
        f'<th scope="col"{_number_class(i)}>{escape(name)}</th>' for i, name in enumerate(table.header)
    )
    lines = "\n".join(
        f"<tr>{''.join(_cell(i, value) for i, value in enumerate(row))}</tr>" for row in table.rows
    )
    about = f'<p class="faint">{escape(table.about)}</p>' if table.about else ""
    return (
        f'<h2>{escape(table.title)}</h2>\n{about}<div class="scroll"><table class="events"><thead><tr>{head}'
        f"</tr></thead>{lines}</table></div>"
    )


def _number_class(index: int) -> str:
    return ' class="number"' if index else ""


def _cell(index: int, value: Any) -> str:
    """Return one cell; a float is rounded, and an attribute contains all of its digits."""
    if value is None:
        return f"<td{_number_class(index)}>-</td>"
    if isinstance(value, float):
        return f'<td class="number"><data value="{value!r}">{escape(digits(value))}</data></td>'
    is_number = isinstance(value, int)
    return (
        f"<td{' class=' + chr(34) + 'number' + chr(34) if is_number else ''}>{escape(printable(value))}</td>"
    )
