"""Writes the motion of a base as CCSDS messages: OEM (orbit) and AEM (attitude), in key-value notation.

Source: CCSDS 502.0-B-3, Orbit Data Messages, 2023, and CCSDS 504.0-B-1, Attitude Data Messages, 2008.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from datetime import UTC, datetime, timedelta
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from onorbit_rs.common.coordinates import QUATERNION
from onorbit_rs.common.files import replacing
from onorbit_rs.exceptions import InputError

if TYPE_CHECKING:
    from onorbit_rs.tables.recorded_run import RecordedRun

_LAST_LEAP_SECOND = datetime(2017, 1, 1)


def write_oem(run: RecordedRun, file: Path, system: str | None = None) -> None:
    """Write an OEM with the position, km, and velocity, km/s, of the base's origin in inertial axes.

    Raises
    ------
    InputError
        If the run has no orbit around the Earth or no epoch, if its epoch is in UTC and a leap second may
        occur during the run, or as for :meth:`RecordedRun.columns`.
    OutputFolderError
        If the file cannot be written.
    """
    start, columns = _start(run, "OEM"), run.columns(system)
    keep = _last_of_each_time(columns["time"])
    states = np.hstack([columns["position_eci"], columns["velocity_eci"]])[keep] / 1e3
    meta = [f"CENTER_NAME = {_center(run)}", f"REF_FRAME = {_axes(run)}"]
    lines = _lines(start, columns["time"][keep], states)
    _write(file, "CCSDS_OEM_VERS = 2.0", _head(run, system), meta, (start, columns["time"]), lines)


def write_aem(run: RecordedRun, file: Path, system: str | None = None) -> None:
    """Write an AEM with the quaternion of the base, from inertial axes to base axes, with the scalar last.

    Raises
    ------
    InputError, OutputFolderError
        As for :func:`write_oem`.
    """
    start, columns = _start(run, "AEM"), run.columns(system)
    keep = _last_of_each_time(columns["time"])
    meta = [f"CENTER_NAME = {_center(run)}", f"REF_FRAME_A = {_axes(run)}", "REF_FRAME_B = SC_BODY_1",
            "ATTITUDE_DIR = A2B"]  # fmt: skip
    more = ["ATTITUDE_TYPE = QUATERNION", "QUATERNION_TYPE = LAST"]
    lines = [
        "DATA_START",
        *_lines(start, columns["time"][keep], columns["q"][keep][:, QUATERNION]),
        "DATA_STOP",
    ]
    _write(file, "CCSDS_AEM_VERS = 1.0", _head(run, system), meta, (start, columns["time"]), lines, more)


def _write(
    file: Path,
    version: str,
    names: Sequence[str],
    meta: Sequence[str],
    span: tuple[tuple[datetime, str], Any],
    lines: Sequence[str],
    more: Sequence[str] = (),
) -> None:
    (epoch, scale), time = span
    created = datetime.now(UTC).strftime("%Y-%m-%dT%H:%M:%S")
    head = [version, f"CREATION_DATE = {created}", "ORIGINATOR = ONORBIT_RS", "", "META_START", *names, *meta,
            f"TIME_SYSTEM = {scale}", f"START_TIME = {_stamp(epoch, time[0])}",
            f"STOP_TIME = {_stamp(epoch, time[-1])}", *more, "META_STOP", ""]  # fmt: skip
    with replacing(file) as temporary:
        temporary.write_text("\n".join([*head, *lines]) + "\n", encoding="ascii", errors="replace")


def _head(run: RecordedRun, system: str | None) -> list[str]:
    name = system or str(run.summary.get("scenario", "robot"))
    return [f"OBJECT_NAME = {name}", f"OBJECT_ID = {name}"]


def _lines(start: tuple[datetime, str], times: Any, rows: Any) -> list[str]:
    stamps = (_stamp(start[0], t) for t in times)
    return [" ".join([stamp, *map(repr, row)]) for stamp, row in zip(stamps, rows.tolist(), strict=True)]


def _stamp(epoch: datetime, t: float) -> str:
    """Return date and time at simulation time ``t``, s, to the nanosecond, in the time scale of the epoch."""
    whole = int(np.floor(t))
    nanoseconds = round((t - whole) * 1e9) + epoch.microsecond * 1000
    second = epoch.replace(microsecond=0) + timedelta(seconds=whole + nanoseconds // 10**9)
    return f"{second:%Y-%m-%dT%H:%M:%S}.{nanoseconds % 10**9:09d}"


def _last_of_each_time(time: Any) -> Any:
    """Return the indices of the last row of each time; at an event there are two rows of the same time."""
    return np.flatnonzero(np.append(np.diff(time) > 0.0, True))


def _start(run: RecordedRun, kind: str) -> tuple[datetime, str]:
    """Return the epoch of the run and its time scale.

    Raises
    ------
    InputError
        If the run has no epoch or no orbit, or the epoch is in UTC and a leap second may occur in the run.
    """
    epoch = run.epoch
    if epoch is None or "inertial_axes" not in (run.parts[0] if run.parts else {}):
        what = "no epoch; add 'epoch: 2024-03-01T12:00:00 UTC'" if epoch is None else "no orbit; add 'orbit'"
        raise InputError(f"the run has {what} to its scenario to write an {kind}", name=kind.lower())
    text, _, scale = epoch.partition(" ")
    start = datetime.fromisoformat(text)
    if scale == "UTC" and _has_leap_second(start, float(run.summary.get("simulated_s") or 0.0)):
        raise InputError(
            f"a leap second may occur during the run, so {kind} lines in UTC are ambiguous; "
            "give the epoch of the scenario in TAI or TT",
            name=kind.lower(), got=epoch,
        )  # fmt: skip
    return start, scale


def _has_leap_second(start: datetime, seconds: float) -> bool:
    """Return True if the run contains the end of a June or December up to 2016, the dates of leap seconds."""
    end = start + timedelta(seconds=seconds)
    return any(start < midnight <= end for midnight in _midnights(start.year, end.year))


def _midnights(first: int, last: int) -> Iterator[datetime]:
    for year in range(first, last + 1):
        for midnight in (datetime(year, 7, 1), datetime(year + 1, 1, 1), datetime(year, 1, 1)):
            if midnight <= _LAST_LEAP_SECOND:
                yield midnight


def _axes(run: RecordedRun) -> str:
    return str(run.parts[0]["inertial_axes"]).upper()


def _center(run: RecordedRun) -> str:
    """Return the name of the planet.

    Raises
    ------
    InputError
        If the planet is not the Earth.
    """
    if not run.is_about_earth:
        raise InputError(
            "OEM and AEM are written only for orbits around the Earth; otherwise, use --csv or --parquet",
            name="orbit",
        )
    return "EARTH"
