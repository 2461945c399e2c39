"""Implements ``onorbit campaign``, which runs many cases of a scenario with dispersed values."""

from __future__ import annotations

from typing import TYPE_CHECKING, Annotated, Any

import typer

from onorbit_rs.cli.completion import campaign_names
from onorbit_rs.cli.exit_codes import ignore_closed_pipe
from onorbit_rs.cli.options import ForceOption, JsonOption, OutOption, QuietOption
from onorbit_rs.cli.text_output import print_line

if TYPE_CHECKING:
    from pathlib import Path

    import pyarrow as pa

CampaignArgument = Annotated[
    str,
    typer.Argument(
        metavar="NAME_OR_FILE", help="A bundled campaign or a YAML file.", autocompletion=campaign_names
    ),
]
CaseOption = Annotated[
    int | None,
    typer.Option(metavar="K", help="Run only case K, as an ordinary run with figures and recording."),
]
CasesOption = Annotated[
    int | None, typer.Option(metavar="N", help="Number of cases; replaces the number in the file.")
]
WorkersOption = Annotated[
    int | None, typer.Option(metavar="N", help="Number of threads or processes; default: one per core.")
]


ClusterOption = Annotated[
    str | None,
    typer.Option(metavar="ADDRESS", help="Address of a Dask cluster, or 'local' for one on this machine."),
]


def campaign(
    campaign: CampaignArgument,
    out: OutOption = None,
    case: CaseOption = None,
    cases: CasesOption = None,
    workers: WorkersOption = None,
    cluster: ClusterOption = None,
    force: ForceOption = False,
    quiet: QuietOption = False,
    as_json: JsonOption = False,
) -> None:
    """Run many cases of a scenario with dispersed values.

    The same command continues a campaign that was stopped.
    """
    if case is not None:
        from onorbit_rs.campaigns.run import campaign_case
        from onorbit_rs.cli.run import report_run

        report_run(
            lambda: campaign_case(campaign, case, out, cases=cases, force=force, quiet=quiet or as_json),
            quiet=quiet,
            as_json=as_json,
        )
        return
    from onorbit_rs.campaigns.run import campaign as run_campaign

    table = run_campaign(
        campaign, out, cases=cases, workers=workers, cluster=cluster, force=force, quiet=quiet or as_json
    )
    with ignore_closed_pipe():
        if as_json:
            from onorbit_rs.cli.console import print_json

            print_json(_overview(table))
        elif not quiet:
            _print_overview(_overview(table), campaign, cases, out)


def _overview(table: pa.Table) -> dict[str, Any]:
    """Return the numbers of cases by status, the success rate with bounds, and the cases without success."""
    from onorbit_rs.campaigns.statistics import CONFIDENCE, wilson

    status, is_success = table["status"].to_pylist(), table["success"].to_pylist()
    found = wilson(sum(is_success), len(status))
    return {
        "cases": len(status),
        "status": {name: status.count(name) for name in dict.fromkeys(sorted(status))},
        "successes": found.successes, "success_fraction": found.fraction,
        "confidence": CONFIDENCE, "success_low": found.low, "success_high": found.high,
        "without_success": [
            case for case, has in zip(table["case"].to_pylist(), is_success, strict=True) if not has
        ],
    }  # fmt: skip


def _print_overview(overview: dict[str, Any], campaign: str, cases: int | None, out: Path | None) -> None:
    from onorbit_rs.common.printable import shell_word

    status = ", ".join(f"{number} {name}" for name, number in overview["status"].items())
    print_line(f"cases: {overview['cases']} ({status})")
    print_line(
        f"success: {overview['successes']} of {overview['cases']}, {overview['success_fraction']:.1%} "
        f"(95 % confidence: {overview['success_low']:.1%} to {overview['success_high']:.1%})"
    )
    if bad := overview["without_success"]:
        more = f" and {len(bad) - 10} more" if len(bad) > 10 else ""
        print_line(f"without success: {', '.join(map(str, bad[:10]))}{more}")
        number = "" if cases is None else f" --cases {cases}"  # the draws of a case may depend on it
        print_line(f"next: onorbit campaign {shell_word(campaign)}{number} --case {bad[0]} --out DIR")
    if out is not None:
        print_line(f"results: {out}")
