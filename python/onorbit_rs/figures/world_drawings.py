"""Figures that apply to a run with several systems, with their names and captions."""

from __future__ import annotations

from collections.abc import Iterator
from functools import partial
from typing import TYPE_CHECKING

import numpy as np

from onorbit_rs.common.file_parts import numbered_part
from onorbit_rs.common.rotations import has_local_frame
from onorbit_rs.figures.captured_motion import captured_motion
from onorbit_rs.figures.contact_energy import contact_energy
from onorbit_rs.figures.contact_history import contact_history
from onorbit_rs.figures.contact_overview import contact_overview
from onorbit_rs.figures.drawings import Drawing
from onorbit_rs.figures.event_marks import of_systems
from onorbit_rs.figures.shared_balance import energy_exchange, momentum_exchange
from onorbit_rs.figures.world_motion import formation_motion, is_apart
from onorbit_rs.scenario.connections import connected_groups

if TYPE_CHECKING:
    from onorbit_rs.figures.world_subject import WorldSubject

PREFIX = "world_"
"""Prefix of the names of these figures; ``world`` is reserved and cannot be the name of a system."""


def world_drawings(subject: WorldSubject) -> Iterator[Drawing]:
    """Yield every figure that applies to a run and shows several systems together."""
    trace, models, events = subject.trace, subject.models, subject.events
    drawn = set()
    for connection in subject.connections:
        if connection.frames in drawn or not set(connection.systems) <= set(models):
            continue
        drawn.add(connection.frames)
        by, of = connection.frames
        about = (
            f"Motion of {of} relative to {by}, in axes of {by}; the attitude is a rotation vector. "
            "Solid vertical lines are captures; dashed vertical lines are releases."
        )
        draw = partial(captured_motion, trace, models, connection, events)
        yield Drawing(f"{PREFIX}capture_{connection.name}", about, draw)
    yield from _of_contacts(subject)
    groups = connected_groups(list(trace.names), subject.connections, subject.touching)
    for group in groups:
        which = "" if len(groups) == 1 else f"_{group[0]}"
        if set(group) <= set(models):
            about = (
                f"Momentum of {' and '.join(group)} in W, angular momentum about the common centre of mass; "
                "only external forces change the sum."
            )
            draw = partial(momentum_exchange, trace, models, group, events)
            yield Drawing(f"{PREFIX}momentum{which}", about, draw)
        lost = ", and the energy lost in events" if of_systems(events, group) else ""
        about = f"Kinetic energy of {' and '.join(group)} in W{lost}."
        yield Drawing(f"{PREFIX}energy{which}", about, partial(energy_exchange, trace, group, events))
        if any(trace[name].contacts for name in group):
            about = (
                f"Energy of {' and '.join(group)}: kinetic energy in W, and elastic and dissipated energy of "
                "the contacts. The sum, less the work of motors and environment, is constant. A "
                "second panel, if any, shows the changes during the touch with the largest elastic energy."
            )
            yield Drawing(f"{PREFIX}ledger{which}", about, partial(contact_energy, trace, group, events))
    if all(has_local_frame(trace[name]) for name in trace.names) and is_apart(trace, models):
        about = (
            "Paths relative to the reference orbit in L, seen along the orbit normal and from above, and the "
            "distances between the bases."
        )
        yield Drawing(f"{PREFIX}motion", about, partial(formation_motion, trace, events))


def _of_contacts(subject: WorldSubject) -> Iterator[Drawing]:
    """Yield the figures of contacts: all of them over the whole run, and each while its sides touch."""
    trace = subject.trace
    if not trace.contacts:
        return
    about = (
        "Contacts over the whole run: a bar for each touch, from touch-down to lift-off, and the gap, the "
        "smallest distance of both sides (negative: depth). Beside the bars: number and total duration."
    )
    yield Drawing(f"{PREFIX}contacts", about, partial(contact_overview, trace, subject.events))
    for number, (contact, rows) in enumerate(trace.contacts.items()):
        if not np.any(np.asarray(rows.force) != 0.0):
            continue
        part = numbered_part(number, contact)
        about = (
            f"Contact {contact} from the first touch to the last one: gap (negative: depth), normal force "
            "and friction, sliding speed, and energies."
        )
        yield Drawing(f"{PREFIX}contact_{part}", about, partial(contact_history, trace, contact))
