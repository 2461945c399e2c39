"""PyPI's ``sgp4``: its ``Satrec`` objects are accepted, and it propagates in place of the engine's SGP4."""

from __future__ import annotations

import re
import subprocess
import sys
from typing import Any

import numpy as np
import pytest
from sgp4.api import WGS72, WGS72OLD, WGS84, Satrec
from sgp4.io import compute_checksum

import onorbit_rs as oo
from onorbit_rs.exceptions import ElementSetError, InputError, Sgp4Error
from onorbit_rs.scenario import load
from onorbit_rs.scenario.build import build
from onorbit_rs.tools.validation.sgp4 import sets

SOUND = [elements for elements in sets() if elements.rows]
LOW = next(elements for elements in SOUND if elements.regime == "near Earth")
LINES = (LOW.line1, LOW.line2)
MODELS: dict[Any, Any] = {"wgs72old": WGS72OLD, "wgs72": WGS72, "wgs84": WGS84}


def test_a_satrec_has_the_elements_of_its_lines_bit_by_bit() -> None:
    for elements in SOUND:
        taken = oo.Sgp4(Satrec.twoline2rv(elements.line1, elements.line2))
        read = elements.orbit()
        assert (taken.satellite, taken.epoch, taken.period) == (read.satellite, read.epoch, read.period)
        for got, want in zip(taken.state([0.0, 600.0]), read.state([0.0, 600.0]), strict=True):
            # both hold the epoch, which matters in deep space, as day of the year to 1e-8 days
            np.testing.assert_allclose(got, want, rtol=1e-12 if float(taken.period) > 13500 else 0.0)


@pytest.mark.parametrize("gravity", MODELS)
def test_a_satrec_states_its_earth_model(gravity: Any) -> None:
    taken = oo.Sgp4(Satrec.twoline2rv(*LINES, MODELS[gravity]))
    np.testing.assert_array_equal(taken.state(9e3)[0], oo.Sgp4(*LINES, gravity=gravity).state(9e3)[0])


def initialized(mode: str = "i", **changes: float) -> Satrec:
    of = {"ecco": 0.01, "argpo": 1.0, "inclo": 0.9, "mo": 2.0, "no_kozai": 0.065, "nodeo": 0.5} | changes
    satrec = Satrec()
    satrec.sgp4init(WGS72, mode, 7, 27000.25, 1e-4, 0.0, 0.0, *of.values())
    return satrec


def test_a_satrec_of_elements_is_copied() -> None:
    satrec = initialized()
    taken = oo.Sgp4(satrec), oo.Sgp4(satrec, propagator="reference")
    _, r, _ = satrec.sgp4_tsince(50.0)
    satrec.sgp4init(WGS72, "i", 8, 27000.25, 1e-4, 0.0, 0.0, 0.2, 1.0, 0.9, 2.0, 0.05, 0.5)
    for orbit in taken:
        np.testing.assert_allclose(orbit.state(3000.0)[0] / 1e3, r, atol=1e-8)
    assert taken[0].epoch == "2023-12-03T06:00:00.000000Z"


def test_a_catalogue_number_too_large_for_a_satrec() -> None:
    message = {
        "EPOCH": "2024-03-01T12:00:00", "MEAN_MOTION": 15.5, "ECCENTRICITY": 0.001, "INCLINATION": 51.6,
        "RA_OF_ASC_NODE": 1, "ARG_OF_PERICENTER": 2, "MEAN_ANOMALY": 3, "BSTAR": 1e-4,
        "NORAD_CAT_ID": 799501234, "CENTER_NAME": "EARTH", "REF_FRAME": "TEME",
        "TIME_SYSTEM": "UTC", "MEAN_ELEMENT_THEORY": "SGP4",
    }  # fmt: skip
    native, reference = oo.Sgp4.from_omm(message), oo.Sgp4.from_omm(message, propagator="reference")
    assert native.satellite == reference.satellite == 799501234
    np.testing.assert_allclose(reference.state(3e3)[0], native.state(3e3)[0], atol=1e-5)


def test_an_invalid_satrec_is_rejected() -> None:
    with pytest.raises(ElementSetError, match=r"AFSPC mode.*propagator='reference'"):
        oo.Sgp4(initialized("a"))
    assert np.isfinite(oo.Sgp4(initialized("a"), propagator="reference").state(0.0)[0]).all()
    with pytest.raises(ElementSetError, match="gravity constants"):
        oo.Sgp4(Satrec())
    with pytest.raises(ElementSetError, match=re.escape("inclination of the element set is")):
        oo.Sgp4(initialized(inclo=4.0))
    with pytest.raises(ElementSetError, match="argpo of the Satrec is nan"):
        oo.Sgp4(initialized(argpo=np.nan))
    with pytest.raises(InputError, match="satrec is of type int; it must be a Satrec"):
        oo.Sgp4(5)
    with pytest.raises(InputError, match="give the two lines of an element set, or only a Satrec"):
        oo.Sgp4(initialized(), gravity="wgs72")  # type: ignore[call-overload]  # it has its own
    with pytest.raises(InputError, match="give the two lines of an element set, or only a Satrec"):
        oo.Sgp4("1 00005U")
    wrong: Any = "own"
    with pytest.raises(InputError, match="'native' and 'reference'"):
        oo.Sgp4(*LINES, propagator=wrong)


