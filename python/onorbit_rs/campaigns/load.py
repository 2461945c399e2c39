"""Reads a campaign from a bundled name, a file or a mapping."""

from __future__ import annotations

import os
from collections.abc import Mapping
from pathlib import Path
from typing import Any, NamedTuple

from onorbit_rs.campaigns.bundled import CAMPAIGNS
from onorbit_rs.campaigns.document import Campaign, CampaignDocument
from onorbit_rs.exceptions import DtypeError, NotFoundError
from onorbit_rs.scenario.load import AnyScenario, check
from onorbit_rs.scenario.locations import scenario_error
from onorbit_rs.scenario.yaml_lines import Lines, read_yaml
from onorbit_rs.scenarios import SCENARIOS

_OUTER, _INNER = CampaignDocument.yaml_keys(), Campaign.yaml_keys()


class LoadedCampaign(NamedTuple):
    """A validated campaign and its nominal scenario."""

    document: CampaignDocument
    scenario: AnyScenario


def load_campaign(
    source: str | os.PathLike[str] | Mapping[str, Any], *, cases: int | None = None
) -> LoadedCampaign:
    """Return the validated campaign of a bundled name, a file or a mapping, and its scenario.

    ``cases`` replaces the number of cases of the campaign, unless it is None.

    Raises
    ------
    NotFoundError
        If ``source`` is neither a bundled name nor a file, or is the name of a bundled scenario.
    ReadError
        If the file is not readable.
    DtypeError
        If ``source`` has another type.
    ScenarioError
        If the campaign or its scenario is invalid; the error has the attributes ``file``, ``path`` and
        ``line``.
    """
    if isinstance(source, Mapping):
        return _checked(dict(source), None, {}, cases)
    if not isinstance(source, (str, os.PathLike)):
        kind = type(source).__name__
        raise DtypeError(
            f"{source!s:.60} ({kind}) is not a campaign; give a bundled name, a YAML file or a mapping",
            name="campaign", got=kind, expected="str, path or mapping",
        )  # fmt: skip
    if os.fspath(source) in SCENARIOS.names() and not Path(source).exists():
        raise NotFoundError(
            f"{os.fspath(source)!r} is a scenario, not a campaign; run it with 'onorbit run', or write a "
            f"campaign file: {{campaign: {{scenario: {source}, cases: ..., vary: ...}}}}",
            path=str(source), kind="campaign",
        )  # fmt: skip
    file = CAMPAIGNS.locate(source)
    data, lines = read_yaml(file)
    return _checked(data, file, lines, cases)


def _checked(data: Any, file: Path | None, lines: Lines, cases: int | None) -> LoadedCampaign:
    if not isinstance(data, dict) or "campaign" not in data:
        is_scenario = isinstance(data, dict) and "simulation" in data
        hint = "; to run a scenario, use 'onorbit run'" if is_scenario else ""
        message = f"'campaign' is missing; give {{campaign: {{scenario: ..., cases: ..., vary: ...}}}}{hint}"
        raise scenario_error(message, file, None)
    if misplaced := next((key for key in data if key in _INNER and key not in _OUTER), None):
        message = f"is an entry of 'campaign'; indent it, so that it is campaign.{misplaced}"
        raise scenario_error(message, file, lines.get((misplaced,)), misplaced)
    if cases is not None and isinstance(data["campaign"], dict):
        data = data | {"campaign": data["campaign"] | {"cases": cases}}
    document = CampaignDocument.checked(data, file, lines)
    return LoadedCampaign(document, _scenario(document))


def _scenario(document: CampaignDocument) -> AnyScenario:
    """Return the scenario of a campaign; a relative path starts at the folder of the campaign's file."""
    source, file = document.campaign.scenario, document.file
    if isinstance(source, dict):
        inner = {at[2:]: line for at, line in document.lines.items() if at[:2] == ("campaign", "scenario")}
        return check(source if "name" in source else source | {"name": document.name}, file, inner)
    relative = (file.parent if file is not None else Path()) / source
    try:
        found = relative if relative.is_file() else SCENARIOS.locate(source)
    except NotFoundError as error:
        at = ("campaign", "scenario")
        raise scenario_error(str(error), file, document.lines.get(at), "campaign.scenario") from None
    inner_data, inner_lines = read_yaml(found)
    return check(inner_data, found, inner_lines)
