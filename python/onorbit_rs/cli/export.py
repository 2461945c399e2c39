"""Implements ``onorbit export``, which writes a run as a table, an ephemeris or a bag of ROS messages."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from onorbit_rs.cli.options import FolderArgument, JsonOption, QuietOption
from onorbit_rs.cli.output_files import check_bag_file, check_output_file
from onorbit_rs.cli.text_output import print_line
from onorbit_rs.exceptions import InputError

if TYPE_CHECKING:
    from collections.abc import Callable


def export(
    folder: FolderArgument,
    csv: Annotated[Path | None, typer.Option(metavar="FILE", help="Write a CSV table.")] = None,
    parquet: Annotated[Path | None, typer.Option(metavar="FILE", help="Write a Parquet table.")] = None,
    oem: Annotated[Path | None, typer.Option(metavar="FILE", help="Write a CCSDS orbit ephemeris.")] = None,
    aem: Annotated[
        Path | None, typer.Option(metavar="FILE", help="Write a CCSDS attitude ephemeris.")
    ] = None,
    system: Annotated[
        str | None,
        typer.Option(
            metavar="NAME", help="System of the table or ephemeris; required if the run has several systems."
        ),
    ] = None,
    mcap: Annotated[Path | None, typer.Option(metavar="FILE", help="Write an MCAP bag for ROS 2.")] = None,
    bag: Annotated[Path | None, typer.Option(metavar="FILE", help="Write a bag for ROS 1.")] = None,
    force: Annotated[bool, typer.Option("--force", help="Replace an existing file.")] = False,
    quiet: QuietOption = False,
    as_json: JsonOption = False,
) -> None:
    """Write a run as a table, an ephemeris or a bag.

    Tables have one column per number. Bags have the topics of onorbit ros2; they require pip install
    'onorbit-rs[ros2]', but no installation of ROS.
    """
    from onorbit_rs.cli.console import print_json
    from onorbit_rs.common.progress import parts_bar

    check_bag_file("--mcap", mcap, ".mcap", force=force)
    check_bag_file("--bag", bag, ".bag", force=force)
    tables = {"csv": csv, "parquet": parquet, "oem": oem, "aem": aem}
    for file in tables.values():
        check_output_file(file, force=force)
    if not any((mcap, bag, *tables.values())):
        raise InputError(
            "no output file is given; add --csv, --parquet, --oem, --aem, --mcap or --bag with a FILE",
            name="csv",
        )
    written: dict[str, Any] = {}
    with parts_bar("export", quiet=quiet or as_json) as tell:
        for kind, file in _write_tables(folder, tables, system, tell):
            written[kind] = {"file": str(file), "bytes": file.stat().st_size}
        for kind, file in _write_bags(folder, mcap, bag, tell):
            written[kind] = {"file": str(file), "bytes": file.stat().st_size}
    if as_json:
        print_json(written)
        return
    if quiet:
        return
    for kind, entry in written.items():
        print_line(f"{kind}: {entry['file']} ({entry['bytes'] / 1e6:.1f} MB)")


def _write_tables(
    folder: Path, files: dict[str, Path | None], system: str | None, tell: Callable[[str, float], None]
) -> list[tuple[str, Path]]:
    """Write tables and ephemerides; return their kinds and files."""
    wanted = [(kind, file) for kind, file in files.items() if file is not None]
    if not wanted:
        if system is not None:
            raise InputError(
                f"--system {system} applies only to --csv, --parquet, --oem and --aem; add one of them",
                name="system", got=system,
            )  # fmt: skip
        return []
    from onorbit_rs.tables import ccsds, read_run
    from onorbit_rs.tables import files as tables

    write = {
        "csv": tables.write_csv,
        "parquet": tables.write_parquet,
        "oem": ccsds.write_oem,
        "aem": ccsds.write_aem,
    }
    run = read_run(folder)
    for number, (kind, file) in enumerate(wanted):
        tell(f"writing {file}", number / len(wanted))
        write[kind](run, file, system)
    return wanted


def _write_bags(
    folder: Path, mcap: Path | None, bag: Path | None, tell: Callable[[str, float], None]
) -> list[tuple[str, Path]]:
    """Write bags; return their kinds and files."""
    from onorbit_rs import ros2

    done = []
    if mcap is not None:
        ros2.export_mcap(folder, mcap, tell=_telling(tell, mcap))
        done.append(("mcap", mcap))
    if bag is not None:
        ros2.export_bag(folder, bag, tell=_telling(tell, bag))
        done.append(("bag", bag))
    return done


def _telling(tell: Callable[[str, float], None], file: Path) -> Callable[[float], None]:
    return lambda done: tell(f"writing {file}", done)
