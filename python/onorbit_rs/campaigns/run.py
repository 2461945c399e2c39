"""Functions that run a campaign, :func:`campaign`, and one of its cases, :func:`campaign_case`."""

from __future__ import annotations

import os
from collections.abc import Callable, Iterator, Mapping, Sequence
from contextlib import AbstractContextManager, contextmanager, nullcontext
from pathlib import Path
from typing import TYPE_CHECKING, Any

from onorbit_rs.campaigns.cases import Outcome
from onorbit_rs.campaigns.kept_columns import columns_of
from onorbit_rs.campaigns.load import load_campaign
from onorbit_rs.campaigns.on_threads import on_threads
from onorbit_rs.campaigns.plan import Plan, digest_of, plan_of
from onorbit_rs.campaigns.progress import campaign_progress
from onorbit_rs.campaigns.storage import CampaignFolder, is_campaign
from onorbit_rs.campaigns.table import check_conditions, rows_of, table_of
from onorbit_rs.campaigns.write import write_campaign, write_cases, write_columns
from onorbit_rs.common.suggestions import did_you_mean
from onorbit_rs.exceptions import DtypeError, InputError, OnOrbitError
from onorbit_rs.scenario import WorldScenario
from onorbit_rs.scenario.build import build
from onorbit_rs.scenario.build_world import build_world
from onorbit_rs.scenario.load import check
from onorbit_rs.simulation.run import Run, run

if TYPE_CHECKING:
    import pyarrow as pa

    from onorbit_rs.campaigns.document import Condition
    from onorbit_rs.campaigns.load import LoadedCampaign

Source = str | os.PathLike[str] | Mapping[str, Any]


def campaign(
    source: Source,
    out: str | os.PathLike[str] | None = None,
    *,
    cases: int | None = None,
    workers: int | None = None,
    force: bool = False,
    quiet: bool = False,
) -> pa.Table:
    """Run a campaign, or continue it if ``out`` contains a part of it, and return its table.

    Parameters
    ----------
    source : str, path or mapping
        Name of a bundled campaign, a YAML file, or its content as a mapping.
    out : str or path, optional
        Folder for ``cases.parquet``, ``campaign.yaml`` and ``report.html``. None writes nothing.
    cases : int, optional
        Number of cases, in place of that of the campaign.
    workers : int, optional
        Number of threads or processes. Default: the number of cores of the machine.
    force : bool
        Replace another campaign in ``out``.
    quiet : bool
        Show no progress.

    Returns
    -------
    pyarrow.Table
        One row per case: ``case``, ``status``, ``success``, ``error``, every dispersed value and every number
        of the summary. ``table.to_pandas()`` and ``polars.from_arrow(table)`` convert it.

    Raises
    ------
    OnOrbitError
        Before any case runs: for an invalid campaign or scenario (``ScenarioError``), a folder that is not
        empty, not writable or in use (``OutputFolderError``), or a missing package (``InputError``).
        Errors of a case are part of the table.
    OutputFolderError
        If the disk is full; the cases on the disk are kept, and the same call continues the campaign.
    """
    count = _checked_workers(workers)
    loaded = load_campaign(source, cases=cases)
    plan = plan_of(loaded)
    _check_nominal(plan, loaded)
    conditions = loaded.document.campaign.success
    with _folder(plan, loaded, out, force=force) as folder:
        if folder is None:
            found: list[Outcome] = []
            _run(plan, range(plan.cases), count, conditions, found.append, quiet=quiet)
            return table_of(rows_of(found, plan.value_names, conditions))
        done = folder.done()
        pending = [case for case in range(plan.cases) if case not in done]
        with _keeping(folder, plan.cases):
            _run(plan, pending, count, conditions, folder.add, quiet=quiet)
        kept = (outcome for outcome in folder.outcomes() if outcome.case < plan.cases)
        table = table_of(rows_of(kept, plan.value_names, conditions))
        write_cases(folder, table)
        write_columns(folder, plan, range(plan.cases))
        return table


def _run(
    plan: Plan,
    cases: Sequence[int],
    workers: int,
    conditions: dict[str, Condition],
    add: Callable[[Outcome], None],
    *,
    quiet: bool,
) -> None:
    """Run cases and pass their outcomes to ``add`` as they come."""
    progress = campaign_progress(plan.name, plan.cases, plan.cases - len(cases), quiet=quiet)
    with progress as shown, _engine(plan, cases, workers) as outcomes:
        for outcome in _complete(plan, outcomes):
            add(outcome)
            shown.add(has_error=outcome.error is not None)
            if outcome.status == "complete":
                check_conditions(outcome, conditions)


