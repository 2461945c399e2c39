"""Functions that run a campaign, :func:`campaign`, and one of its cases, :func:`campaign_case`."""

from __future__ import annotations

import os
import re
from collections.abc import Callable, Iterator, Mapping, Sequence
from contextlib import AbstractContextManager, contextmanager, nullcontext
from pathlib import Path
from typing import TYPE_CHECKING, Any

from onorbit_rs.campaigns.cases import Outcome
from onorbit_rs.campaigns.failures import write_failures
from onorbit_rs.campaigns.load import load_campaign
from onorbit_rs.campaigns.nominal import check_nominal
from onorbit_rs.campaigns.on_processes import on_processes
from onorbit_rs.campaigns.on_threads import on_threads
from onorbit_rs.campaigns.plan import Plan, digest_of, plan_of
from onorbit_rs.campaigns.progress import campaign_progress
from onorbit_rs.campaigns.report import write_report
from onorbit_rs.campaigns.storage import CampaignFolder, is_campaign
from onorbit_rs.campaigns.table import arrow, check_conditions, rows_of, table_of
from onorbit_rs.campaigns.write import write_campaign, write_cases, write_columns
from onorbit_rs.common.counting import count
from onorbit_rs.common.progress import doing
from onorbit_rs.displays.campaign import described, show_tables
from onorbit_rs.exceptions import DtypeError, InputError, OnOrbitError
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
    cluster: str | None = None,
    force: bool = False,
    quiet: bool = False,
) -> pa.Table:
    """Run a campaign, or continue it if ``out`` contains a part of it, and return its table.

    Parameters
    ----------
    source : str, path or mapping
        Name of a bundled campaign, a YAML file, or its content as a mapping.
    out : str or path, optional
        Folder for the files of the campaign, such as ``campaign.yaml``, ``cases.parquet`` and
        ``report.html``. None writes nothing.
    cases : int, optional
        Number of cases; replaces the number in the campaign.
    workers : int, optional
        Number of threads, or of processes if Python code runs in every step or the cluster is ``local``. At
        most half as many processes keep the failures in full. Default: the number of cores of the machine.
    cluster : str, optional
        Address of the scheduler of a Dask cluster, such as ``tcp://10.0.0.1:8786``, or ``local`` for a
        cluster on this machine. A script that starts one needs ``if __name__ == "__main__":``.
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
        Before any case runs: for a campaign that does not exist (``NotFoundError``), an invalid campaign or
        scenario (``ScenarioError``), a column of ``keep`` or ``success`` that does not exist
        (``InputError``), invalid ``workers`` or ``cluster`` (``DtypeError``, ``InputError``), a folder that
        is not empty, not writable or in use (``OutputFolderError``), or if pyarrow, or SciPy or Dask where
        required, is not installed (``InputError``). Errors of single cases are not raised; they are in the
        column ``error``.
    CampaignError
        If the cluster does not answer or cannot run the cases, the connection to it is lost, or the worker
        processes do not start. The cases on the disk are kept.
    OutputFolderError
        If the disk is full; the cases on the disk are kept, and the same call continues the campaign.
    """
    worker_count = _checked_workers(workers)
    _check_cluster(cluster)
    arrow()  # the table requires it after the last case
    loaded = load_campaign(source, cases=cases)
    plan = plan_of(loaded)
    check_nominal(plan, loaded)
    conditions = loaded.document.campaign.success

    def engine(numbers: Sequence[int]) -> AbstractContextManager[Iterator[Outcome]]:
        return _engine(plan, numbers, worker_count, cluster)

    with _folder(plan, loaded, out, force=force) as folder:
        if folder is None:
            found: list[Outcome] = []
            _run(plan, range(plan.cases), engine, conditions, found.append, quiet=quiet)
            return _table(rows_of(found, plan.value_names, conditions), plan, conditions)
        done = folder.done()
        pending = [case for case in range(plan.cases) if case not in done]
        with _keeping(folder, plan.cases):
            _run(plan, pending, engine, conditions, folder.add, quiet=quiet)
            folder.flush()
            kept = (outcome for outcome in folder.outcomes() if outcome.case < plan.cases)
            columns = rows_of(kept, plan.value_names, conditions)
            table = _table(columns, plan, conditions)
            write_cases(folder, table)
            write_columns(folder, plan, range(plan.cases))
            with doing("writing the report", quiet=quiet):
                write_report(folder, loaded.document, columns, plan.value_names)
            write_failures(folder, plan, columns, conditions, worker_count, quiet=quiet)
        return table


def _run(
    plan: Plan,
    cases: Sequence[int],
    engine: Callable[[Sequence[int]], AbstractContextManager[Iterator[Outcome]]],
    conditions: dict[str, Condition],
    add: Callable[[Outcome], None],
    *,
    quiet: bool,
) -> None:
    """Run cases, and pass each outcome to ``add`` as soon as its case ends."""
    progress = campaign_progress(plan.name, plan.cases, plan.cases - len(cases), quiet=quiet)
    with progress as shown, engine(cases) as outcomes:
        for outcome in _complete(plan, outcomes):
            add(outcome)
            shown.add(has_error=outcome.error is not None)
            if outcome.status == "complete":
                check_conditions([*outcome.values, *outcome.numbers], conditions)


