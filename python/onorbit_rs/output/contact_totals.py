"""Totals of the contacts of a run, for its summary."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from onorbit_rs.common.blocks import largest
from onorbit_rs.common.printable import json_value

if TYPE_CHECKING:
    from onorbit_rs._core import WorldTrace
    from onorbit_rs.output.summary import Summary


def contact_totals(trace: WorldTrace) -> list[Summary]:
    """Return an entry for each contact, in the order of the trace.

    ``first_touch_down_s`` is the time of the first touch, or None if there is none, and ``touches`` is the
    number of touches. ``normal_force_max_n`` is the largest normal force, ``impulse_ns`` the magnitude of the
    impulse on the second side, and ``dissipated_j`` the dissipated energy. ``gap_min_m`` is the smallest gap
    of all rows; a negative gap is a depth.
    """
    first: dict[str, float] = {}
    for record in trace.events:
        if record.kind == "touch_down":
            first.setdefault(record.name, record.time)
    found: list[Summary] = []
    for name, contact in trace.contacts.items():
        touches = float(contact.touches[-1])
        numbers = {
            "normal_force_max_n": float(contact.largest_force[-1]),
            "impulse_ns": float(np.linalg.norm(contact.impulse[-1])),
            "dissipated_j": float(contact.dissipated[-1]),
            "gap_min_m": -float(largest(np.negative, contact.gap)),
        }
        entry: Summary = {"name": name, "first_touch_down_s": first.get(name), "touches": int(touches)}
        found.append(entry | {key: json_value(value) for key, value in numbers.items()})
    return found
