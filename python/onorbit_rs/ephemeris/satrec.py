"""Creates and reads ``Satrec`` objects of PyPI's ``sgp4``, which ``propagator="reference"`` uses."""

from __future__ import annotations

import math
from collections.abc import Mapping
from types import SimpleNamespace
from typing import Any

from sgp4 import omm
from sgp4.api import WGS72, WGS72OLD, WGS84, Satrec

from onorbit_rs.exceptions import ElementSetError, InputError

MODELS = {"wgs72old": WGS72OLD, "wgs72": WGS72, "wgs84": WGS84}
_EPOCH_ZERO = 2_433_281.5
"""Julian date from which ``sgp4init`` counts days."""
_UNUSED = {
    "CLASSIFICATION_TYPE": "U", "OBJECT_ID": "", "EPHEMERIS_TYPE": 0, "ELEMENT_SET_NO": 0, "REV_AT_EPOCH": 0,
    "MEAN_MOTION_DOT": 0, "MEAN_MOTION_DDOT": 0,
}  # fmt: skip
"""Keywords that ``sgp4.omm`` requires and SGP4 does not use."""
_NUMBERS = (
    "jdsatepoch", "jdsatepochF", "bstar", "ndot", "nddot", "ecco", "argpo", "inclo", "mo", "no_kozai",
    "nodeo",
)  # fmt: skip
_CONSTANTS = ("radiusearthkm", "mu", "xke", "j2", "j3", "j4")


def of_lines(line1: str, line2: str, gravity: str) -> Satrec:
    """Return the ``Satrec`` of the two lines of a TLE, read by ``sgp4``."""
    return Satrec.twoline2rv(line1, line2, MODELS[gravity])


def of_message(message: Mapping[str, Any], epoch: str, gravity: str) -> Satrec:
    """Return the ``Satrec`` of an OMM, read by ``sgp4``; ``epoch`` is its epoch in ISO format with a Z."""
    satrec = Satrec()
    given = {key: value for key, value in message.items() if key not in _UNUSED}
    # SGP4 does not use the catalogue number, and a Satrec cannot store numbers above 339999
    fixed = {"EPOCH": epoch.rstrip("Z"), "NORAD_CAT_ID": 0}
    omm.initialize(satrec, _UNUSED | given | fixed, MODELS[gravity])
    return satrec


def read(satrec: Any, by_reference: bool) -> tuple[SimpleNamespace, str]:
    """Return copies of the elements and gravity constants of a ``Satrec``, and the name of its Earth model.

    Raises
    ------
    InputError
        If ``satrec`` is not a ``Satrec``.
    ElementSetError
        If a number is not finite, no Earth model has these gravity constants, or the ``Satrec`` is in AFSPC
        mode and ``by_reference`` is False, since only the reference code implements that mode.
    """
    try:
        names = ("satnum", "operationmode", *_NUMBERS, *_CONSTANTS)
        elements = SimpleNamespace(**{name: getattr(satrec, name) for name in names})
    except AttributeError:
        raise InputError(
            f"satrec is of type {type(satrec).__name__}; it must be a Satrec of the Python package sgp4, "
            "created by Satrec.twoline2rv or initialized by sgp4init",
            name="satrec",
        ) from None
    for name in _NUMBERS:
        if not math.isfinite(value := getattr(elements, name)):
            raise ElementSetError(
                f"{name} of the Satrec is {value}, but must be finite; correct the element set",
                name=name,
                got=value,
            )
    if elements.operationmode == "a" and not by_reference:
        raise ElementSetError(
            "the Satrec is in AFSPC mode ('a'), which the engine does not support; initialize it with 'i'"
            " (improved), or give propagator='reference'",
            name="operationmode", got="a",
        )  # fmt: skip
    for name in MODELS:
        known = _known(name)
        if all(getattr(elements, constant) == getattr(known, constant) for constant in _CONSTANTS):
            return elements, name
    raise ElementSetError(
        f"the Satrec's gravity constants (mu {elements.mu} km³/s², radius {elements.radiusearthkm} km, ...)"
        f" are not those of a known Earth model; initialize it with one of {', '.join(MODELS)}",
        name="gravity",
    )  # fmt: skip


def _known(gravity: str) -> Satrec:
    """Return a ``Satrec`` with arbitrary elements, from which the constants of an Earth model are read."""
    satrec = Satrec()
    satrec.sgp4init(MODELS[gravity], "i", 0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.05, 0.0)
    return satrec


def of_elements(elements: SimpleNamespace, gravity: str) -> Satrec:
    """Return a new ``Satrec`` with the elements that :func:`read` returned."""
    satrec = Satrec()
    satrec.sgp4init(
        MODELS[gravity], elements.operationmode, elements.satnum,
        elements.jdsatepoch + elements.jdsatepochF - _EPOCH_ZERO,
        elements.bstar, elements.ndot, elements.nddot, elements.ecco, elements.argpo, elements.inclo,
        elements.mo, elements.no_kozai, elements.nodeo,
    )  # fmt: skip
    return satrec
