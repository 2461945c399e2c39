"""Memory and disk space that the rows of a run require, estimated before the run."""

from __future__ import annotations

import math
import os
import shutil
from pathlib import Path
from typing import TYPE_CHECKING

from onorbit_rs.common.user_warnings import warn_user
from onorbit_rs.exceptions import InputError, OutputFolderError
from onorbit_rs.output.columns import row_shape
from onorbit_rs.scenario.build_world import BuiltWorld
from onorbit_rs.scenario.targets import task_references

if TYPE_CHECKING:
    from onorbit_rs.scenario.build import Built

BASE, PER_ROWS, PER_RECORDED = 0.25e9, 2.2, 1.5
"""Memory of a run that writes a folder: bytes for the loaded modules, and two factors for the rows.

The factors multiply the size of all rows and the size of the rows in the recording. The values were measured
with runs of 8e4 to 4e6 rows.
"""

BASE_ALONE, PER_ROWS_ALONE = 0.12e9, 1.1
"""The corresponding bytes and factor for all rows of a run without a folder, which has no recording."""

LARGE = 1e9
"""Size of the rows in memory, bytes, above which a warning states the size."""

FITTING = 60e6
"""Size of the rows, bytes, above which a run with a folder writes them while it is computed.

Messages suggest a value of ``record_every`` that gives this size: a run with these rows in memory needs less
than 500 MB.
"""

COMPRESSED, COMPRESSION_RATE = 0.7, 60e6
"""Size of compressed rows relative to their size in memory, and how many bytes are compressed per second."""

_ALWAYS = (
    "time", "q", "v", "tau", "acceleration", "momentum", "impulse", "kinetic_energy", "work", "dissipated",
    "center_of_mass",
)  # fmt: skip
_WITH_TOOL = ("tool_pose",)
_WITH_REFERENCE = ("reference_pose", "position_error", "attitude_error")
_WITH_ORBIT = ("position_eci", "velocity_eci", "reference_position_eci", "reference_velocity_eci")
_OF_A_LOOP, _OF_A_CONTACT = 11, 19


def rows_of(built: Built | BuiltWorld) -> int:
    """Return the number of rows of a run per system, without those of events."""
    settings = built.scenario.simulation
    return math.ceil(settings.steps / settings.record_every) + 1


def estimated_bytes(built: Built | BuiltWorld) -> float:
    """Return the approximate size of the rows of a run, bytes, without recorded wrenches."""
    systems = list(built.systems.values()) if isinstance(built, BuiltWorld) else [built]
    contacts = len(built.scenario.contacts) if isinstance(built, BuiltWorld) else 0
    return 8.0 * rows_of(built) * (sum(map(_numbers_per_row, systems)) + _OF_A_CONTACT * contacts)


def estimated_memory(built: Built | BuiltWorld, *, has_folder: bool) -> float:
    """Return the approximate memory of a run, bytes."""
    size, rows = estimated_bytes(built), rows_of(built)
    if not has_folder:
        return BASE_ALONE + PER_ROWS_ALONE * size
    from onorbit_rs.viewer.recording import MOST_STEPS  # imports rerun, which such a run needs anyway

    return BASE + size * (PER_ROWS + PER_RECORDED * min(1.0, MOST_STEPS / rows))


def is_streamed(built: Built | BuiltWorld, *, has_folder: bool, is_viewed: bool) -> bool:
    """Return True if the rows of a run are written to its folder while the run is computed."""
    return has_folder and not is_viewed and estimated_bytes(built) > FITTING


