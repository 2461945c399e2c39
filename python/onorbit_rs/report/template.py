"""Fills the HTML template of the report pages with escaped texts, tables and figures."""

from __future__ import annotations

import base64
from collections.abc import Sequence
from dataclasses import dataclass
from html import escape
from pathlib import Path
from string import Template

from onorbit_rs.common.printable import printable

_TEMPLATE = Path(__file__).with_name("page.html")
_TYPES = {"svg": "image/svg+xml", "png": "image/png"}


@dataclass(frozen=True)
class Picture:
    """A drawn figure; ``kind`` is svg or png."""

    name: str
    caption: str
    kind: str
    content: bytes
    is_wide: bool


@dataclass(frozen=True)
class Verdict:
    """Verdict of a page; ``kind`` is passed, warned, failed or neutral."""

    kind: str
    heading: str
    text: str


def filled(
    *,
    name: str,
    what: str,
    description: str,
    verdict: Verdict,
    warnings: Sequence[str],
    numbers: str,
    figures: str,
    cases: str = "",
    source: str,
    text: str,
    again: str,
    version: str,
) -> str:
    """Return a page without references to other files.

    ``numbers``, ``figures`` and ``cases`` are HTML that is placed before, in and after the section with the
    figures; all other texts are escaped. ``what`` is the kind of page, for the title. ``text`` is the YAML
    file, ``source`` the heading above it, and ``again`` the command that runs it again.
    """
    shown = printable(name)
    return Template(_TEMPLATE.read_text(encoding="utf-8")).substitute(
        title=escape(f"{shown}: {what}"),
        name=escape(shown),
        description=escape(description),
        verdict=f'<div class="verdict {verdict.kind}" id="verdict"><strong>{escape(verdict.heading)}</strong>'
        f"<p>{escape(verdict.text)}</p></div>",
        warnings=_warnings(warnings),
        numbers=numbers,
        figures=figures,
        cases=cases,
        source=escape(source),
        text=escape(text),
        again=escape(again),
        version=escape(version),
        footer=escape(f"Written by onorbit_rs {version}."),
    )


def _warnings(texts: Sequence[str]) -> str:
    """Return warnings, such as remarks on omitted parts of the page, as an HTML list."""
    items = "".join(f"<li>{escape(text)}</li>" for text in texts)
    heading = '<div class="verdict warned" id="warnings"><strong>Warnings</strong>'
    return f"{heading}<ul>{items}</ul></div>" if items else ""


def figure_html(picture: Picture) -> str:
    """Return an embedded figure with its caption."""
    content = base64.b64encode(picture.content).decode("ascii")
    name, caption = escape(picture.name), escape(picture.caption)
    kind = ' class="wide"' if picture.is_wide else ""
    source = f"data:{_TYPES[picture.kind]};base64,{content}"
    return (
        f'<figure id="figure-{name}"{kind}><div class="scroll"><img alt="{caption}" src="{source}"></div>'
        f"<figcaption>{caption} <code>{name}</code></figcaption></figure>"
    )
