"""Replaces characters missing from the viewer's font, which crash the viewer, with escape codes."""

from __future__ import annotations

import re

from onorbit_rs.common.printable import printable

_LACKING = re.compile(
    "[^\x20-\x7e\xa0-\u0148\u014a-\u01c3\u01c5-\u024f\u0300-\u031e\u0384-\u038a\u038c\u038e-\u03a1\u03a3-\u03e1"
    "\u03f0-\u049d\u04a0-\u04ff\u1e00-\u1eff\u2010-\u2027\u2030-\u205e\u2070\u2074-\u208e\u2090-\u209c\u20a0-\u20bf"
    "\u2190-\u2199\u2202\u2205\u2206\u220f\u2211\u2212\u221a\u221e\u222b\u2248\u2260\u2264\u2265\u2713\u2717]"
)
"""Characters missing from Inter, the viewer's font: all but Latin, Greek, Cyrillic and symbols."""


def shown(text: str) -> str:
    r"""Return the text on one line, with missing characters escaped; different texts stay different.

    >>> shown("ω of 腕")
    'ω of \\u8155'
    """
    return _LACKING.sub(_code, printable(text))


def shown_lines(text: str) -> str:
    """Return the text with each of its lines converted by :func:`shown`."""
    return "\n".join(shown(line) for line in text.split("\n"))


def _code(letter: re.Match[str]) -> str:
    return letter[0].encode("unicode_escape").decode("ascii")
