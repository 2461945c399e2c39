"""Plots of any columns of a run, selected by name, path or wildcard: :func:`onorbit_rs.plot`."""

from __future__ import annotations

from fnmatch import fnmatchcase
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np
from matplotlib.figure import Figure

from onorbit_rs.common.suggestions import did_you_mean
from onorbit_rs.exceptions import InputError, OnOrbitError
from onorbit_rs.figures.style import (
    COLUMN,
    PAGE,
    legend_above,
    legend_height,
    new_figure,
    plot_largest,
    tidy,
    time_unit,
)
from onorbit_rs.output.pickling import arrays_of
from onorbit_rs.tables.labels import Label, Names, flat, labels

if TYPE_CHECKING:
    from collections.abc import Sequence

    from numpy.typing import NDArray

    from onorbit_rs._core import Model, Trace, WorldTrace
    from onorbit_rs.simulation.run import Run
    from onorbit_rs.tables import RecordedRun

    Floats = NDArray[np.float64]

USUAL = ("q/position", "q/joints")
"""Columns that are plotted if none are named, for each system."""
_PANEL = 1.5
_LEGEND = PAGE - 1.6
_MOST_PANELS = 12


class Line(NamedTuple):
    """One recorded number: values (T,), in the unit of the label, at times (T,), s."""

    label: Label
    time: Floats
    values: Floats


def plot(source: Run | RecordedRun | Trace | WorldTrace, *columns: str) -> Figure:
    """Plot columns of a run over time, in one panel per unit.

    Parameters
    ----------
    source : Run, RecordedRun, Trace or WorldTrace
        Result of :func:`onorbit_rs.run` or :func:`onorbit_rs.read_run`, or its trace. A trace alone does not
        contain the names of joints and bodies; the legend then has their numbers.
    *columns : str
        Names of columns, such as ``tau`` (all joints), ``tau/elbow`` and ``q/position/x``, or patterns with
        wildcards, such as ``*_error/*``. In a world, names begin with the system, as in ``chaser/tau``.
        Without names, the base's position in W, m, and the joint positions, rad or m, are plotted.

    Returns
    -------
    matplotlib.figure.Figure
        In a notebook it is shown if it is the last line of a cell; ``figure.savefig(file)`` saves it.

    Raises
    ------
    InputError
        If a name is not text or matches no column (the message suggests names), the columns have more than
        12 different units, or ``source`` has another type.

    Examples
    --------
    >>> import onorbit_rs as oo
    >>> run = oo.run("free_tumble", quiet=True)
    >>> figure = oo.plot(run, "v/angular", "kinetic_energy")
    >>> [axes.get_ylabel() for axes in figure.axes]
    ['v/angular [rad/s]', 'kinetic_energy [J]']
    """
    for column in columns:
        if not isinstance(column, str):
            raise InputError(
                f"each column must be a name, such as 'tau', but {column!r:.40} is of type "
                f"{type(column).__name__}",
                name="columns", got=column, expected="str",
            )  # fmt: skip
    lines = selected(lines_of(source), columns)
    panels: dict[str, list[Line]] = {}
    for line in lines:
        panels.setdefault(line.label.unit, []).append(line)
    if len(panels) > _MOST_PANELS:
        raise InputError(
            f"the columns have {len(panels)} different units, but a figure has at most {_MOST_PANELS} "
            "panels; name fewer columns",
            name="columns", got=len(panels), expected=_MOST_PANELS,
        )  # fmt: skip
    heads = [_common([line.label.name for line in panel]) for panel in panels.values()]
    entries = [[_short(line.label.name, head) for line in panel]
               for head, panel in zip(heads, panels.values(), strict=True)]  # fmt: skip
    heights = [_PANEL + legend_height(names, _LEGEND) for names in entries]
    figure = new_figure(PAGE, max(sum(heights) + 0.4, COLUMN * 0.7))
    grid = figure.subplots(len(panels), 1, sharex=True, squeeze=False)[:, 0]
    scale, clock = time_unit(max((line.time for line in lines), key=lambda time: float(time[-1] - time[0])))
    for axes, (unit, panel), head, names in zip(grid, panels.items(), heads, entries, strict=True):
        _draw(axes, panel, names, scale)
        measure = "" if unit == "1" else f" [{unit}]"
        tidy(
            axes,
            f"time [{clock}]" if axes is grid[-1] else "",
            (head.replace("$", r"\$") or "value") + measure,
        )
        axes.yaxis.set_offset_position("right")  # the legend is on the left
        if len(names) > 1:
            legend_above(axes, _LEGEND)
    return figure


