"""Plots of several systems together: captured frames, contacts, momentum, energy and distances."""

from __future__ import annotations

from collections.abc import Iterator
from typing import TYPE_CHECKING

import numpy as np

from onorbit_rs._core import COLUMNS
from onorbit_rs.common.coordinates import POSITION
from onorbit_rs.common.file_parts import file_part
from onorbit_rs.common.frame_motion import MovingFrame, frame_motion
from onorbit_rs.common.group_momentum import group_momentum, shared_rows
from onorbit_rs.common.pairs import pairs_of
from onorbit_rs.viewer.series import AXES, SUM, Series, fitted_unit

if TYPE_CHECKING:
    from collections.abc import Sequence

    from numpy.typing import NDArray

    from onorbit_rs.scenario.connections import Connection
    from onorbit_rs.viewer.trace_rows import TraceRows
    from onorbit_rs.viewer.world_rows import WorldRows

    Floats = NDArray[np.float64]

CONNECTIONS, CONTACTS = "Connections", "Contacts"
MOMENTUM, ENERGY, PLACES = "Momentum", "Energy", "Positions"

SHARED = "plots/world/"
"""Prefix of the paths of plots of several systems; the name is reserved and cannot be that of a system."""
PLOTS_OF_CONTACTS = f"{SHARED}contacts/"
"""Prefix of the paths of a contact's plots; the result of ``file_part`` for the contact's name follows."""


def world_series(world: WorldRows, *, is_live: bool = False) -> Iterator[tuple[TraceRows, Series]]:
    """Yield every plot of several systems, with the rows that contain its times."""
    for rows, series in _all(world):
        yield rows, series if is_live else fitted_unit(series)


def _all(world: WorldRows) -> Iterator[tuple[TraceRows, Series]]:
    for connection in world.setting.pairs:
        yield from _relative(world, connection)
    for rows in world.systems.values():
        for name, values in rows.contacts.items():
            yield from _contact(rows, name, values)
    for group in world.setting.groups:
        yield from _balance(world, group)
    yield from _places(world)
    yield from _distances(world)


def _relative(world: WorldRows, connection: Connection) -> Iterator[tuple[TraceRows, Series]]:
    """Yield plots of the motion of the captured frame relative to the capturing frame and in its axes."""
    chosen = _shared(world, connection.systems)
    moving = []
    for (system, frame), rows in zip((connection.by, connection.of), chosen, strict=True):
        moving.append(MovingFrame(world.setting.systems[system].model, frame, rows["q"], rows["v"]))
    motion = frame_motion(*moving)
    by, of = connection.frames
    for name, title, unit, values in (
        ("position", f"{of} in axes of {by}: position", "m", motion.position),
        ("attitude", "attitude (rotation vector)", "deg", np.degrees(motion.rotation)),
        ("velocity", "velocity", "m/s", motion.velocity),
        ("rate", "angular velocity", "deg/s", np.degrees(motion.rate)),
    ):
        yield (
            chosen[0],
            Series(CONNECTIONS, f"{SHARED}connections/{connection.name}/{name}", title, unit, AXES, values),
        )


def _contact(rows: TraceRows, name: str, values: Floats) -> Iterator[tuple[TraceRows, Series]]:
    """Yield plots of gap, force, sliding speed and energies of a contact."""
    parts, prefix = COLUMNS["contacts"].parts, f"{PLOTS_OF_CONTACTS}{file_part(name)}"
    for path, title, lines in (
        ("gap", "gap", ("gap",)),
        ("contact_force", "force on the second side", ("force",)),
        ("slip", "sliding speed", ("sliding_speed",)),
        ("energy", "energy", ("elastic", "dissipated")),
    ):
        shown = np.concatenate([values[:, parts[line][0]] for line in lines], axis=1)
        names = AXES if path == "contact_force" else tuple(line.replace("_", " ") for line in lines)
        unit = parts[lines[0]][1]
        yield rows, Series(CONTACTS, f"{prefix}/{path}", f"{name}: {title}", unit, names, shown)


def _balance(world: WorldRows, group: Sequence[str]) -> Iterator[tuple[TraceRows, Series]]:
    """Yield plots of momentum and kinetic energy of each system of a group, and of their sums."""
    chosen = _shared(world, group)
    masses = [world.setting.systems[name].model.mass for name in group]
    momentum = group_momentum(
        [rows["momentum"] for rows in chosen], [rows["center_of_mass"] for rows in chosen], masses
    )
    names, which = (*group, SUM), "" if len(world.setting.groups) == 1 else f"groups/{group[0]}/"
    for part, (entries, unit) in COLUMNS["momentum"].parts.items():
        about = " about the common centre of mass" if part == "angular" else ""
        for axis, values in zip(AXES, np.moveaxis(momentum[:, :, entries], 2, 0), strict=True):
            title = f"{part.capitalize()} momentum {axis}{about}"
            path = f"{SHARED}{which}{part}_momentum_{axis}"
            yield chosen[0], Series(MOMENTUM, path, title, unit, names, _with_sum(values.T))
    energy = np.stack([rows["kinetic_energy"] for rows in chosen], axis=1)
    unit, path = COLUMNS["kinetic_energy"].unit, f"{SHARED}{which}kinetic_energy"
    yield chosen[0], Series(ENERGY, path, "Kinetic energy in W", unit, names, _with_sum(energy))


def _places(world: WorldRows) -> Iterator[tuple[TraceRows, Series]]:
    """Yield plots of the positions of all bases in L, if L is defined."""
    names = world.setting.names
    chosen = _shared(world, names)
    rot_wl = chosen[0].rot_wl
    if rot_wl is None:
        return
    places = np.stack([np.einsum("tji,tj->ti", rot_wl, rows["q"][:, POSITION]) for rows in chosen], axis=1)
    for axis, (name, what) in enumerate((("radial", "x"), ("along_track", "y"), ("cross_track", "z"))):
        title = f"{name.replace('_', ' ').capitalize()} position, {what} of L"
        yield chosen[0], Series(PLACES, f"{SHARED}{name}", title, "m", tuple(names), places[:, :, axis])


def _distances(world: WorldRows) -> Iterator[tuple[TraceRows, Series]]:
    """Yield the plot of the distances between the bases."""
    names = world.setting.names
    chosen = dict(zip(names, _shared(world, names), strict=True))
    pairs = pairs_of(names)
    place = {name: rows["q"][:, POSITION] for name, rows in chosen.items()}
    values = np.stack([np.linalg.norm(place[b] - place[a], axis=1) for a, b in pairs], axis=1)
    labels = tuple(f"{a} - {b}" for a, b in pairs)
    yield (
        chosen[names[0]],
        Series(PLACES, f"{SHARED}distance", "Distance between bases", "m", labels, values),
    )


def _shared(world: WorldRows, names: Sequence[str]) -> list[TraceRows]:
    """Return the rows of these systems at the times common to all of them."""
    rows = [world[name] for name in names]
    return [
        own.at(chosen) for own, chosen in zip(rows, shared_rows([own["time"] for own in rows]), strict=True)
    ]


def _with_sum(values: Floats) -> Floats:
    """Return columns (T, n + 1): the columns of ``values`` (T, n), followed by their sum."""
    return np.column_stack([values, values.sum(axis=1)])
