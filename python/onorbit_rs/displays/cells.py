"""HTML tables of plain text, which is escaped."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from html import escape


def rows_html(rows: Iterable[Sequence[str]], heads: Sequence[str] = ()) -> str:
    """Return a table with one row per sequence of texts, below the heads of the columns if there are any."""
    head = f"<tr>{''.join(map(_head, heads))}</tr>" if heads else ""
    body = "".join(f"<tr>{''.join(map(_cell, row))}</tr>" for row in rows)
    return f"<table>{head}{body}</table>"


def _head(text: str) -> str:
    return f'<th style="text-align:left">{escape(text)}</th>'


def _cell(text: str) -> str:
    return f'<td style="text-align:left">{escape(text)}</td>'
