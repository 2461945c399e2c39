"""Statistics and report of a campaign: bounds, rank correlations, columns, the page."""

from __future__ import annotations

import html
import math
import re
from pathlib import Path
from statistics import NormalDist
from typing import Any

import numpy as np
import pytest
from campaign_files import BODY, campaign_of, spin

import onorbit_rs as oo
from onorbit_rs.campaigns import report
from onorbit_rs.campaigns.document import Condition
from onorbit_rs.campaigns.kept_columns import rows_every
from onorbit_rs.campaigns.numbers import numbers_of
from onorbit_rs.campaigns.report import _worst
from onorbit_rs.campaigns.results import Result, percentile_rows
from onorbit_rs.campaigns.statistics import (
    rank_correlation,
    ranks,
    sensitivities,
    significant_correlation,
    wilson,
)


@pytest.mark.parametrize("successes", [0, 1, 17, 99, 100])
def test_wilson_bounds_are_where_the_score_test_rejects(successes: int) -> None:
    """At a bound `p₀`, the score `(p − p₀) / √(p₀ (1 − p₀) / n)` is the quantile."""
    found = wilson(successes, 100)
    z = NormalDist().inv_cdf(0.975)
    for bound in (found.low, found.high):
        if 0.0 < bound < 1.0:
            score = (found.fraction - bound) / math.sqrt(bound * (1.0 - bound) / 100)
            assert abs(score) == pytest.approx(z, rel=1e-9)
    assert 0.0 <= found.low <= found.fraction <= found.high <= 1.0
    assert (found.low == 0.0) == (successes == 0)


def test_wilson_bounds_cover_the_probability_as_often_as_they_say() -> None:
    n, p, coverage = 100, 0.9, 0.0
    for k in range(n + 1):
        weight = math.comb(n, k) * p**k * (1 - p) ** (n - k)
        coverage += weight * (wilson(k, n).low <= p <= wilson(k, n).high)
    assert 0.92 < coverage < 0.98


def test_rank_correlations_agree_with_scipy() -> None:
    stats = pytest.importorskip("scipy.stats", reason="SciPy is not installed")
    rng = np.random.default_rng(1)
    x = rng.normal(size=60)
    y = np.round(np.exp(x) + rng.normal(size=60), 1)  # with ties
    assert rank_correlation(x, y) == pytest.approx(stats.spearmanr(x, y).statistic, rel=1e-12)
    assert rank_correlation(x, np.exp(3.0 * x)) == pytest.approx(1.0, rel=1e-14)
    assert rank_correlation(x, np.ones(60)) is None
    np.testing.assert_array_equal(ranks(np.array([3.0, 1.0, 3.0])), [2.5, 1.0, 2.5])
    y[3] = math.nan
    assert rank_correlation(x, y) is not None


def test_the_strongest_sensitivity_is_first() -> None:
    x = np.linspace(0.0, 1.0, 30)
    noise = np.random.default_rng(1).normal(size=30)
    found = sensitivities({"a": x, "b": noise, "r": -x}, ["b", "a"], ["r"])
    assert (found[0].value, found[0].result) == ("a", "r")
    assert found[0].correlation == pytest.approx(-1.0)


def test_the_numbers_of_a_world_are_flat() -> None:
    event = {"name": "grasp", "kind": "capture", "time_s": 1.5, "systems": ["a", "b"], "impulse_ns": 2.0}
    touch = event | {"name": "a|b", "kind": "touch_down"}
    summary = {
        "scenario": "s", "status": "complete", "certificate_passed": True, "warnings": "none",
        "events": [event, event | {"time_s": 2.5}, touch],
        "contacts": [{"name": "a|b", "touches": 3, "first_touch_down_s": None}],
        "certificate": [{"name": "a+b/x_rel", "value": 1e-9, "gate": 1e-6, "unit": "1", "passed": True}],
        "systems": {"a": {"base_rotation_max_rad": 0.1, "engine": "native"}},
    }  # fmt: skip
    assert numbers_of(summary) == {
        "certificate_passed": True,
        "events.grasp.count": 2, "events.grasp.time_s": 1.5, "events.grasp.impulse_ns": 2.0,
        "contacts.a|b.touches": 3, "contacts.a|b.first_touch_down_s": None,
        "certificate.a+b/x_rel.value": 1e-9, "certificate.a+b/x_rel.gate": 1e-6,
        "certificate.a+b/x_rel.passed": True,
        "systems.a.base_rotation_max_rad": 0.1,
    }  # fmt: skip


