"""Distributes the inputs of a campaign among parsers of very different speed."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import Any

Report = dict[str, Any]
SUMS = ("inputs", "kept", "seconds", "findings")
SHORTEST_S = 1.0  # the start of a process takes longer


def in_rounds(
    weights: Mapping[str, float],
    count: int,
    seconds: float,
    run: Callable[[str, int, float, int], Report],
) -> list[Report]:
    """Runs the parsers until ``count`` inputs are done or their time is over; returns their total reports.

    In the first round, ``count`` is distributed by the weights. Inputs that slow parsers could not process
    in their ``seconds`` are distributed in further rounds among the parsers with time left, by the same
    weights. A parser with findings is not run again.

    Parameters
    ----------
    weights : mapping of str to float
    count : int
    seconds : float
        Time limit of each parser over all rounds.
    run : callable
        Runs a parser by name for at most the given inputs and seconds and returns its report; the last
        argument is the number of the round, from 0.
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
    """Returns integers by weight whose sum is ``count``; names without an input are omitted."""
    shares, weight = {}, sum(weights[name] for name in names)
    for name in names:
        shares[name] = round(count * weights[name] / weight)
        count, weight = count - shares[name], weight - weights[name]
    return {name: share for name, share in shares.items() if share > 0}
