"""Orbits of element sets, propagated with SGP4."""

from __future__ import annotations

from collections.abc import Iterator
from itertools import pairwise
from pathlib import Path
from typing import Annotated, Any, Literal

from pydantic import BeforeValidator, model_validator

from onorbit_rs import _core
from onorbit_rs.common.counting import count
from onorbit_rs.common.input_files import read_text
from onorbit_rs.ephemeris.element_sets import select_set
from onorbit_rs.ephemeris.omm import entries
from onorbit_rs.exceptions import ElementSetError
from onorbit_rs.scenario.errors import invalid
from onorbit_rs.scenario.fields import FilePath
from onorbit_rs.scenario.orbit.gravity_mode import GravityMode
from onorbit_rs.scenario.part import Part

SatelliteName = Annotated[str, BeforeValidator(lambda value: str(value) if type(value) is int else value)]


def _text_of_lines(value: Any) -> Any:
    """Return the value; if it is a list, raise an error that explains how to write two lines in YAML."""
    if isinstance(value, list):
        raise invalid(
            "must be text, not a list; write 'tle: |' followed by the two indented lines, or give 'line1' "
            "and 'line2'"
        )
    return value


class Sgp4Orbit(Part):
    """Element set: a TLE or an OMM, given in the scenario or in a file; time zero is the epoch of the set."""

    kind: Literal["sgp4"] = "sgp4"
    line1: str | None = None
    line2: str | None = None
    tle: Annotated[str, BeforeValidator(_text_of_lines)] | None = None
    """Text of the two lines, optionally after a line with the name of the satellite."""
    tle_file: FilePath | None = None
    omm_file: FilePath | None = None
    """File with a CCSDS Orbit Mean-Elements Message: JSON, XML, CSV or KVN."""
    satellite: SatelliteName | None = None
    """Name or catalogue number of the satellite, if ``tle``, ``tle_file`` or ``omm_file`` has several
    sets."""
    gravity: Literal["wgs72", "wgs72old", "wgs84"] = "wgs72"
    check_checksum: bool = True
    propagator: Literal["native", "reference"] = "native"
    """Implementation of SGP4. ``reference`` is the PyPI package ``sgp4``, which verifies the native one."""
    gravity_mode: GravityMode = "true"

    def build(self, folder: Path) -> _core.Sgp4:
        """Return the orbit; relative paths start at ``folder``."""
        if self.omm_file is not None:
            file = folder / self.omm_file
            message = entries(read_text(file, kind="OMM"), self.satellite, where=str(file))
            return _core.Sgp4.from_omm(message, gravity=self.gravity, propagator=self.propagator)
        return _core.Sgp4(
            *self._lines(folder),
            gravity=self.gravity,
            check_checksum=self.check_checksum,
            propagator=self.propagator,
        )

    def _lines(self, folder: Path) -> tuple[str, str]:
        if self.tle_file is not None:
            file = folder / self.tle_file
            return two_lines(read_text(file, kind="TLE"), str(file), self.satellite)
        if self.tle is not None:
            return two_lines(self.tle, "tle", self.satellite)
        assert self.line1 is not None and self.line2 is not None  # validated below
        return self.line1, self.line2

    @model_validator(mode="after")
    def _is_one_set(self) -> Sgp4Orbit:
        if (self.line1 is None) != (self.line2 is None):
            raise invalid("a TLE has two lines; give both 'line1' and 'line2'")
        names = ("line1", "tle", "tle_file", "omm_file")
        given = [name for name in names if getattr(self, name) is not None]
        if len(given) != 1:
            options = "'line1' and 'line2', 'tle', 'tle_file' or 'omm_file'"
            raise invalid(f"give one element set, as {options}; given: {', '.join(given) or 'none'}")
        if self.satellite is not None and self.line1 is not None:
            raise invalid("'line1' and 'line2' define one satellite; omit 'satellite'")
        return self


def two_lines(text: str, where: str, satellite: str | None = None) -> tuple[str, str]:
    """Return the lines of the only TLE in a text, or of the TLE of ``satellite`` (name or catalogue number).

    A line with a name may precede the two lines; comments (#) and blank lines are skipped.

    Raises
    ------
    ElementSetError
        If the text does not contain exactly one such TLE.
    """
    lines = [line for line in text.splitlines() if line.strip() and not line.startswith("#")]
    if satellite is not None:
        return select_set(_sets(lines), satellite, where)
    if len(lines) == 3:
        lines = lines[1:]
    if len(lines) != 2:
        found = count(len(lines), "line", "lines")
        raise ElementSetError(
            f"{where} contains {found}; give the two lines of one TLE, optionally after a line with a name,"
            " or select one of several TLEs with 'satellite', its name or catalogue number"
        )
    return lines[0], lines[1]


def _sets(lines: list[str]) -> Iterator[tuple[str, str, tuple[str, str]]]:
    """Yield the name (empty if missing), catalogue number and lines of every TLE."""
    name = ""
    for line, after in pairwise([*lines, ""]):
        if line.startswith("1 ") and after.startswith("2 "):
            yield name, line[2:7], (line, after)
        name = "" if line.startswith(("1 ", "2 ")) else line.removeprefix("0 ").strip()
