"""Plan of a campaign: everything that a worker needs to run any of its cases."""

from __future__ import annotations

import copy
import json
from collections.abc import Iterator
from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING, Any, NamedTuple

from onorbit_rs import _core
from onorbit_rs.campaigns.dispersions import Dispersion, put
from onorbit_rs.campaigns.document import Keep
from onorbit_rs.campaigns.draws import Sampling, check_sampling, unit_draw
from onorbit_rs.campaigns.expand import Expander
from onorbit_rs.engines import versions
from onorbit_rs.output import scenario_digest, with_absolute_paths

if TYPE_CHECKING:
    from onorbit_rs.campaigns.load import LoadedCampaign
    from onorbit_rs.scenario.load import AnyScenario


class CaseData(NamedTuple):
    """Scenario of a case as plain data, and its dispersed values by name."""

    scenario: dict[str, Any]
    values: dict[str, Any]


@dataclass(frozen=True)
class Plan:
    """A campaign whose paths are resolved; it can be pickled."""

    name: str
    scenario: dict[str, Any]
    """Resolved nominal scenario: SI, all defaults, absolute paths."""
    dispersions: tuple[Dispersion, ...]
    cases: int
    seed: int
    sampling: Sampling
    keep: Keep
    software: str
    """Version and instruction set of the engine with which the campaign was started."""
    needs_processes: bool
    """True if Python code runs in every step, so that threads would not run in parallel."""

    @cached_property
    def value_names(self) -> list[str]:
        """Names of the dispersed values."""
        return [name for dispersion in self.dispersions for name in dispersion.names]

    def case(self, number: int) -> CaseData:
        """Return the scenario and the values of a case, which depend only on the campaign and ``number``."""
        data = copy.deepcopy(self.scenario)
        values: dict[str, Any] = {}
        draws = self._draws(number)
        for dispersion in self.dispersions:
            us = [next(draws) for _ in range(dispersion.draws)]
            values |= zip(dispersion.names, dispersion.apply(data, us), strict=True)
        return CaseData(data, values)

    def _draws(self, case: int) -> Iterator[float]:
        names = (name for dispersion in self.dispersions for name in dispersion.draw_names)
        for dimension, name in enumerate(names):
            yield unit_draw(self.sampling, self.seed, self.cases, case, name, dimension)


def plan_of(loaded: LoadedCampaign) -> Plan:
    """Return the plan of a campaign, with its defaults and the paths in ``vary`` resolved.

    Raises
    ------
    ScenarioError
        If a path of ``vary`` names no entry, an entry is varied twice, or a change does not fit its entry.
    InputError
        If the sampling requires SciPy, which is missing, or has fewer dimensions than a case has random
        numbers.
    """
    document, scenario = loaded
    campaign = document.campaign
    expander = Expander(scenario, document.file, document.lines)
    found = tuple(expander.expand(campaign.vary))
    check_sampling(campaign.sampling, sum(dispersion.draws for dispersion in found))
    data = json.loads(json.dumps(with_absolute_paths(scenario)))
    for dispersion in found:
        _complete_joints(data, dispersion, expander)
    return Plan(
        document.name, data, found, campaign.cases, campaign.seed, campaign.sampling, campaign.keep,
        software(), _needs_processes(scenario),
    )  # fmt: skip


def _complete_joints(data: dict[str, Any], dispersion: Dispersion, expander: Expander) -> None:
    """Write the joint values of an initial state by name, so that single joints can be changed."""
    for end in range(len(dispersion.at)):
        if dispersion.at[end] in ("joints", "joint_rates") and dispersion.at[:end][-1:] == ("initial",):
            at = dispersion.at[: end + 1]
            put(data, at, dict(expander.places.find(".".join(map(str, at)))[0].value))


def software() -> str:
    """Return the version and the instruction set of the engine, on which the bits of results depend."""
    info = _core.build_info()
    return f"onorbit_rs {info['version']}, {info['instruction_set']}"


def digest_of(plan: Plan) -> str:
    """Return a digest of everything that determines the results of the cases of a campaign.

    It depends on the number of cases unless ``sampling`` is ``random``.
    """
    sampling = plan.sampling if plan.sampling == "random" else f"{plan.sampling} of {plan.cases}"
    content = {
        "scenario": plan.scenario, "seed": plan.seed, "sampling": sampling,
        "vary": [repr(dispersion) for dispersion in plan.dispersions],
        "keep": plan.keep.model_dump(mode="json", exclude={"failures"}),
        "engine": versions(plan.scenario.get("engine", "native")), "software": plan.software,
    }  # fmt: skip
    return scenario_digest(content)


def _needs_processes(scenario: AnyScenario) -> bool:
    return bool(scenario.user_classes) or scenario.engine != "native"
