"""Figures of a campaign: distributions of results, success rate, and rank correlations."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING, NamedTuple

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.ticker import MaxNLocator

from onorbit_rs.common.display_units import OR, with_prefix
from onorbit_rs.figures.style import (
    COLORS,
    FAINT_INK,
    INK,
    LINE,
    NORMAL,
    PAGE,
    SMALL,
    legend_name,
    new_figure,
    tidy,
)

if TYPE_CHECKING:
    from numpy.typing import NDArray

    Floats = NDArray[np.float64]
    Bools = NDArray[np.bool_]

COLUMNS = 3
_MOST_TICKS = 4
"""Largest number of intervals between the labels of an axis, so that they do not overlap."""
_WITH, _WITHOUT = COLORS[0], COLORS[1]


class Series(NamedTuple):
    """Values of one column of a campaign, (n,), with its label and unit; NaN for missing values."""

    name: str
    unit: str
    values: Floats

    @property
    def label(self) -> str:
        """Label of an axis: the name, and the unit if there is one."""
        name = legend_name(self.name)
        return f"{name} [{self.unit}]" if self.unit else name

    def with_prefix(self) -> Series:
        """Return the series with an SI prefix if its unit accepts one, so that no power of ten is needed."""
        if not self.unit or self.unit in ("deg", "%") or OR in self.unit:
            return self
        factor, unit = with_prefix(float(np.nanmax(np.abs(self.values))), self.unit)
        return self._replace(unit=unit, values=factor * self.values)


def result_distributions(results: Sequence[Series], is_success: Bools) -> Figure:
    """Draw one histogram per result; cases without success are stacked on those with success.

    Parameters
    ----------
    results : sequence of Series
        Values of the results, (n,) each.
    is_success : (n,) array of bool
        Whether each case is a success.
    """
    figure, panels = _grid(len(results))
    scaled = [result.with_prefix() for result in results]
    for number, (axes, result) in enumerate(zip(panels, scaled, strict=True)):
        is_given = np.isfinite(result.values)
        parts = [result.values[is_given & chosen] for chosen in (is_success, ~is_success)]
        bins = min(40, max(5, round(2.0 * np.sqrt(is_given.sum()))))
        axes.hist(parts, bins=bins, stacked=True, color=[_WITH, _WITHOUT], label=["success", "no success"])
        tidy(axes, "", "" if number % COLUMNS else "cases")
        axes.set_title(result.label, loc="left", fontsize=NORMAL, color=INK)
    if not is_success.all():
        figure.legend(
            *panels[0].get_legend_handles_labels(), loc="outside upper left", frameon=False, fontsize=SMALL,
            ncols=2,
        )  # fmt: skip
    return figure


def success_history(fractions: Floats, low: Floats, high: Floats) -> Figure:
    """Draw the fraction of successes after each case, with its confidence bounds.

    Parameters
    ----------
    fractions : (n,) array
        Fraction of successes among the cases up to each case, 0 to 1.
    low, high : (n,) arrays
        Confidence bounds of the success rate, 0 to 1.
    """
    figure = new_figure(PAGE, 2.1)
    axes = figure.subplots()
    cases = np.arange(1, len(fractions) + 1)
    axes.fill_between(cases, 100.0 * low, 100.0 * high, color=_WITH, alpha=0.2, linewidth=0.0)
    axes.plot(cases, 100.0 * fractions, color=_WITH, linewidth=LINE)
    tidy(axes, "cases", "success [%]")
    axes.set_ylim(-2.0, 102.0)
    return figure


def correlation_map(
    correlations: Floats, values: Sequence[str], results: Sequence[str], threshold: float
) -> Figure:
    """Draw a map of rank correlations; those with a magnitude below ``threshold`` are grey.

    Parameters
    ----------
    correlations : (m, n) array
        Rank correlations of m dispersed values (rows) and n results; NaN if undefined.
    values, results : sequences of str
        Labels of the rows and of the columns.
    threshold : float
        Smallest significant magnitude.
    """
    figure = new_figure(PAGE, 1.6 + 0.2 * len(values))
    axes = figure.subplots()
    image = axes.imshow(correlations, cmap="RdBu_r", vmin=-1.0, vmax=1.0, aspect="auto")
    axes.set_xticks(range(len(results)), map(legend_name, results), rotation=30, ha="right", fontsize=SMALL)
    axes.set_yticks(range(len(values)), map(legend_name, values), fontsize=SMALL)
    axes.tick_params(length=0.0, colors=INK)
    for (row, column), number in np.ndenumerate(correlations):
        if np.isfinite(number):
            is_clear = abs(number) >= threshold
            color = ("white" if abs(number) > 0.6 else INK) if is_clear else FAINT_INK
            axes.text(column, row, f"{number:.2f}", ha="center", va="center", fontsize=SMALL, color=color)
    for side in axes.spines.values():
        side.set_visible(False)
    bar = figure.colorbar(image, ax=axes, fraction=0.03, pad=0.01)
    bar.set_label("rank correlation", fontsize=NORMAL, color=INK)
    bar.ax.tick_params(labelsize=SMALL)
    return figure


def strongest_pairs(pairs: Sequence[tuple[Series, Series]], is_success: Bools) -> Figure:
    """Draw results over dispersed values, one panel per pair; cases without success are orange.

    Parameters
    ----------
    pairs : sequence of (Series, Series)
        A dispersed value and a result, (n,) each.
    is_success : (n,) array of bool
        Whether each case is a success.
    """
    figure, panels = _grid(len(pairs))
    scaled = [(value, result.with_prefix()) for value, result in pairs]
    for axes, (value, result) in zip(panels, scaled, strict=True):
        for chosen, color, size in ((is_success, _WITH, 3.0), (~is_success, _WITHOUT, 6.0)):
            axes.scatter(
                value.values[chosen], result.values[chosen], s=size, color=color, linewidths=0.0, alpha=0.7,
                rasterized=len(is_success) > 2000,
            )  # fmt: skip
        tidy(axes, value.label, "")
        axes.set_title(result.label, loc="left", fontsize=NORMAL, color=INK)
        axes.margins(x=0.03)
    return figure


def _grid(count: int) -> tuple[Figure, list[Axes]]:
    """Return a figure with ``count`` panels in three columns."""
    rows = -(-count // COLUMNS)
    figure = new_figure(PAGE, 1.75 * rows)
    panels = figure.subplots(rows, COLUMNS, squeeze=False)
    for axes in panels.flat:
        axes.xaxis.set_major_locator(MaxNLocator(_MOST_TICKS))
    for axes in panels.flat[count:]:
        axes.set_visible(False)
    return figure, list(panels.flat[:count])
