"""``onorbit report``."""

from __future__ import annotations

from typing import Annotated

import typer

from onorbit_rs.cli.options import FolderArgument, JsonOption, QuietOption
from onorbit_rs.cli.saying import say


def report(
    folder: FolderArgument,
    pdf: Annotated[bool, typer.Option(help="Also write every figure into DIR/figures as PDF.")] = True,
    quiet: QuietOption = False,
    as_json: JsonOption = False,
) -> None:
    """Write one HTML page of a run, with everything in it.

    Figures, numbers, certificate and scenario; the figures also as PDF.
    """
    from onorbit_rs.cli.printing import print_json
    from onorbit_rs.progress import parts_bar

    with parts_bar("report", quiet=quiet) as tell:
        from onorbit_rs.report import write_report

        page = write_report(folder, pdf=pdf, tell=tell)
    if as_json:
        print_json({"report": str(page), "bytes": page.stat().st_size})
    elif not quiet:
        say(f"report: {page} ({page.stat().st_size / 1e6:.1f} MB, needs no other file)")
        if any((folder / "figures").glob("*.pdf")) and pdf:
            say(f"figures: {folder / 'figures'}, as PDF")
        say("next: open it in a browser, or send it")
