"""Points and forces of contacts in the 3-D views, shown while the contacts act."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np
import rerun as rr

from onorbit_rs._core import COLUMNS
from onorbit_rs.common.display_units import amount, round_up
from onorbit_rs.viewer.font import shown
from onorbit_rs.viewer.frames import FOLLOW, WORLD, put_in
from onorbit_rs.viewer.trace_rows import TIMELINE

if TYPE_CHECKING:
    from collections.abc import Iterator

    from numpy.typing import NDArray

    from onorbit_rs.viewer.viewpoint import Viewpoint
    from onorbit_rs.viewer.world_rows import WorldRows

    Floats = NDArray[np.float64]

HELD_FOR = 0.5
"""Shortest wall-clock time, s, for which a touch is shown when the run is played."""
LONGEST = 0.45
"""Length of the longest arrow, in sizes of the scene."""
COLOR, HELD = (255, 70, 90), (255, 175, 185)
"""Colours of a force that acts, and of the largest force of a touch that has ended."""
CONTACTS = "world/contacts"
"""Path of the entities of the contacts."""
_LEGEND = (-0.45, -0.52)
"""Heights of the two lines of the legend on the screen, from the middle upward, in sizes of the scene."""


@dataclass(frozen=True)
class Marks:
    """Times (k,), s, at which a contact's mark changes, and the mark that is shown from each time on.

    ``is_shown`` (k,) is False where the mark disappears. ``points`` (k, 3), m, and ``forces`` (k, 3), N, are
    in W. ``is_held`` (k,) is True after the end of a touch that was too short to be seen.
    """

    times: Floats
    is_shown: NDArray[np.bool_]
    points: Floats
    forces: Floats
    is_held: NDArray[np.bool_]


def marks_of(time: Floats, force: Floats, point: Floats, center: Floats, held_s: float) -> Marks:
    """Return the marks of a contact.

    After a touch that took less than ``held_s``, its largest force is shown at its point until ``held_s``
    after the touch-down, unless the sides touch again. The point then moves with ``center``.

    Parameters
    ----------
    time : (T,) array, s
        Times of the rows.
    force : (T, 3) array, N
        Force on the second side in W; zero while the sides do not touch.
    point : (T, 3) array, m
        Point in W at which the force acts.
    center : (T, 3) array, m
        Common centre of mass of all systems in W.
    held_s : float
        Shortest time, s, for which a touch is shown.
    """
    acts = np.any(force != 0.0, axis=1)
    points, forces, is_held = point.copy(), force.copy(), np.zeros(len(time), bool)
    begins = np.flatnonzero(acts & ~np.append(False, acts[:-1]))
    ends = np.flatnonzero(~acts & np.append(False, acts[:-1]))  # the first row after each touch
    for number, end in enumerate(ends):
        begin = begins[number]
        until = np.searchsorted(time, time[begin] + held_s)
        after = np.arange(end, min(until, begins[number + 1] if number + 1 < len(begins) else len(time)))
        largest = begin + int(np.argmax(np.einsum("ti,ti->t", force[begin:end], force[begin:end])))
        points[after] = point[largest] + center[after] - center[largest]
        forces[after], is_held[after] = force[largest], True
    is_shown = acts | is_held
    # rows with a mark, and the first one without it; in a live view that may be the first row of an update
    chosen = is_shown | np.append(True, is_shown[:-1])
    return Marks(time[chosen], is_shown[chosen], points[chosen], forces[chosen], is_held[chosen])


@dataclass
class ContactMarks:
    """Sends points and forces of contacts; the scale never decreases, so a run can be sent in parts."""

    recording: rr.RecordingStream
    common: Viewpoint
    alone: dict[str, Viewpoint]
    held_s: float = 0.0
    """Shortest simulated time, s, for which a touch is shown."""
    _scale: float = 0.0

    def send(self, world: WorldRows) -> None:
        """Send the marks of all contacts with one scale, which the legends of the views state."""
        found = dict(_all(world, self.held_s))
        peak = max(float(np.linalg.norm(marks.forces[marks.is_shown], axis=1).max(initial=0.0))
                   for marks in found.values()) if found else 0.0  # fmt: skip
        scale = max(round_up(peak / (LONGEST * self.common.size)), self._scale)
        if scale == 0.0 or not np.isfinite(scale):
            return
        if scale > self._scale:
            self._scale = scale
            start = float(world.all_times["time"][0])
            self._send_legend(world, start, has_held=any(marks.is_held.any() for marks in found.values()))
        for name, marks in found.items():
            self._send(name, marks)

    def _send(self, name: str, marks: Marks) -> None:
        """Send the point and the arrow of a contact, which are absent while the contact is not shown."""
        path, visible = rr.new_entity_path([*CONTACTS.split("/"), shown(name)]), marks.is_shown
        time, lengths = [rr.TimeColumn(TIMELINE, duration=marks.times)], visible.astype(int)
        colors = [HELD if held else COLOR for held in marks.is_held[visible]]
        points, vectors = marks.points[visible], marks.forces[visible] / self._scale
        thin, thick = ([self.common.size / part] * len(points) for part in (160.0, 70.0))
        for part, columns in (
            ("force", rr.Arrows3D.columns(origins=points, vectors=vectors, colors=colors, radii=thin)),
            ("point", rr.Points3D.columns(positions=points, colors=colors, radii=thick)),
        ):
            put_in(self.recording, f"{path}/{part}", WORLD)
            self.recording.send_columns(f"{path}/{part}", time, columns.partition(lengths), strict=True)

    def _send_legend(self, world: WorldRows, start: float, *, has_held: bool) -> None:
        """Send the legends: one in the view of all systems, and one in that of each system that touches."""
        lines = [f"contact forces on the second side: 1 m = {amount(self._scale, 'N')}"]
        if has_held:
            lines.append(f"pale: largest force of a touch shorter than {amount(self.held_s, 's')}")
        views = [("world/lvlh/contacts", FOLLOW, self.common)]
        touching = {system for pair in world.setting.touching for system in pair}
        for name, viewpoint in self.alone.items():
            if name in touching:
                setting = world.setting.systems[name]
                views.append((setting.entity("arrows/contacts"), setting.frame(FOLLOW), viewpoint))
        for path, frame, viewpoint in views:
            put_in(self.recording, path, frame)
            places = [viewpoint.place(0.0, up) for up in _LEGEND[: len(lines)]]
            label = rr.Points3D(
                places, labels=lines, colors=[COLOR, HELD][: len(lines)], radii=[0.0], show_labels=True
            )
            self.recording.set_time(TIMELINE, duration=start)
            self.recording.log(path, label, strict=True)
            self.recording.reset_time()


def _all(world: WorldRows, held_s: float) -> Iterator[tuple[str, Marks]]:
    """Yield the name and the marks of each recorded contact."""
    (force, _), (point, _) = (COLUMNS["contacts"].parts[part] for part in ("force", "point"))
    times = world.all_times["time"]
    for rows in world.systems.values():
        for name, values in rows.contacts.items():
            at = np.searchsorted(times, rows["time"])
            yield name, marks_of(rows["time"], values[:, force], values[:, point], world.center[at], held_s)
