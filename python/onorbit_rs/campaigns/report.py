"""Writes ``report.html`` of a campaign."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import TYPE_CHECKING, Any

import numpy as np

from onorbit_rs import _core
from onorbit_rs.campaigns.results import PERCENTILES, Result, dispersed, percentile_rows, results
from onorbit_rs.campaigns.statistics import (
    CONFIDENCE,
    Sensitivity,
    sensitivities,
    significant_correlation,
    wilson,
)
from onorbit_rs.campaigns.storage import CAMPAIGN, REPORT
from onorbit_rs.common.counting import count
from onorbit_rs.report.campaign_page import HtmlTable, campaign_page
from onorbit_rs.report.template import Picture, Verdict

if TYPE_CHECKING:
    from collections.abc import Callable

    from numpy.typing import NDArray

    from onorbit_rs.campaigns.document import CampaignDocument, Condition
    from onorbit_rs.campaigns.storage import CampaignFolder
    from onorbit_rs.figures import Series

_MOST_RESULTS = 9
"""Largest number of results in the figures."""
_MOST_VALUES = 20
"""Largest number of dispersed values in the figure of the correlations."""
_MOST_CASES = 20
"""Largest number of rows in a table."""
_MOST_PAIRS = 6
"""Largest number of correlations in the figure of the strongest ones."""
_LARGEST_SVG = 600_000


def write_report(
    folder: CampaignFolder,
    document: CampaignDocument,
    columns: dict[str, list[Any]],
    value_names: Sequence[str],
) -> None:
    """Write the report of a campaign from the columns of its table."""
    is_success = np.array(columns["success"], dtype=bool)
    found = results(columns, value_names, list(document.campaign.success))
    values = dispersed(columns, value_names)
    by_key = {one.key: one.values for one in [*values, *found]}
    by_key["success"] = is_success.astype(np.float64)
    shown = found[:_MOST_RESULTS]
    outcomes = [*(["success"] if 0 < is_success.sum() < len(is_success) else []), *(one.key for one in shown)]
    ranked = sensitivities(by_key, [one.key for one in values], outcomes)
    content = campaign_page(
        name=document.name,
        description=document.description,
        verdict=_verdict(columns, is_success),
        numbers=[_percentiles(found, columns["case"]), _sensitivities(ranked, found, len(is_success))],
        cases=[*_failures(columns, is_success, document.campaign.success), _worst(shown, columns["case"])],
        pictures=list(_pictures(shown, values, ranked, outcomes, is_success)),
        campaign=(folder.path / CAMPAIGN).read_text(encoding="utf-8"),
        again=f"onorbit campaign {CAMPAIGN} --out DIR",
        version=str(_core.build_info()["version"]),
    )
    folder.write(REPORT, content.encode())


def _verdict(columns: dict[str, list[Any]], is_success: NDArray[np.bool_]) -> Verdict:
    rate = wilson(int(is_success.sum()), len(is_success))
    status = {name: columns["status"].count(name) for name in dict.fromkeys(sorted(columns["status"]))}
    kind = "passed" if is_success.all() else "warned" if is_success.any() else "failed"
    heading = f"Success in {rate.successes} of {count(rate.cases, 'case', 'cases')}, {rate.fraction:.1%}"
    listed = ", ".join(f"{number} {name}" for name, number in status.items())
    text = (
        f"With {CONFIDENCE:.0%} confidence, the probability of success is between {rate.low:.1%} and "
        f"{rate.high:.1%} (Wilson). Cases: {listed}."
    )
    return Verdict(kind, heading, text)


def _percentiles(found: Sequence[Result], cases: Sequence[int]) -> HtmlTable:
    heads = {0.0: "smallest", 50.0: "median", 100.0: "largest"}
    names = [heads.get(number, f"{number:g} %") for number in PERCENTILES]
    return HtmlTable(
        "Results",
        "Percentiles of every number of the summaries that varies, over the cases that have a value.",
        ["result", "unit", *names, "case of the largest"],
        list(percentile_rows(found, cases)),
    )


def _sensitivities(ranked: Sequence[Sensitivity], found: Sequence[Result], cases: int) -> HtmlTable:
    """Return a table of the strongest correlations that are significant."""
    labels, threshold = {one.key: one.label for one in found}, significant_correlation(cases)
    shown = [one for one in ranked if abs(one.correlation) >= threshold][:_MOST_CASES]
    return HtmlTable(
        "Sensitivities",
        "Spearman's rank correlations of dispersed values and results with a magnitude of at least "
        f"{threshold:.2f}, the strongest first. For independent columns, one in 20 correlations exceeds this "
        "magnitude by chance.",
        ["result", "dispersed value", "rank correlation"],
        [[labels.get(one.result, one.result), one.value, one.correlation] for one in shown],
    )


def _failures(
    columns: dict[str, list[Any]], is_success: NDArray[np.bool_], conditions: dict[str, Condition]
) -> Iterator[HtmlTable]:
    """Yield a table of the cases without success, if there are any."""
    cases = np.flatnonzero(~is_success)
    if len(cases):
        more = f" The first {_MOST_CASES} of {len(cases)} are listed." if len(cases) > _MOST_CASES else ""
        yield HtmlTable(
            "Cases without success",
            f"onorbit campaign {CAMPAIGN} --case K --out DIR runs one of them with figures.{more}",
            ["case", "status", "reason"],
            [
                [str(columns["case"][i]), columns["status"][i], reason(columns, i, conditions)]
                for i in cases[:_MOST_CASES]
            ],
        )


def reason(columns: dict[str, list[Any]], index: int, conditions: dict[str, Condition]) -> str:
    """Return why a case is not a success: its error, failed checks, or conditions that do not hold."""
    if columns["error"][index]:
        return str(columns["error"][index])
    reasons = []
    if not columns["certificate_passed"][index]:
        reasons.append(f"certificate: {columns['certificate_failures'][index]}")
    for name, condition in conditions.items():
        value = columns[name][index] if name in columns else None
        if not condition.holds(value):
            reasons.append(_not_met(name, value))
    return ", ".join(reasons)


def _not_met(name: str, value: Any) -> str:
    """Return the value of a result that does not meet its condition, or that the result has no value."""
    if value is not None:
        return f"{name} is {value:.6g}" if isinstance(value, float) else f"{name} is {value}"
    part, _, event = name.rpartition(".")[0].partition(".")
    return f"event {event!r} did not happen" if part == "events" else f"{name} has no value"


def _worst(shown: Sequence[Result], cases: Sequence[int]) -> HtmlTable:
    """Return a table of the cases with the largest values of each result; ``cases`` are their numbers."""
    rows = []
    for result in shown:
        order = np.argsort(-result.values, kind="stable")  # cases without a value (NaN) are the last
        given = [index for index in order if np.isfinite(result.values[index])][:5]
        rows.append([result.label, ", ".join(str(cases[index]) for index in given)])
    return HtmlTable(
        "Extreme cases",
        "The cases with the largest values of each result, at most five.",
        ["result", "cases"],
        rows,
    )


def _pictures(
    shown: Sequence[Result],
    values: Sequence[Result],
    ranked: Sequence[Sensitivity],
    outcomes: Sequence[str],
    is_success: NDArray[np.bool_],
) -> Iterator[Picture]:
    from onorbit_rs import figures  # imported here because matplotlib takes a second to import

    series = {one.key: figures.Series(one.label, one.unit, one.values) for one in [*shown, *values]}
    if shown:
        about = "Distributions of the results; cases without success are orange."
        yield _picture(
            "results", about, figures.result_distributions([series[one.key] for one in shown], is_success)
        )
    counts = np.cumsum(is_success)
    bounds = [wilson(int(count), number) for number, count in enumerate(counts, 1)]
    about = f"Fraction of successes after each case, with bounds of {CONFIDENCE:.0%} confidence."
    fractions, low, high = (
        np.array([getattr(one, key) for one in bounds]) for key in ("fraction", "low", "high")
    )
    yield _picture("success", about, figures.success_history(fractions, low, high))
    if ranked:
        yield _correlations(ranked, outcomes, series, len(is_success), figures.correlation_map)
        pairs = [one for one in ranked if one.result != "success"][:_MOST_PAIRS]
        if pairs:
            about = "The pairs with the strongest correlations; cases without success are orange."
            shown_pairs = [(series[one.value], series[one.result]) for one in pairs]
            yield _picture("strongest", about, figures.strongest_pairs(shown_pairs, is_success))


def _correlations(
    ranked: Sequence[Sensitivity],
    outcomes: Sequence[str],
    series: dict[str, Series],
    cases: int,
    draw: Callable[..., Any],
) -> Picture:
    rows = list(dict.fromkeys(one.value for one in ranked))[:_MOST_VALUES]
    found = np.full((len(rows), len(outcomes)), np.nan)
    for one in ranked:
        if one.value in rows:
            found[rows.index(one.value), outcomes.index(one.result)] = one.correlation
    labels = [series[key].name if key in series else key for key in outcomes]
    figure = draw(found, rows, labels, significant_correlation(cases))
    about = "Rank correlations of dispersed values (rows) and results; insignificant ones are grey."
    return _picture("sensitivities", about, figure)


def _picture(name: str, about: str, figure: Any) -> Picture:
    from onorbit_rs import figures

    content = figures.as_bytes(figure, "svg")
    if len(content) > _LARGEST_SVG:
        return Picture(name, about, "png", figures.as_bytes(figure, "png"), True)
    return Picture(name, about, "svg", content, True)
