"""Implements ``onorbit report``, which writes the HTML report of a run."""

from __future__ import annotations

from typing import Annotated

import typer

from onorbit_rs.cli.options import FolderArgument, JsonOption, QuietOption
from onorbit_rs.cli.text_output import print_line


def report(
    folder: FolderArgument,
    pdf: Annotated[bool, typer.Option(help="Also write each figure to DIR/figures as PDF.")] = True,
    quiet: QuietOption = False,
    as_json: JsonOption = False,
) -> None:
    """Write a self-contained HTML report of a run.

    It contains figures, numbers, certificate and scenario. The figures are also written as PDF, unless
    --no-pdf is given.
    """
    from onorbit_rs.cli.console import print_json
    from onorbit_rs.common.progress import parts_bar

    with parts_bar("report", quiet=quiet or as_json) as tell:
        from onorbit_rs.report import write_report

        page = write_report(folder, pdf=pdf, tell=tell)
    if as_json:
        print_json({"report": str(page), "bytes": page.stat().st_size})
    elif not quiet:
        print_line(f"report: {page} ({page.stat().st_size / 1e6:.1f} MB, self-contained)")
        if any((folder / "figures").glob("*.pdf")) and pdf:
            print_line(f"figures: {folder / 'figures'}, as PDF")
        print_line("next: open it in a browser")
