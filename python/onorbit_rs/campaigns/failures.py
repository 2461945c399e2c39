"""Keeps the cases without success in full: each in ``failures/case_K``, the folder of an ordinary run.

The cases are run again, in processes of this machine, so that figures and recordings need not be kept in
memory, and a case that ends its process does not end the campaign. Repeating the campaign writes the folders
that are missing or incomplete.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import yaml

from onorbit_rs.campaigns.failure_folders import (
    FAILURES,
    REASON,
    failure_folder,
    failure_folders,
    remove_failure,
)
from onorbit_rs.campaigns.on_processes import on_processes
from onorbit_rs.campaigns.progress import campaign_progress
from onorbit_rs.campaigns.report import reason
from onorbit_rs.common.files import exists, output_errors, replacing
from onorbit_rs.output.manifest import SCENARIO

if TYPE_CHECKING:
    from pathlib import Path

    from onorbit_rs.campaigns.document import Condition
    from onorbit_rs.campaigns.plan import Plan
    from onorbit_rs.campaigns.storage import CampaignFolder

_AGAIN = "\nrun again: "


def write_failures(
    folder: CampaignFolder,
    plan: Plan,
    columns: dict[str, list[Any]],
    conditions: dict[str, Condition],
    workers: int,
    *,
    quiet: bool,
) -> None:
    """Write the folders of the cases without success, and remove those of cases that are now successes.

    Does nothing unless ``failures`` of ``keep`` is ``full``. Each folder contains the reason and the scenario
    and, unless the case failed before its first row or ended its process, the results of the run. The figures
    of a case are drawn by several processes, so only half of the workers run cases.

    Raises
    ------
    OutputFolderError
        If the disk is full, or a folder cannot be written; the complete folders are kept.
    """
    if plan.keep.failures != "full":
        return
    campaign = folder.path.resolve()
    reasons = {
        case: reason(columns, index, conditions)
        for index, case in enumerate(columns["case"])
        if not columns["success"][index]
    }
    for case, existing in failure_folders(campaign).items():
        if case not in reasons:
            remove_failure(existing)
        elif exists(existing / REASON):
            _update_reason(existing, reasons.pop(case))
    if reasons:
        with output_errors(campaign / FAILURES):
            (campaign / FAILURES).mkdir(exist_ok=True)
        _keep(campaign, plan, reasons, max(1, workers // 2), quiet=quiet)


def _update_reason(folder: Path, text: str) -> None:
    """Replace a reason that is no longer right, since the conditions of success can be changed."""
    with output_errors(folder / REASON):
        before, again, error = (folder / REASON).read_text(encoding="utf-8").partition(_AGAIN)
    if before.strip() != text:
        _write(folder / REASON, text + again + error)


def _keep(campaign: Path, plan: Plan, reasons: dict[int, str], workers: int, *, quiet: bool) -> None:
    """Run the cases with the given reasons again, and complete the folder of each."""
    cases = sorted(reasons)
    progress = campaign_progress("cases without success", len(cases), 0, quiet=quiet)
    with progress as shown, on_processes(plan, cases, workers, keep_in=campaign) as outcomes:
        for outcome in outcomes:
            text = reasons[outcome.case]
            if outcome.error and not outcome.error.startswith(text):
                text += _AGAIN + outcome.error
            _complete(failure_folder(campaign, outcome.case), plan, outcome.case, text)
            shown.add(has_error=False)


def _complete(folder: Path, plan: Plan, case: int, text: str) -> None:
    """Add the scenario if the run did not begin, and the reason, which completes the folder."""
    with output_errors(folder):
        folder.mkdir(exist_ok=True)
    if not exists(folder / SCENARIO):
        scenario = plan.case(case).scenario
        _write(folder / SCENARIO, yaml.safe_dump(scenario, sort_keys=False, default_flow_style=None))
    _write(folder / REASON, text)


def _write(file: Path, text: str) -> None:
    with replacing(file) as temporary:
        temporary.write_text(f"{text.rstrip()}\n", encoding="utf-8")
