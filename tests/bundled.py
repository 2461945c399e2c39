"""Names of the bundled scenarios with one robot, and of those with several systems."""

from __future__ import annotations

from onorbit_rs import scenarios

WORLDS = [name for name in scenarios.names() if "\nsystems:" in scenarios.path(name).read_text()]
ONE_ROBOT = [name for name in scenarios.names() if name not in WORLDS]
