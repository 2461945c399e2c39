"""Patterns of links, in which ``*`` stands for any text."""

from __future__ import annotations

import re


def link_pattern(text: str) -> re.Pattern[str]:
    """Return the expression that matches the paths of links that a pattern such as ``chaser/arm*`` means."""
    return re.compile(".*".join(map(re.escape, text.split("*"))), re.DOTALL)
