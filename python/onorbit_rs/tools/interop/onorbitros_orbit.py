"""Converts orbits and fixed poses of OnOrbitROS, given in km and rad with dates as in ``struct tm``."""

from __future__ import annotations

import math
from datetime import datetime, timedelta
from typing import TYPE_CHECKING

from onorbit_rs._core import MU_EARTH
from onorbit_rs.common.numbers import shortest

if TYPE_CHECKING:
    from onorbit_rs.tools.interop.source import Source

MISSPELT = {"semi_major_axix": "semi_major_axis", "rate_argument_Of_perigee": "rate_argument_of_perigee"}
"""Correct names of the keys that files of OnOrbitROS misspell; its node does not read the misspelt keys."""

DEFAULTS = {
    "semi_major_axis": 12000.0,
    "eccentricity": 0.0004003,
    "inclination": math.radians(51.6427),
    "right_ascension_ini": 0.0,
    "argument_of_perigee_ini": 0.0,
    "mean_anomaly_ini": math.radians(60.0),
}
"""Defaults of the OnOrbitROS node, km and rad, for parameters that are missing or text."""

_KEYS = {
    "semi_major_axis": "semi_major_axis",
    "eccentricity": "eccentricity",
    "inclination": "inclination",
    "right_ascension_ini": "raan",
    "argument_of_perigee_ini": "argument_of_periapsis",
    "mean_anomaly_ini": "mean_anomaly",
}
_DATES = ("time_pass_perigee", "time_start")
_DATE_PARTS = ("sec", "min", "hour", "mday", "mon", "year")
_WITHOUT_MEANING = {
    "rate_of_right_ascension": "OnOrbitROS replaces it by its own J2 rate; here the node is constant",
    "rate_argument_of_perigee": "OnOrbitROS replaces it by its own J2 rate; here the perigee is constant",
    "publish_rate": "nothing is published; 'record_every' is the number of steps per row of the trace",
    "period": "it follows from the semi-major axis",
    "time_of_applicability": "OnOrbitROS does not read it",
}
ORBIT_KEYS = (
    *_KEYS, *MISSPELT, *_WITHOUT_MEANING, "angular_velocity", *_DATES,
    *(f"{date}/{part}" for date in _DATES for part in _DATE_PARTS),
)  # fmt: skip
FIXED_KEYS = (
    "pos_x", "pos_y", "pos_z", "orientation_x", "orientation_y", "orientation_z", "orientation_w",
    "publish_rate",
)  # fmt: skip
EARTH_RADIUS = 6378e3


def read_orbit(source: Source) -> None:
    """Convert orbital elements to ``orbit: {kind: kepler}``."""
    source.put(("orbit", "kind"), "kepler", "kind")
    source.comments.pop(("orbit", "kind"))
    given = {MISSPELT.get(key, key): key for key in source.data}
    for wrong, right in MISSPELT.items():
        if wrong in source.data and right in source.data:
            raise source.fail(wrong, f"{right!r} is also given; remove one of the two keys")
    values = {name: _element(source, name, given.get(name)) for name in _KEYS}
    a_m = values["semi_major_axis"] = values["semi_major_axis"] * 1e3
    values["mean_anomaly_ini"] += _since_perigee(source, a_m)
    for name, key in _KEYS.items():
        source.put(("orbit", key), values[name], given.get(name, name))
    for name, why in _WITHOUT_MEANING.items():
        if name in given:
            source.note(given[name], "no meaning", why)
    if "angular_velocity" in given:
        rate, given_rate = math.sqrt(MU_EARTH / a_m**3), source.number("angular_velocity")
        source.note(
            "angular_velocity", "no meaning",
            f"it follows from the semi-major axis: sqrt(mu/a³) = {rate:.6g} rad/s, not {given_rate:.6g}",
        )  # fmt: skip


def _element(source: Source, name: str, key: str | None) -> float:
    """Return an element in the unit of OnOrbitROS; raise an error for values that suggest another unit."""
    default = DEFAULTS[name]
    unit = {"semi_major_axis": "km", "eccentricity": ""}.get(name, "rad")
    if key is None:
        source.note(name, "corrected", f"not given: OnOrbitROS' default, {default:.7g} {unit}".rstrip())
        return default
    value = source.number(key)
    if name == "semi_major_axis" and not (1e3 < value < 1e6):
        raise source.fail(
            key,
            f"{shortest(value)} km is not the semi-major axis of an ellipse around the Earth; give more than "
            "1000 km and less than 1000000 km: OnOrbitROS uses km and supports ellipses only",
        )
    if name == "eccentricity" and not (0.0 <= value < 1.0):
        raise source.fail(
            key, f"{shortest(value)} is not the eccentricity of an ellipse; it must be from 0 to below 1"
        )
    if unit == "rad" and abs(value) > 2.0 * math.pi + 1e-9:
        raise source.fail(
            key,
            f"{shortest(value)} rad is more than one revolution; if the value is in degrees, write "
            f"({shortest(value)}*pi)/180.0",
        )
    what = f"{_KEYS[name]} {value:.9g} {unit}".rstrip()
    if key != name:
        note = f"OnOrbitROS reads {name!r}, so it ignores this line and uses {default:.7g} {unit}"
        source.note(key, "corrected", f"{what}; spelt {name!r}: {note}")
    elif isinstance(source.data[key], str):
        note = f"text for the parameter server of ROS, for which OnOrbitROS uses {default:.7g} {unit}"
        source.note(key, "corrected", f"{what}; computed from {source.data[key]!r}: {note}")
    else:
        source.note(key, "understood", what)
    return value


