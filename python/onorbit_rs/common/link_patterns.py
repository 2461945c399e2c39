"""Patterns of links, in which ``*`` stands for any text."""

from __future__ import annotations

import re


def link_pattern(text: str) -> re.Pattern[str]:
    """Return the regular expression of a pattern such as ``chaser/arm*``, where ``*`` matches any text."""
    return re.compile(".*".join(map(re.escape, text.split("*"))), re.DOTALL)
