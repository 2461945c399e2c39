"""Checks a campaign with its nominal scenario, before any case runs."""

from __future__ import annotations

import warnings
from typing import TYPE_CHECKING, Any

from onorbit_rs.campaigns.cases import summary_of
from onorbit_rs.campaigns.kept_columns import columns_of
from onorbit_rs.campaigns.numbers import EVENT_NUMBERS, numbers_of
from onorbit_rs.campaigns.table import check_conditions
from onorbit_rs.common.suggestions import did_you_mean
from onorbit_rs.common.user_code import announce
from onorbit_rs.exceptions import InputError, SimulationError
from onorbit_rs.scenario import WorldScenario
from onorbit_rs.scenario.build import Built, build
from onorbit_rs.scenario.build_world import BuiltWorld, build_world
from onorbit_rs.scenario.user_code import source_of

if TYPE_CHECKING:
    from onorbit_rs.campaigns.document import Keep
    from onorbit_rs.campaigns.load import LoadedCampaign
    from onorbit_rs.campaigns.plan import Plan


def check_nominal(plan: Plan, loaded: LoadedCampaign) -> None:
    """Build the nominal scenario, and check the names of kept columns and conditions on a run of one step.

    Controllers and effects in Python are inspected but not executed.

    Raises
    ------
    OnOrbitError
        If the scenario cannot be built.
    InputError
        If ``keep.columns`` or ``success`` names a column that the trace or the results do not have.
    """
    scenario, conditions = loaded.scenario, loaded.document.campaign.success
    for part in scenario.user_classes:
        announce(source_of(part, scenario.folder))
    is_world = isinstance(scenario, WorldScenario)
    built = build_world(scenario, runs_code=False) if is_world else build(scenario, runs_code=False)  # type: ignore[arg-type]
    if not plan.keep.columns and not conditions:
        return
    try:
        trace = built.simulation.run(scenario.simulation.time_step)
    except SimulationError:  # reported as the error of every case
        return
    _check_columns(plan.keep, trace)
    if conditions:
        events = scenario.events if isinstance(scenario, WorldScenario) else []
        known = [*plan.value_names, *_names_of_results(trace, built)]
        known += [f"events.{event.name}.{key}" for event in events for key in EVENT_NUMBERS]
        of_events = tuple(f"certificate.{event.name}/" for event in events)
        check_conditions(known, conditions, of_events)


def _check_columns(keep: Keep, trace: Any) -> None:
    known = list(columns_of(trace))
    for name in keep.columns:
        if name not in known:
            hint = did_you_mean(name, known) or "; give the name of an array in trace.npz of a run"
            raise InputError(
                f"campaign.keep.columns: the trace has no column {name!r}{hint}", name="columns", got=name
            )


def _names_of_results(trace: Any, built: Built | BuiltWorld) -> list[str]:
    """Return the names of the numbers of a case, without those of events."""
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")  # events that do not happen within one step
        return list(numbers_of(summary_of(trace, built, "complete")))
