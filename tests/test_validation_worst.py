"""Validation fails on NaN, missing or empty results wherever it takes the largest of several errors."""

from __future__ import annotations

from collections.abc import Callable
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

import onorbit_rs as oo
from onorbit_rs.tools.validation import (
    CASES,
    Verdict,
    against_mujoco,
    against_pinocchio,
    against_sgp4,
    conservation,
    nasa,
    order,
    robots,
    sgp4,
)  # fmt: skip
from onorbit_rs.tools.validation.case import worst
from onorbit_rs.tools.validation.trees import deviation

NAN = float("nan")


def judged(family: str, name: str) -> Verdict:
    (case, *_) = [case for case in CASES if (case.family, case.name) == (family, name)]
    if case.needs:
        pytest.importorskip(case.needs)
    return case.judge()


def now_and_then(call: Callable[..., Any], spoilt: Callable[[Any], Any]) -> Callable[..., Any]:
    """Returns a function like ``call`` of which every second result, from the second on, is spoilt."""
    calls: list[None] = []

    def called(*given: Any, **settings: Any) -> Any:
        calls.append(None)
        found = call(*given, **settings)
        return spoilt(found) if len(calls) % 2 == 0 else found

    return called


def test_the_worst_of_numbers_and_of_rows() -> None:
    assert worst([0.1, 0.3, 0.2]) == 0.3
    assert worst(x for x in (0.1, 0.2)) == 0.2
    assert worst([(1.0, 5.0), (2.0, 4.0)]).tolist() == [2.0, 5.0]
    for numbers in ([0.1, NAN, 0.2], [NAN, 0.1], [0.1, NAN]):
        assert np.isnan(worst(numbers))
    assert np.isnan(worst([(1.0, NAN), (2.0, 4.0)])).tolist() == [False, True]
    for nothing in ([], np.zeros((0, 2))):
        with pytest.raises(ValueError, match="no errors to compare"):
            worst(nothing)


def test_a_deviation_from_zeros_is_zero_or_infinite() -> None:
    assert deviation([0.0, 0.0], [0.0, 0.0]) == 0.0
    assert deviation([0.0, 1e-300], [0.0, 0.0]) == float("inf")
    assert np.isnan(deviation([0.0, NAN], [0.0, 0.0]))
    assert np.isnan(deviation([0.0, 1.0], [NAN, 1.0]))


@pytest.mark.parametrize(("module", "source"), [(against_mujoco, "MuJoCo"), (against_pinocchio, "Pinocchio")])
def test_a_deviation_of_nan_fails(module: Any, source: str, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(module, "deviation", now_and_then(module.deviation, lambda _: NAN))
    for case in CASES:
        if case.source == source:
            pytest.importorskip(case.needs)
            verdict = case.judge()
            assert verdict.passed is False and verdict.note == "", verdict


def test_an_sgp4_state_of_nan_fails(monkeypatch: pytest.MonkeyPatch) -> None:
    made = sgp4.ElementSet.orbit

    def spoilt(elements: sgp4.ElementSet) -> Any:
        state = now_and_then(made(elements).state, lambda found: np.array(found) * NAN)
        return SimpleNamespace(state=state)

    monkeypatch.setattr(sgp4.ElementSet, "orbit", spoilt)
    verdict = judged("engines", f"SGP4: 30 sets, {against_sgp4.TIMES} times each")
    assert verdict.passed is False and verdict.note == "", verdict
    assert [check.passed for check in verdict.checks] == [False, True]


@pytest.mark.parametrize("spoilt", [NAN, 1e-3, None, 3.0])
def test_a_failed_check_of_a_certificate_fails(spoilt: float | None, monkeypatch: pytest.MonkeyPatch) -> None:
    def run(*_: Any, **__: Any) -> Any:
        lines = [("a", 0.1, 1.0, True), ("b", spoilt, 1.0, False), ("c", 0.2, 1.0, True)]
        return SimpleNamespace(trace=SimpleNamespace(certificate=lambda: lines))

    monkeypatch.setattr(oo, "run", run)
    assert robots.certificate("free_tumble")[0] == (3.0 if spoilt == 3.0 else float("inf"))
    assert judged("certificates", "free_tumble").passed is False


@pytest.mark.parametrize("lost", [None, NAN])
def test_a_missing_drift_in_the_certificate_fails(
    lost: float | None, monkeypatch: pytest.MonkeyPatch
) -> None:
    simulation = oo.Simulation

    def simulated(*given: Any, **settings: Any) -> Any:
        trace = simulation(*given, **settings).run(1.0)
        lines = [(name, lost, *rest) for name, _, *rest in trace.certificate()]
        names = ("time", "center_of_mass", "momentum", "kinetic_energy")
        columns = {name: getattr(trace, name) for name in names}
        return SimpleNamespace(run=lambda _: SimpleNamespace(certificate=lambda: lines, **columns))

    monkeypatch.setattr(conservation.oo, "Simulation", simulated)
    verdict = judged("conservation", "100 s of free motion of the humanoid")
    assert [check.passed for check in verdict.checks] == [False, False, True, True], verdict


def test_an_attitude_of_nan_at_one_tolerance_fails(monkeypatch: pytest.MonkeyPatch) -> None:
    spoilt = now_and_then(oo.Model.difference, lambda off: off * NAN)
    monkeypatch.setattr(order.oo.Model, "difference", lambda *given: spoilt(*given), raising=True)
    verdict = judged("order", "Dormand and Prince's pair, tolerances 1e-4 to 1e-9")
    assert verdict.passed is False and verdict.note == "", verdict


@pytest.mark.parametrize(
    ("measure", "table"),
    [
        (lambda: sgp4.of_regime("a day"), "sgp4_sets"),
        (lambda: sgp4.of_regime("dip space"), ""),
        (against_sgp4.every_row, "sgp4_states"),
        (against_sgp4.all_sets, "sgp4_states"),
        (lambda: nasa.errors("8A"), "nasa_states"),
    ],
)
def test_a_table_without_rows_is_rejected(
    measure: Callable[[], Any], table: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    whole = sgp4.table
    for module in (sgp4, nasa):
        monkeypatch.setattr(module, "table", lambda name: [] if name == table else whole(name))
    monkeypatch.setattr(against_sgp4, "published", lambda: [("", np.zeros((1, 7)))] * len(sgp4.sets()))
    with pytest.raises(ValueError, match="no errors to compare"):
        measure()


def test_the_tables_of_sgp4_have_the_sets_that_the_cases_count() -> None:
    sets = sgp4.sets()
    for regime, name in sgp4.REGIMES.items():
        rows = [len(one.rows) for one in sets if one.regime == regime]
        assert name.startswith(f"{len(rows)} ") and set(rows) == {3}, (name, rows)
    assert (len(sets), sum(bool(one.rows) for one in sets)) == (33, 30)
