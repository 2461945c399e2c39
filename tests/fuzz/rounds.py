"""How a campaign's inputs are shared out among parsers of very different speed."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import Any

Report = dict[str, Any]
SUMS = ("inputs", "kept", "seconds", "findings")
SHORTEST_S = 1.0  # a process takes longer than that to start


def in_rounds(
    weights: Mapping[str, float],
    count: int,
    seconds: float,
    run: Callable[[str, int, float, int], Report],
) -> list[Report]:
    """Return what each parser did in all, when ``count`` inputs are done or no parser has time left.

    In the first round each parser is run for its share of ``count``. What slow parsers leave undone when
    their ``seconds`` are over is shared out in further rounds, by the same weights, among those that did
    their share in less. A parser with findings is not run again.

    Parameters
    ----------
    weights : mapping of str to float
    count : int
    seconds : float
        Of each parser, over all rounds.
    run : callable
        Runs a parser by name for at most so many inputs and seconds and returns its report; its last argument
        is the number of the round, from 0.
    """
    totals: dict[str, Report] = {name: {"parser": name} | dict.fromkeys(SUMS, 0) for name in weights}
    shares, number = _shares(weights, list(weights), count), 0
    while shares:
        going = []
        for name, share in shares.items():
            total = totals[name]
            report = run(name, share, seconds - total["seconds"], number)
            for key in SUMS:
                total[key] += report[key]
            is_early = report["inputs"] >= share and seconds - total["seconds"] > SHORTEST_S
            if is_early and not total["findings"]:
                going.append(name)
        shares = _shares(weights, going, count - sum(total["inputs"] for total in totals.values()))
        number += 1
    return list(totals.values())


def _shares(weights: Mapping[str, float], names: list[str], count: int) -> dict[str, int]:
    """Whole numbers by weight whose sum is ``count``; names without an input are left out."""
    shares, weight = {}, sum(weights[name] for name in names)
    for name in names:
        shares[name] = round(count * weights[name] / weight)
        count, weight = count - shares[name], weight - weights[name]
    return {name: share for name, share in shares.items() if share > 0}