def check_size(
    built: Built | BuiltWorld, folder: Path | None, *, is_viewed: bool = False, compress: bool = False
) -> None:
    """Check that the disk of ``folder`` and the memory have enough space for the rows of a run.

    The memory is checked only if the run keeps its rows in memory. A warning is issued if rows in memory need
    more than 1 GB, or if rows in a file that is not compressed do.

    Raises
    ------
    InputError, OutputFolderError
        If the rows do not fit into the memory or on the disk; the message has a value of ``record_every``
        with which they fit.
    """
    size = estimated_bytes(built)
    if size <= FITTING:
        return
    if folder is not None:
        _check_disk(built, folder, size, compress)
    if is_streamed(built, has_folder=folder is not None, is_viewed=is_viewed):
        if size > LARGE and not compress:
            warn_user(_large_file(built, size))
        return
    needed = estimated_memory(built, has_folder=folder is not None)
    every = _rounded_up(built.scenario.simulation.record_every * size / FITTING)
    what = f"the run records {rows_of(built)} rows, about {_text(size)}"
    other = "do not view the run"
    if folder is None:
        to_disk = "give the run a folder (--out DIR, or out=), to which it writes its rows"
        other = f"{to_disk}, and {other}" if is_viewed else to_disk
    fix = f"{other}, or set simulation.record_every to {every}, which needs less than 500 MB of memory"
    free = _available_memory()
    if free is not None and needed > free:
        raise _too_large(f"{what}, and needs about {_text(needed)} of memory, but {_text(free)} is "
                         f"available; {fix}", built, every)  # fmt: skip
    if size > LARGE:
        warn_user(f"{what}, and needs about {_text(needed)} of memory; {fix}")


def _large_file(built: Built | BuiltWorld, size: float) -> str:
    every = _rounded_up(built.scenario.simulation.record_every * size / LARGE)
    return (
        f"the run records {rows_of(built)} rows, and its trace.npz will have about {_text(size)}; to write "
        f"less, compress it to about {_text(COMPRESSED * size)} with --compress (compress=True), which takes "
        f"about {size / COMPRESSION_RATE:.0f} s, or set simulation.record_every to {every}"
    )


def _check_disk(built: Built | BuiltWorld, folder: Path, size: float, compress: bool) -> None:
    """Raise an error if the rows in the checkpoint and in ``trace.npz``, bytes, exceed the free space."""
    space = float(shutil.disk_usage(folder).free)
    needed = size * (1.0 + (COMPRESSED if compress else 1.0))
    if needed > space:
        every = _rounded_up(
            built.scenario.simulation.record_every * max(size / FITTING, 4.0 * size / max(space, 1.0))
        )
        fits = not compress and size * (1.0 + COMPRESSED) <= space
        other = "use --compress (compress=True), " if fits else ""
        raise OutputFolderError(
            f"the run records {rows_of(built)} rows, about {_text(size)}, and needs {_text(needed)} on "
            f"the disk of {folder}, where {_text(space)} is available; delete files to make room, "
            f"{other}or set simulation.record_every to {every}",
            path=str(folder),
        )


def _numbers_per_row(built: Built) -> int:
    """Return how many numbers a row of one system contains."""
    names, scenario, joints = list(_ALWAYS), built.scenario, len(built.model.joints)
    if scenario.tracked_tool is not None:
        names += _WITH_TOOL
        if any(True for _ in task_references(scenario)):
            names += _WITH_REFERENCE
    if built.orbit is not None:
        names += _WITH_ORBIT
    tracked = 6 * len(scenario.controllers or [])
    loops = _OF_A_LOOP * len(built.model.loops)
    return sum(math.prod(row_shape(name, joints)) for name in names) + tracked + loops


def _available_memory() -> float | None:
    """Return the memory, bytes, that programs can use without swapping; None if it is unknown.

    On systems without ``/proc/meminfo``, this is the whole physical memory.
    """
    try:
        lines = Path("/proc/meminfo").read_text(encoding="ascii").splitlines()
        return 1024.0 * next(float(line.split()[1]) for line in lines if line.startswith("MemAvailable:"))
    except (OSError, ValueError, StopIteration):
        pass
    try:
        return float(os.sysconf("SC_PAGE_SIZE")) * float(os.sysconf("SC_PHYS_PAGES"))
    except (AttributeError, ValueError, OSError):  # Windows
        return None


def _too_large(message: str, built: Built | BuiltWorld, every: int) -> InputError:
    return InputError(
        message, name="record_every", got=built.scenario.simulation.record_every, expected=f">= {every}"
    )


def _rounded_up(value: float) -> int:
    """Return the smallest of 1, 2, 5, 10, 20, … that is not below a value."""
    scale = 10 ** math.floor(math.log10(max(value, 1.0)))
    return next(int(step * scale) for step in (1, 2, 5, 10) if step * scale >= value)


def _text(size: float) -> str:
    return f"{size / 1e9:.3g} GB" if size >= 1e9 else f"{size / 1e6:.3g} MB"
