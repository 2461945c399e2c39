"""Our SGP4 against the reference code, PyPI's ``sgp4``, over the times of every published set."""

from __future__ import annotations

import importlib
from typing import Any

import numpy as np

from onorbit_rs.exceptions import Sgp4Error
from onorbit_rs.validation.case import Case, Gate
from onorbit_rs.validation.sgp4 import ElementSet, sets

TIMES = 60


def compare(elements: ElementSet) -> tuple[float, float]:
    """Largest difference, km and km/s, and how often only one of both refuses or for another reason."""
    api: Any = importlib.import_module("sgp4.api")
    peer, orbit = api.Satrec.twoline2rv(elements.line1, elements.line2), elements.orbit()
    stop = elements.rows[-1][0]
    worst, disagreements = 0.0, 0
    for seconds in 60.0 * np.linspace(-stop, stop + 200.0, TIMES):
        code, r, v = peer.sgp4_tsince(seconds / 60.0)
        try:
            ours = orbit.state(seconds)
        except Sgp4Error as error:
            disagreements += error.code != code
            continue
        disagreements += code != 0
        worst = max(worst, float(np.abs(np.array(ours) / 1e3 - (r, v)).max()))
    return worst, float(disagreements)


def all_sets() -> Any:
    """Over the sets that make sense: the largest difference, and all disagreements."""
    found = np.array([compare(elements) for elements in sets() if elements.rows])
    return found[:, 0].max(), found[:, 1].sum()


CASES = (
    Case(
        "engines", f"SGP4: 30 sets, {TIMES} times each", "PyPI's sgp4, the reference code",
        (Gate("position and velocity", 1e-8, "km, km/s"), Gate("refusals that differ", 0.0)),
        all_sets, needs="sgp4",
    ),
)  # fmt: skip
