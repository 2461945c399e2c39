"""Entries of a command log, to which messages on the command topics are converted."""

from __future__ import annotations

from typing import Any

Entry = dict[str, Any]
"""A command as in a command file, without its time."""


class RefusedError(ValueError):
    """Raised for a message that cannot be executed; the text of the error is the reason."""
