"""Summary and arrays of a run with several systems."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from onorbit_rs.common.event_kinds import OF_CONTACT
from onorbit_rs.common.printable import json_value
from onorbit_rs.common.user_warnings import warn_user
from onorbit_rs.output.checks import CHECKS
from onorbit_rs.output.contact_totals import contact_totals
from onorbit_rs.output.latches import latch_results
from onorbit_rs.output.pickling import arrays_of
from onorbit_rs.output.saved_world import EVENTS, WORLD_COLUMNS
from onorbit_rs.output.summary import Summary, run_numbers, summarize

if TYPE_CHECKING:
    from onorbit_rs._core import EventRecord, WorldTrace
    from onorbit_rs.scenario.build_world import BuiltWorld
    from onorbit_rs.scenario.events import Event


def summarize_world(trace: WorldTrace, built: BuiltWorld, *, status: str = "complete") -> Summary:
    """Return the summary of a run with several systems.

    ``systems`` contains the summary of each system; ``certificate`` the checks of the events and of the
    groups of systems that events may connect; ``events`` the events that happened; ``contacts`` the totals
    of the contacts; ``latches`` the results of the latches. ``certificate_passed`` is True if no check of a
    system, group or event failed.
    """
    scenario = built.scenario
    systems = {name: summarize(trace[name], alone, status=status) for name, alone in built.systems.items()}
    rows = trace.certificate()
    failed = [name for name, _, _, passed in rows if not passed]
    failed += [f"{name}/{check}" for name, system in systems.items()
               for check in system["certificate_failures"].split(", ") if check]  # fmt: skip
    absent = [f"{name}/{check}" for name, system in systems.items()
              for check in system["certificate_not_evaluated"].split(", ") if check]  # fmt: skip
    messages = [*built.warnings, *(_missed(trace, built) if status == "complete" else ())]
    own = {
        "scenario": scenario.name, "status": status,
        "certificate_passed": not failed, "certificate_failures": ", ".join(failed),
        "certificate_complete": not absent, "certificate_not_evaluated": ", ".join(absent),
    }  # fmt: skip
    summary = {key: json_value(value) for key, value in (own | run_numbers(trace, scenario)).items()}
    return summary | {
        "warnings": "\n".join(messages),
        "certificate": [_check(*row) for row in rows],
        "events": [_event(record) for record in trace.events],
        "contacts": contact_totals(trace),
        "latches": latch_results(trace, built),
        "systems": systems,
    }


def _missed(trace: WorldTrace, built: BuiltWorld) -> list[str]:
    """Issue a warning for each event that did not happen, and return the warnings."""
    happened = {record.name for record in trace.events if record.kind not in OF_CONTACT}
    latches = {latch["name"]: latch for latch in latch_results(trace, built)}
    found = [
        f"event {event.name!r} did not happen before the end of the run; {_reason(event, latches)}"
        for event in built.scenario.events
        if event.name not in happened
    ]
    for message in found:
        warn_user(message)
    return found


def _reason(event: Event, latches: dict[str, Summary]) -> str:
    """Return the reason why an event did not happen."""
    if event.when.latch is None or event.name not in latches:
        return "check its condition 'when'"
    found, (distance, angle) = latches[event.name], event.when.latch.within
    return (
        f"its latch was not met: the smallest distance between the frames was {found['nearest_m']:.3g} m, "
        f"at an angle of {found['nearest_rad']:.3g} rad, where 'within' permits {distance:.3g} m and "
        f"{angle:.3g} rad; correct the approach, or the conditions of the latch"
    )


def _check(name: str, value: float | None, gate: float, passed: bool) -> Summary:
    unit = "relative" if name.endswith("_rel") else CHECKS.get(name.rpartition("/")[2], "")
    return {"name": name, "value": json_value(value), "gate": gate, "unit": unit, "passed": passed}


def _event(record: EventRecord) -> Summary:
    """Return the summary entry of an event: balances, and magnitudes of the impulse on its second system."""
    impulse = np.asarray(record.impulse)
    values: Summary = {
        "name": record.name, "kind": record.kind, "time_s": record.time, "systems": list(record.systems),
        "impulse_ns": float(np.linalg.norm(impulse[:3])),
        "angular_impulse_nms": float(np.linalg.norm(impulse[3:])),
        "energy_lost_j": record.energy_lost,
    }  # fmt: skip
    linear, angular = np.asarray(record.momentum_error).tolist()
    values |= {"linear_momentum_error_rel": linear, "angular_momentum_error_rel": angular}
    if record.peak_force is not None:
        values["peak_force_n"] = record.peak_force
    return {key: value if isinstance(value, list) else json_value(value) for key, value in values.items()}


def world_arrays(trace: WorldTrace) -> dict[str, Any]:
    """Return the columns of a world by path, such as ``time``, ``chaser/q`` and ``events/time``.

    The rows of ``events`` are in the order of the events in the summary, which contains their names.
    """
    arrays = {name: np.asanyarray(getattr(trace, name)) for name in WORLD_COLUMNS}
    for name in trace.names:
        own = trace[name]
        arrays |= {f"{name}/{path}": values for path, values in arrays_of(own).items()}
        if len(own.rereferenced):
            arrays[f"{name}/rereferenced"] = np.asarray(own.rereferenced)
    records = trace.events
    for name, shape in EVENTS.items():
        values = np.array([np.asarray(getattr(record, name)) for record in records], dtype=np.float64)
        arrays[f"events/{name}"] = values.reshape(len(records), *shape)
    return arrays