def _table(columns: dict[str, list[Any]], plan: Plan, conditions: dict[str, Condition]) -> pa.Table:
    """Return the table with the metadata that its display in notebooks requires."""
    show_tables()
    return described(table_of(columns), plan.name, plan.value_names, conditions)


@contextmanager
def _keeping(folder: CampaignFolder, cases: int) -> Iterator[None]:
    """Write the remaining outcomes at the end of the block; add the number of kept cases to an error."""
    try:
        try:
            yield
        finally:
            folder.flush()
    except (KeyboardInterrupt, Exception) as error:
        done = len(folder.done())
        note = (
            f"{done} of {count(cases, 'case', 'cases')} {'is' if done == 1 else 'are'} kept in "
            f"{folder.path}; the same command continues the campaign"
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
    """Run one case of a campaign as an ordinary run, with results bit-identical to those of the campaign.

    Parameters
    ----------
    source : str, path or mapping
        The campaign, as for :func:`campaign`.
    case : int
        Number of the case, from 0.
    out : str or path, optional
        Folder for the trace, the summary, the figures and the recording; None writes nothing. If it is the
        folder of a campaign, the results are written to its subfolder ``case_NUMBER``.
    cases : int, optional
        Number of cases; replaces the number in the campaign. The draws of ``latin_hypercube`` depend on it.
    force : bool
        Replace the files of an earlier run.
    quiet : bool
        Show no progress.

    Returns
    -------
    Run

    Raises
    ------
    OnOrbitError
        As for :func:`onorbit_rs.run`, including the error with which the case ended in the campaign.
    DtypeError, InputError
        If ``case`` is not a whole number, or the campaign has no case of this number.
    """
    plan = plan_of(load_campaign(source, cases=cases))
    if isinstance(case, bool) or not isinstance(case, int):
        raise DtypeError(f"case is {case!r}; it must be a whole number, such as 0", name="case", got=case)
    if not 0 <= case < plan.cases:
        fix = f"give a number from 0 to {plan.cases - 1}" if plan.cases > 1 else "the only case is case 0"
        raise InputError(
            f"case {case} does not exist; {fix}",
            name="case", got=case, expected=f"0 to {plan.cases - 1}",
        )  # fmt: skip
    scenario = check(plan.case(case).scenario, None, {})
    folder = None if out is None else Path(out)
    if folder is not None and is_campaign(folder):
        folder = folder / f"case_{case}"
    return run(scenario, folder, force=force, quiet=quiet)


def _checked_workers(workers: int | None) -> int:
    if isinstance(workers, bool) or not isinstance(workers, int | None):
        raise DtypeError(f"workers is {workers!r}; it must be a positive integer, or None to use all cores")
    if workers is not None and workers < 1:
        raise InputError(f"workers is {workers}; it must be at least 1, or None to use all cores")
    return workers or os.cpu_count() or 1


def _check_cluster(cluster: str | None) -> None:
    """Raise InputError unless ``cluster`` is None, ``local`` or an address with a port."""
    if cluster is None or cluster == "local" or re.fullmatch(r"([a-z]+://)?[^/\s]+:[0-9]+", cluster):
        return
    raise InputError(
        f"cluster is {cluster!r}; give the address of a scheduler with its port, such as "
        "tcp://10.0.0.1:8786, or 'local'",
        name="cluster", got=cluster,
    )  # fmt: skip


def _folder(
    plan: Plan, loaded: LoadedCampaign, out: str | os.PathLike[str] | None, *, force: bool
) -> AbstractContextManager[CampaignFolder | None]:
    """Lock the folder of the campaign and write ``campaign.yaml``; the context is None without ``out``."""
    if out is None:
        return nullcontext()
    folder = CampaignFolder(out, plan.name, digest_of(plan), force=force)
    try:
        write_campaign(folder, loaded.document, plan.scenario)
    except BaseException:
        folder.close()
        raise
    return folder


def _engine(
    plan: Plan, cases: Sequence[int], workers: int, cluster: str | None
) -> AbstractContextManager[Iterator[Outcome]]:
    """Return a context that runs cases on a cluster, processes or threads, and yields their outcomes."""
    if not cases:
        return nullcontext(iter(()))
    if cluster is not None:
        from onorbit_rs.campaigns.on_dask import on_dask

        return on_dask(plan, cases, workers, cluster)
    return on_processes(plan, cases, workers) if plan.needs_processes else on_threads(plan, cases, workers)


def _complete(plan: Plan, outcomes: Iterator[Outcome]) -> Iterator[Outcome]:
    """Yield the outcomes; add the dispersed values to those of cases whose worker died."""
    for outcome in outcomes:
        if outcome.values:
            yield outcome
        else:
            yield Outcome(outcome.case, outcome.status, outcome.error, plan.case(outcome.case).values, {})
