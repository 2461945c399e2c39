"""Implements ``onorbit export``, which writes a run as a bag of ROS messages."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from onorbit_rs.cli.options import FolderArgument, JsonOption, QuietOption
from onorbit_rs.cli.output_files import check_bag_file
from onorbit_rs.cli.text_output import print_line
from onorbit_rs.exceptions import InputError

if TYPE_CHECKING:
    from collections.abc import Callable


def export(
    folder: FolderArgument,
    mcap: Annotated[Path | None, typer.Option(metavar="FILE", help="Write MCAP, for ROS 2.")] = None,
    bag: Annotated[Path | None, typer.Option(metavar="FILE", help="Write a bag of ROS 1.")] = None,
    force: Annotated[bool, typer.Option("--force", help="Replace an existing file.")] = False,
    quiet: QuietOption = False,
    as_json: JsonOption = False,
) -> None:
    """Write a run as a bag of ROS messages.

    The topics are those of onorbit ros2. ROS is not required: pip install 'onorbit-rs[ros2]'.
    """
    from onorbit_rs import ros2
    from onorbit_rs.cli.console import print_json
    from onorbit_rs.common.progress import parts_bar

    check_bag_file("--mcap", mcap, ".mcap", force=force)
    check_bag_file("--bag", bag, ".bag", force=force)
    if mcap is None and bag is None:
        raise InputError(
            "no output file is given; add --mcap FILE for ROS 2, or --bag FILE for ROS 1", name="mcap"
        )
    written: dict[str, Any] = {}
    with parts_bar("export", quiet=quiet) as tell:
        if mcap is not None:
            ros2.export_mcap(folder, mcap, tell=_telling(tell, mcap))
            written["mcap"] = {"file": str(mcap), "bytes": mcap.stat().st_size}
        if bag is not None:
            ros2.export_bag(folder, bag, tell=_telling(tell, bag))
            written["bag"] = {"file": str(bag), "bytes": bag.stat().st_size}
    if as_json:
        print_json(written)
        return
    if quiet:
        return
    for kind, entry in written.items():
        print_line(f"{kind}: {entry['file']} ({entry['bytes'] / 1e6:.1f} MB)")


def _telling(tell: Callable[[str, float], None], file: Path) -> Callable[[float], None]:
    return lambda done: tell(f"writing {file}", done)
