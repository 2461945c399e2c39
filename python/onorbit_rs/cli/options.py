"""Arguments and options that commands share."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

ScenarioArgument = Annotated[
    str, typer.Argument(metavar="NAME_OR_FILE", help="A bundled name or a YAML file.")
]
FolderArgument = Annotated[Path, typer.Argument(metavar="DIR", help="A folder that a run has written.")]
OutOption = Annotated[Path | None, typer.Option("--out", "-o", metavar="DIR", help="Write results here.")]
ForceOption = Annotated[bool, typer.Option("--force", help="Replace the run that is in DIR.")]
QuietOption = Annotated[bool, typer.Option("--quiet", "-q", help="No progress bar, no summary.")]
CheckpointOption = Annotated[
    float, typer.Option(metavar="SECONDS", help="Wall-clock time between checkpoints in DIR.")
]

PackagesOption = Annotated[
    list[Path] | None,
    typer.Option("--package-path", metavar="DIR", help="Where ROS packages are; may be repeated."),
]
ArgumentsOption = Annotated[
    list[str] | None, typer.Option("--arg", metavar="NAME=VALUE", help="For a xacro; may be repeated.")
]