def test_the_reference_code_computes_the_states() -> None:
    peer = Satrec.twoline2rv(*LINES)
    orbit = oo.Sgp4(*LINES, propagator="reference")
    times = np.linspace(-8e3, 8e3, 7)
    r, v = orbit.state(times)
    expected = [peer.sgp4_tsince(t / 60.0)[1:] for t in times]
    np.testing.assert_array_equal(r, [1e3 * np.array(position) for position, _ in expected])
    np.testing.assert_array_equal(v, [1e3 * np.array(velocity) for _, velocity in expected])
    assert "from the reference implementation" in orbit.velocity_source


def test_both_propagators_agree_on_every_set_and_another_earth_model_does_not() -> None:
    for elements in SOUND:
        lines, times = (elements.line1, elements.line2), np.linspace(0.0, 60.0 * elements.rows[-1][0], 9)
        try:
            native, reference = (
                oo.Sgp4(*lines, propagator=it).state(times)[0] for it in ("native", "reference")
            )
        except Sgp4Error:
            continue  # decays meanwhile: see below
        # two builds of the same code: 1.4e-7 m observed; another libm may round differently
        assert np.abs(native - reference).max() < 1e-5, elements.line1
        other = oo.Sgp4(*lines, gravity="wgs84").state(times)[0]
        assert np.abs(other - reference).max() > 1.0


def test_errors_of_the_reference_code_keep_their_number() -> None:
    decaying = next(elements for elements in SOUND if elements.line1.startswith("1 28872"))
    orbit = oo.Sgp4(decaying.line1, decaying.line2, propagator="reference")
    with pytest.raises(Sgp4Error, match="decayed") as caught:
        orbit.state(3600.0)
    assert caught.value.code == 6
    refused = oo.Sgp4(
        "1 00005U 58002B   00179.78495062  .00000000  00000-0  00000-0 0  4753",
        "2 00005  74.9975  57.2958 9995805 169.0429  98.0281  1.17548795413667",
        check_checksum=False, propagator="reference",
    )  # fmt: skip
    with pytest.raises(
        Sgp4Error, match="error 4 of the reference implementation at t = 0 s: the semi-latus"
    ) as caught:
        refused.state(0.0)
    assert caught.value.code == 4


def run(**orbit: Any) -> Any:
    body = {"rigid_body": {"mass": 10.0, "inertia": [1.0, 2.0, 2.5]}}
    kind = {"kind": "sgp4", "line1": LINES[0], "line2": LINES[1], "gravity_mode": "carried"}
    times = {"duration": 600.0, "time_step": 10.0}
    scenario = load({"robot": body, "orbit": kind | orbit, "simulation": times})
    return build(scenario).simulation.run(600.0)


def test_a_run_with_either_propagator_ends_at_the_same_position() -> None:
    native, reference, other = run(), run(propagator="reference"), run(gravity="wgs84")
    apart = np.abs(native.position_eci - reference.position_eci).max()
    assert 0.0 < apart < 1e-5  # m: the codes differ
    assert np.abs(other.position_eci - reference.position_eci).max() > 1.0


def test_corrupted_lines_are_rejected() -> None:
    """The engine parses the lines, since the reference code silently accepts each of these faults."""
    line1, line2 = LINES
    assert compute_checksum(line2) == int(line2[68])
    wrong_sum = line2[:68] + str((int(line2[68]) + 1) % 10)
    comma, letter = line2[:11] + "," + line2[12:], line2[:43] + "x" + line2[44:]
    for corrupted in (wrong_sum, comma, letter):
        with pytest.raises(ElementSetError, match="line 2 of the TLE, column"):
            oo.Sgp4(line1, corrupted)
    assert Satrec.twoline2rv(line1, wrong_sum).no_kozai == Satrec.twoline2rv(line1, line2).no_kozai
    assert [Satrec.twoline2rv(line1, line).no_kozai for line in (comma, letter)] == [0.0, 0.0]


def test_the_package_loads_the_reference_code_only_on_request() -> None:
    code = (
        "import sys, onorbit_rs as oo\n"
        f"oo.Sgp4({LINES[0]!r}, {LINES[1]!r}).state(0.0)\n"
        "assert 'sgp4' not in sys.modules\n"
        f"oo.Sgp4({LINES[0]!r}, {LINES[1]!r}, propagator='reference').state(0.0)\n"
        "assert 'sgp4' in sys.modules\n"
    )
    subprocess.run([sys.executable, "-c", code], check=True, timeout=60)
