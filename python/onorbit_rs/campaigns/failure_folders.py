"""Folders ``failures/case_K`` of a campaign: the results of the cases without success.

A folder is complete as soon as it contains ``reason.txt``, which is written last.
"""

from __future__ import annotations

import re
from pathlib import Path

from onorbit_rs.common.files import exists, is_real_folder, output_errors, remove
from onorbit_rs.output import OutputFolder
from onorbit_rs.output.lock import LOCK
from onorbit_rs.output.manifest import FIGURES, MANIFEST, SCENARIO

FAILURES = "failures"
REASON = "reason.txt"
"""File with the reason why a case is not a success."""
_NAME = re.compile(r"case_(\d+)")


def failure_folder(campaign: Path, case: int) -> Path:
    """Return the folder of a case without success in the folder of a campaign."""
    return campaign / FAILURES / f"case_{case}"


def failure_folders(campaign: Path) -> dict[int, Path]:
    """Return the existing folders by the numbers of their cases; links are ignored."""
    folder = campaign / FAILURES
    with output_errors(folder):
        found = sorted(folder.iterdir()) if is_real_folder(folder) else []
    matches = ((_NAME.fullmatch(path.name), path) for path in found if is_real_folder(path))
    return {int(match[1]): path for match, path in matches if match}


def begin_failure(folder: Path) -> None:
    """Prepare a folder for the run of its case, which replaces the results that it may contain."""
    with output_errors(folder):
        remove(folder / REASON)
        if not exists(folder / MANIFEST):  # the earlier run did not begin, and no manifest lists its scenario
            remove(folder / SCENARIO)


def remove_failure(folder: Path) -> None:
    """Remove the results in a folder, and the folder unless it contains other files.

    Raises
    ------
    OutputFolderError, ReadError
        If the folder contains a figure that was edited or a damaged manifest, or is in use; nothing is
        removed then.
    """
    with OutputFolder.claim(folder, force=True):
        begin_failure(folder)
    with output_errors(folder):
        remove(folder / LOCK)
        for empty in (folder / FIGURES, folder):
            if is_real_folder(empty) and not any(empty.iterdir()):
                empty.rmdir()