def _since_perigee(source: Source, a_m: float) -> float:
    """Return ``n (time_start - time_pass_perigee)``, rad, which OnOrbitROS adds to the mean anomaly.

    `n` is the mean motion. Without both dates, the result is 0.
    """
    dates = {name: _date(source, name) for name in _DATES}
    keys = [key for key in source.data if key.split("/")[0] in _DATES]
    start, perigee = dates["time_start"], dates["time_pass_perigee"]
    if start is None or perigee is None:
        for key in keys:
            source.note(
                key, "no meaning", "a date is missing or incomplete: OnOrbitROS would use the wall clock"
            )
        return 0.0
    seconds = (start - perigee).total_seconds()
    shift = math.sqrt(MU_EARTH / a_m**3) * seconds
    for key in keys:
        if seconds:
            source.note(
                key, "understood", f"start - perigee = {seconds:g} s adds {shift:.9g} rad to the mean anomaly"
            )
        else:
            source.note(
                key, "no meaning", "start and perigee are the same date: nothing is added to the mean anomaly"
            )
    return shift


def _date(source: Source, name: str) -> datetime | None:
    """Return a date, read like C's ``struct tm``: months count from 0, and years below 1000 from 1900.

    Returns None if the date is incomplete.
    """
    nested = source.data.get(name)
    parts: dict[str, object] = dict(nested) if isinstance(nested, dict) else {}
    if nested is not None and not isinstance(nested, dict):
        raise source.fail(
            name, f"a date must be a mapping with the keys {', '.join(_DATE_PARTS)}, not {nested!r}"
        )
    parts |= {part: source.data[key] for part in _DATE_PARTS if (key := f"{name}/{part}") in source.data}
    unknown = [part for part in parts if part not in _DATE_PARTS]
    if unknown:
        raise source.fail(
            name, f"{unknown[0]!r} is not part of a date; the parts are {', '.join(_DATE_PARTS)}"
        )
    if not all(part in parts for part in _DATE_PARTS):
        return None
    values = {}
    for part, value in parts.items():
        if isinstance(value, bool) or not isinstance(value, int) or abs(value) > 10**6:
            raise source.fail(name, f"{part} must be an integer from -1000000 to 1000000, not {value!r}")
        values[part] = value
    year = values["year"] + (0 if values["year"] >= 1000 else 1900)  # struct tm counts from 1900
    month = year * 12 + values["mon"]
    try:
        first = datetime(month // 12, month % 12 + 1, 1)
        clock = timedelta(hours=values["hour"], minutes=values["min"], seconds=values["sec"])
        return first + timedelta(days=values["mday"] - 1) + clock
    except (ValueError, OverflowError):
        given = ", ".join(f"{part} {values[part]}" for part in _DATE_PARTS)
        raise source.fail(name, f"the date ({given}) is outside the years 1 to 9999; correct it") from None


def read_fixed_pose(source: Source) -> None:
    """Convert a pose to ``orbit: {kind: fixed_frame}``.

    OnOrbitROS gives the position in km; the quaternion rotates the local frame to the inertial frame. If the
    position is outside the Earth, the Earth's gravity is added, with ``gravity_mode: carried``.
    """
    position = [source.number(f"pos_{axis}", 0.0) * 1e3 for axis in "xyz"]
    names = [f"orientation_{axis}" for axis in "xyzw"]
    quat = [source.number(name, float(name.endswith("w"))) for name in names]
    norm = math.hypot(*quat)
    if abs(norm - 1.0) > 1e-3:
        raise source.fail(
            "orientation_w",
            f"the quaternion has norm {shortest(norm)}; it must be 1 within 1e-3; normalise it",
        )
    source.put(("orbit", "kind"), "fixed_frame", "kind")
    source.put(("orbit", "position"), position, "pos_x")
    source.put(("orbit", "attitude"), {"quaternion_xyzw": [part / norm for part in quat]}, "orientation_w")
    source.comments[("orbit", "kind")] = f"{source.file.name}: a fixed pose"
    source.comments[("orbit", "position")] = "m, from pos_x, pos_y, pos_z in km, the unit of its orbit topic"
    source.comments[("orbit", "attitude")] = "from orientation_x, ..., orientation_w"
    for key in source.data:
        if key == "publish_rate":
            source.note(key, "no meaning", _WITHOUT_MEANING[key])
        else:
            unit = " km, the unit of its orbit topic" if key.startswith("pos_") else ""
            source.note(key, "understood", f"{source.data[key]}{unit}")
    if math.hypot(*position) > EARTH_RADIUS:
        source.put(("orbit", "mu"), MU_EARTH, "mu")
        source.put(("orbit", "gravity_mode"), "carried", "gravity_mode")
        source.comments[("orbit", "mu")] = "gravity of the Earth"
        source.comments[("orbit", "gravity_mode")] = (
            "tidal accelerations only: the robot stays near the pose, as in OnOrbitROS"
        )
