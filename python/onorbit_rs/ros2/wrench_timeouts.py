"""Timeouts of the wrenches that a node applies on command."""

from __future__ import annotations

import math
from collections.abc import Iterable, Mapping
from numbers import Real
from typing import Any

from onorbit_rs.exceptions import InputError
from onorbit_rs.ros2.entries import Entry


class WrenchTimeouts:
    """Times at which wrenches on links end: the time of the last command plus the timeout."""

    def __init__(self, timeout: float | None) -> None:
        """Begin without wrenches; if ``timeout``, s, is None, they do not end."""
        if timeout is not None and not (isinstance(timeout, Real) and 0.0 < timeout < math.inf):
            raise InputError(
                f"the timeout of wrenches is {timeout!r} s; it must be a positive and finite number",
                name="wrench_timeout", got=timeout, expected="a positive number of seconds",
            )  # fmt: skip
        self._timeout = timeout
        self._ends: dict[tuple[str, str], float] = {}

    def note(self, entries: Iterable[Mapping[str, Any]], t: float) -> None:
        """Start the timeout of each non-zero wrench among the commands given at a simulated time ``t``, s.

        A wrench that is zero ends the timeout of its link.
        """
        for entry in entries:
            if self._timeout is None or "body" not in entry:
                continue
            link = entry["system"], entry["body"]
            self._ends.pop(link, None)
            if any([*entry.get("force", ()), *entry.get("torque", ())]):
                self._ends[link] = t + self._timeout

    @property
    def next(self) -> float:
        """Simulated time, s, at which the first wrench ends; infinite without one."""
        return min(self._ends.values(), default=math.inf)

    def take(self, t: float) -> list[Entry]:
        """Return the commands that end the wrenches whose timeouts are over at a simulated time, s."""
        over = [link for link, end in self._ends.items() if end <= t]
        for link in over:
            del self._ends[link]
        zero = [0.0, 0.0, 0.0]
        return [
            {"system": system, "body": body, "force": zero, "torque": zero, "frame": "body"}
            for system, body in over
        ]
