"""Keeps the cases without success in full: each in ``failures/case_K``, the folder of an ordinary run.

The cases are run again, in processes of this machine, so that figures and recordings need not be kept in
memory, and a case that ends its process does not end the campaign. A folder gets its name when it is
complete; repeating the campaign therefore writes those that are missing.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import yaml

from onorbit_rs.campaigns.on_processes import on_processes
from onorbit_rs.campaigns.progress import campaign_progress
from onorbit_rs.campaigns.report import reason
from onorbit_rs.campaigns.storage import FAILURES, REASON, failure, unfinished_failure
from onorbit_rs.common.files import exists, output_errors, replacing
from onorbit_rs.output.manifest import SCENARIO

if TYPE_CHECKING:
    from pathlib import Path

    from onorbit_rs.campaigns.document import Condition
    from onorbit_rs.campaigns.plan import Plan
    from onorbit_rs.campaigns.storage import CampaignFolder


def write_failures(
    folder: CampaignFolder,
    plan: Plan,
    columns: dict[str, list[Any]],
    conditions: dict[str, Condition],
    workers: int,
    *,
    quiet: bool,
) -> None:
    """Write the folders of the cases without success that do not exist yet.

    Does nothing unless ``failures`` of ``keep`` is ``full``. Each folder contains the reason and the scenario
    and, unless the case failed before its first row or ended its process, the results of the run.

    Raises
    ------
    OutputFolderError
        If the disk is full, or a folder cannot be written; the complete folders are kept.
    """
    if plan.keep.failures != "full":
        return
    reasons = {
        case: reason(columns, index, conditions)
        for index, case in enumerate(columns["case"])
        if not columns["success"][index] and not exists(failure(folder.path, case) / REASON)
    }
    if not reasons:
        return
    with output_errors(folder.path / FAILURES):
        (folder.path / FAILURES).mkdir(exist_ok=True)
    _keep(folder, plan, reasons, workers, quiet=quiet)


def _keep(folder: CampaignFolder, plan: Plan, reasons: dict[int, str], workers: int, *, quiet: bool) -> None:
    """Run the cases with the given reasons again, and complete the folder of each."""
    cases = sorted(reasons)
    progress = campaign_progress("cases without success", len(cases), 0, quiet=quiet)
    with progress as shown, on_processes(plan, cases, workers, keep_in=folder.path) as outcomes:
        for outcome in outcomes:
            text = reasons[outcome.case]
            if outcome.error and outcome.error.partition(":")[0] not in text:
                text += f"\nrun again: {outcome.error}"
            _complete(folder.path, plan, outcome.case, text)
            shown.add(has_error=False)


def _complete(folder: Path, plan: Plan, case: int, text: str) -> None:
    """Add the reason, and the scenario if the run did not begin, and give the folder its name."""
    unfinished, finished = unfinished_failure(folder, case), failure(folder, case)
    with output_errors(unfinished):
        unfinished.mkdir(exist_ok=True)
    if not exists(unfinished / SCENARIO):
        scenario = yaml.safe_dump(plan.case(case).scenario, sort_keys=False, default_flow_style=None)
        with replacing(unfinished / SCENARIO) as file:
            file.write_text(scenario, encoding="utf-8")
    with replacing(unfinished / REASON) as file:
        file.write_text(f"{text}\n", encoding="utf-8")
    with output_errors(finished):
        unfinished.rename(finished)