def lines_of(source: Any) -> list[Line]:
    """Return one line per recorded number of a run or a trace."""
    from onorbit_rs.tables import RecordedRun

    if isinstance(source, RecordedRun):
        tables = {system: source.table(system or None) for system in source.systems or [""]}
        return [
            Line(_in_system(label, system), rows[:, 0], rows[:, number])
            for system, (found, rows) in tables.items()
            for number, label in enumerate(found)
            if number
        ]
    trace = getattr(source, "trace", source)
    if not hasattr(trace, "time"):
        raise InputError(
            f"source is of type {type(source).__name__}; give a run, a recorded run or a trace",
            name="source", got=type(source).__name__, expected="Run, RecordedRun, Trace or WorldTrace",
        )  # fmt: skip
    if hasattr(trace, "names"):
        return [line for name in trace.names for line in _of_trace(trace[name], _model(source, name), name)]
    return _of_trace(trace, _model(source, None), "")


def selected(lines: Sequence[Line], columns: Sequence[str]) -> list[Line]:
    """Return the lines that the names select, in the order of the names, each once."""
    found: dict[str, Line] = {}
    for column in columns or USUAL:
        fitting = [line for line in lines if _fits(line.label.name, column, anywhere=not columns)]
        if not fitting and columns:
            known = {head for line in lines for head in _heads(line.label.name)}
            raise InputError(
                f"no column matches {column!r}"
                f"{did_you_mean(column, sorted(known)) or _examples(known)}",
                name="columns", got=column, expected=sorted(known),
            )  # fmt: skip
        found |= {line.label.name: line for line in fitting}
    return list(found.values())


def _of_trace(trace: Any, model: Model | None, system: str) -> list[Line]:
    names = Names() if model is None else Names.of(model)
    arrays, time = arrays_of(trace), np.asarray(trace.time)
    return [
        Line(_in_system(label, system), time, values)
        for path, rows in arrays.items()
        if path != "time" and len(rows) == len(time)
        for label, values in zip(labels(path, rows.shape[1:], names), flat(rows).T, strict=True)
    ]


def _model(source: Any, system: str | None) -> Model | None:
    """Return the robot of a run or of one of its systems; None for a trace or an unreadable robot."""
    try:
        found = getattr(source, "model" if system is None else "models", None)
    except OnOrbitError:
        return None
    return found if system is None or found is None else found[system]


def _in_system(label: Label, system: str) -> Label:
    return Label(f"{system}/{label.name}", label.unit) if system else label


def _fits(name: str, column: str, anywhere: bool = False) -> bool:
    """Return True if ``column`` (a name, the beginning of one, or a pattern) selects the number ``name``."""
    heads = _heads(name)
    return any(head == column or fnmatchcase(head, column) or (anywhere and head.endswith(f"/{column}"))
               for head in heads)  # fmt: skip


def _heads(name: str) -> list[str]:
    """Return the leading parts of a name: ``["q", "q/position", "q/position/x"]`` for ``q/position/x``."""
    parts = name.split("/")
    return ["/".join(parts[: count + 1]) for count in range(len(parts))]


def _common(names: Sequence[str]) -> str:
    """Return the leading parts that all names share; the whole name if there is only one.

    If the names begin with different systems, return the leading parts after the systems.
    """
    shared = _shared(names)
    return shared if shared else _shared([name.partition("/")[2] for name in names])


def _shared(names: Sequence[str]) -> str:
    shared = [head for head in _heads(names[0]) if all(head in _heads(name) for name in names)]
    return shared[-1] if shared else ""


def _examples(known: set[str]) -> str:
    """Return the end of a message, with names of columns as examples."""
    usual = [head for head in sorted(known) if head.rpartition("q/position")[1:] == ("q/position", "")]
    return f"; names are, for example, {' or '.join((usual + sorted(known))[:2])}"


def _short(name: str, head: str) -> str:
    return name.removeprefix(f"{head}/") if head else name


def _draw(axes: Any, panel: Sequence[Line], names: Sequence[str], scale: float) -> None:
    """Draw the lines of a panel, which may have different times if they belong to different systems."""
    time = panel[0].time
    if all(np.array_equal(line.time, time) for line in panel):
        plot_largest(axes, time / scale, np.column_stack([line.values for line in panel]), names)
        return
    for line, name in zip(panel, names, strict=True):
        axes.plot(line.time / scale, line.values, linewidth=1.1, label=name.replace("$", r"\$"))
