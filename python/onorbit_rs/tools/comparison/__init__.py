"""Compares two runs: the size of their differences, and the time at which they diverge."""

from __future__ import annotations

from onorbit_rs.common.numbers import finite_float
from onorbit_rs.exceptions import CompareError, InputError
from onorbit_rs.tools.comparison.recorded import RecordedWorld, Source, on_the_other_engine, recorded
from onorbit_rs.tools.comparison.robots import Comparison, Difference, compared_robots
from onorbit_rs.tools.comparison.settings import differing_settings
from onorbit_rs.tools.comparison.world import EventDifference, WorldComparison, compared_worlds

__all__ = ["TOLERANCE", "Comparison", "Difference", "EventDifference", "WorldComparison", "compare"]

TOLERANCE = 1e-6
"""Allowed difference, relative to the largest value of a quantity or to 1, whichever is larger."""


def compare(
    a: Source,
    b: Source | None = None,
    *,
    tolerance: float = TOLERANCE,
) -> Comparison | WorldComparison:
    """Compare two runs of the same robot, or of a world with the same systems, row by row.

    Parameters
    ----------
    a, b : str, path, mapping, Scenario or Run
        The output folder of a run, a :class:`onorbit_rs.Run`, or a scenario as accepted by
        :func:`onorbit_rs.run`, which is simulated. Default of ``b``: the scenario of ``a`` on the other
        engine (MuJoCo or the built-in equations of motion).
    tolerance : float
        Runs diverge where a difference exceeds this fraction of the quantity's largest value or of 1 in its
        unit (m, rad, N m), whichever is larger. For inertial positions, the largest distance from the
        reference takes the place of the largest value.

    Returns
    -------
    Comparison or WorldComparison
        Differences at the instants that both runs recorded. If there are too few of these, the second run
        is interpolated, which is stated in ``notes``. With several systems, ``compared["chaser"]`` is the
        :class:`Comparison` of a system, and ``events`` holds the differences of the events.

    Raises
    ------
    CompareError
        If the names of the systems differ, only one run has systems, the robots' joints differ in number,
        name or order, or the runs do not overlap in time.
    InputError
        If the tolerance is not positive and finite.
    DtypeError
        If an argument has an unsupported type, such as a trace.
    OnOrbitError
        As raised by :func:`onorbit_rs.run`, and for folders without a run.
    """
    allowed = finite_float(tolerance)
    if allowed is None or allowed <= 0.0:
        raise InputError(
            f"tolerance is {tolerance!r}; it must be a positive, finite number",
            name="tolerance", got=tolerance,
        )  # fmt: skip
    first = recorded(a)
    second = on_the_other_engine(first) if b is None else recorded(b)
    settings = differing_settings(first.scenario, second.scenario)
    if isinstance(first, RecordedWorld) and isinstance(second, RecordedWorld):
        return compared_worlds(first, second, allowed, settings)
    if isinstance(first, RecordedWorld) or isinstance(second, RecordedWorld):
        world, other = (first, second) if isinstance(first, RecordedWorld) else (second, first)
        names = ", ".join(world.systems) if isinstance(world, RecordedWorld) else ""
        raise CompareError(
            f"{world.name} is a run with 'systems' ({names}), but {other.name} is a run of one robot; "
            "compare two runs with the same systems, or two runs of one robot",
            name="systems", got=1, expected=names,
        )  # fmt: skip
    return compared_robots(first, second, allowed, settings)