@contextmanager
def _keeping(folder: CampaignFolder, cases: int) -> Iterator[None]:
    """Write the remaining outcomes at the end of the block; an error states how many cases are kept."""
    try:
        try:
            yield
        finally:
            folder.flush()
    except (KeyboardInterrupt, Exception) as error:
        note = (
            f"{len(folder.done())} of {cases} cases are kept in {folder.path}; the same command continues "
            "the campaign"
        )
        if isinstance(error, OnOrbitError):
            error.message = f"{error.message}; {note}"
        else:
            error.add_note(note)
        raise


def campaign_case(
    source: Source,
    case: int,
    out: str | os.PathLike[str] | None = None,
    *,
    cases: int | None = None,
    force: bool = False,
    quiet: bool = False,
) -> Run:
    """Run one case of a campaign as an ordinary run; the results have the same bits as in the campaign.

    Parameters
    ----------
    source : str, path or mapping
        The campaign, as for :func:`campaign`.
    case : int
        Number of the case, from 0.
    out : str or path, optional
        Folder for trace, summary, figures and recording; None writes nothing. In the folder of a campaign,
        the results are in ``case_NUMBER``.
    cases : int, optional
        Number of cases, in place of that of the campaign; the draws of ``latin_hypercube`` depend on it.
    force : bool
        Replace the files of an earlier run.
    quiet : bool
        Show no progress bar.

    Returns
    -------
    Run

    Raises
    ------
    OnOrbitError
        As for :func:`onorbit_rs.run`; if the case ended with an error in the campaign, it is raised.
    """
    plan = plan_of(load_campaign(source, cases=cases))
    if isinstance(case, bool) or not isinstance(case, int):
        raise DtypeError(f"case is {case!r}; it must be a whole number", name="case", got=case)
    if not 0 <= case < plan.cases:
        raise InputError(
            f"case {case} does not exist; the campaign has the cases 0 to {plan.cases - 1}",
            name="case", got=case, expected=f"0 to {plan.cases - 1}",
        )  # fmt: skip
    scenario = check(plan.case(case).scenario, None, {})
    folder = None if out is None else Path(out)
    if folder is not None and is_campaign(folder):
        folder = folder / f"case_{case}"
    return run(scenario, folder, force=force, quiet=quiet)


def _checked_workers(workers: int | None) -> int:
    if isinstance(workers, bool) or not isinstance(workers, int | None):
        raise DtypeError(f"workers is {workers!r}; it must be a positive integer, or None for every core")
    if workers is not None and workers < 1:
        raise InputError(f"workers is {workers}; it must be at least 1, or None for every core")
    return workers or os.cpu_count() or 1


def _check_nominal(plan: Plan, loaded: LoadedCampaign) -> None:
    """Build the nominal scenario, so that its errors and warnings are reported before any case runs."""
    scenario = loaded.scenario
    is_world = isinstance(scenario, WorldScenario)
    built = build_world(scenario, runs_code=False) if is_world else build(scenario, runs_code=False)  # type: ignore[arg-type]
    if not plan.keep.columns:
        return
    known = list(columns_of(built.simulation.run(scenario.simulation.time_step)))
    for name in plan.keep.columns:
        if name not in known:
            hint = did_you_mean(name, known) or "; trace.npz of a run lists the columns"
            raise InputError(
                f"campaign.keep.columns: the trace has no column {name!r}{hint}", name="columns", got=name
            )


def _folder(
    plan: Plan, loaded: LoadedCampaign, out: str | os.PathLike[str] | None, *, force: bool
) -> AbstractContextManager[CampaignFolder | None]:
    """Return the locked folder of the campaign with ``campaign.yaml``; None without ``out``."""
    if out is None:
        return nullcontext()
    folder = CampaignFolder(out, plan.name, digest_of(plan), force=force)
    try:
        write_campaign(folder, loaded.document, plan.scenario)
    except BaseException:
        folder.close()
        raise
    return folder


def _engine(plan: Plan, cases: Sequence[int], workers: int) -> AbstractContextManager[Iterator[Outcome]]:
    """Return the iterator of outcomes of the engine that suits the scenario."""
    if not cases:
        return nullcontext(iter(()))
    return on_threads(plan, cases, workers)


def _complete(plan: Plan, outcomes: Iterator[Outcome]) -> Iterator[Outcome]:
    """Yield outcomes with the dispersed values, which the case of a worker that died lacks."""
    for outcome in outcomes:
        if outcome.values:
            yield outcome
        else:
            yield Outcome(outcome.case, outcome.status, outcome.error, plan.case(outcome.case).values, {})