def test_rows_are_chosen_at_the_first_time_after_each_multiple() -> None:
    time = np.arange(11) * 0.1
    assert rows_every(time, 0.25).tolist() == [0, 3, 5, 8, 10]
    assert rows_every(time, None).tolist() == list(range(11))
    assert rows_every(time, 5.0).tolist() == [0, 10]


def test_the_report_shows_success_sensitivities_and_reasons(tmp_path: Path) -> None:
    vary = spin()["campaign"]["vary"]
    vary["simulation.time_step"] = {"set": {"choice": [1e-3, 1e-3, 1e-3, 0.5]}}
    success = {"base_rotation_max_rad": {"at_most": 0.0075}}
    campaign = campaign_of(BODY, vary, 24, success=success) | {"name": "<spin>"}
    table = oo.campaign(campaign, tmp_path)
    page = (tmp_path / "report.html").read_text()
    text = html.unescape(re.sub(r"<[^>]+>", " ", page))
    count = sum(table["success"].to_pylist())
    assert 0 < count < 24
    assert f"Success in {count} of 24 cases" in text
    assert "<spin>" not in page
    assert "&lt;spin&gt;" in page
    assert "time_step 0.5 s exceeds the duration" in text
    assert "base_rotation_max_rad is 0.00" in text
    assert page.count("data:image/") == 4
    assert "http://" not in re.sub(r'src="[^"]*"', "", page), "the page needs no other file"
    strongest = re.search(r"base rotation in W, largest\s+(\S+)\s+(-?0\.\d+)", text.split("Sensitivities")[1])
    assert strongest
    assert strongest[1].startswith("initial.angular_velocity")
    section = text.split("Sensitivities")[1].split("Figures")[0]
    shown = [abs(float(number)) for number in re.findall(r"\s(-?0\.\d{3,})\s", section)]
    assert shown == sorted(shown, reverse=True)
    assert min(shown) >= significant_correlation(24)


def test_extreme_cases_are_named_by_their_numbers_and_have_a_value() -> None:
    result = Result("drift", "drift", "m", np.array([1.0, math.nan, 3.0, -math.inf]))
    assert _worst([result], [10, 11, 12, 13]).rows == [["drift", "12, 10"]]
    assert next(percentile_rows([result], [10, 11, 12, 13]))[-1] == 12


def test_the_bundled_campaign_is_valid() -> None:
    from onorbit_rs.campaigns.bundled import CAMPAIGNS
    from onorbit_rs.campaigns.load import load_campaign
    from onorbit_rs.campaigns.plan import plan_of
    from onorbit_rs.scenario.load import check

    assert CAMPAIGNS.names() == ["capture_campaign"]
    for name in CAMPAIGNS.names():
        plan = plan_of(load_campaign(name))
        check(plan.case(1).scenario, None, {})
        assert len(plan.value_names) == 13


def test_the_reason_of_a_case_without_success_is_a_value_or_the_event_that_did_not_happen() -> None:
    conditions = {name: Condition(at_most=1.0) for name in ("events.grasp.time_s", "energy_j", "angle_rad")}
    columns: dict[str, list[Any]] = {
        "error": [None], "certificate_passed": [True], "events.grasp.time_s": [None], "energy_j": [None],
        "angle_rad": [2.5],
    }  # fmt: skip
    words = "event 'grasp' did not happen, energy_j has no value, angle_rad is 2.5"
    assert report.reason(columns, 0, conditions) == words
    assert report.reason(columns | {"angle_rad": [0.5]}, 0, conditions) == words.rpartition(", ")[0]
