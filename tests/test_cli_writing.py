"""Files that commands write: refused early and in one line."""

from __future__ import annotations

from pathlib import Path

import pytest

from onorbit_rs.cli.writing import claim, writing
from onorbit_rs.exceptions import NotFoundError, OutputFolderError, OutputNotEmptyError


def test_what_cannot_be_written_is_refused_before_the_work(tmp_path: Path) -> None:
    file = tmp_path / "mine.yaml"
    claim(None, force=False)
    claim(file, force=False)
    file.touch()
    claim(file, force=True)
    with pytest.raises(OutputNotEmptyError, match=r"mine\.yaml is there already; replace it with --force"):
        claim(file, force=False)
    with pytest.raises(OutputFolderError, match=r"cannot write .*mine\.yaml: no such folder") as refused:
        claim(tmp_path / "none" / "mine.yaml", force=True)
    assert refused.value.path == str(tmp_path / "none" / "mine.yaml")


def test_errors_of_the_system_are_ours_and_ours_stay(tmp_path: Path) -> None:
    with pytest.raises(OutputFolderError, match=r"cannot write .*: Is a directory"), writing(tmp_path):
        tmp_path.write_text("")
    with pytest.raises(OutputFolderError, match="cannot write picture: why"), writing(Path("picture")):
        raise OSError("why")
    with pytest.raises(NotFoundError, match="no recording"), writing(tmp_path):
        raise NotFoundError("no recording")
