"""Files that commands write: refused early and in one line."""

from __future__ import annotations

import os
from pathlib import Path

import pytest
from commands import refusal

from onorbit_rs.cli.writing import claim
from onorbit_rs.exceptions import NotFoundError, OutputFolderError, OutputNotEmptyError
from onorbit_rs.files import replacing


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


def test_what_may_not_be_written_is_refused_before_the_work(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    with pytest.raises(OutputFolderError, match="it is a folder, name a file in it"):
        claim(tmp_path, force=True)
    file = tmp_path / "mine.yaml"
    file.touch()
    monkeypatch.setattr(os, "access", lambda path, mode: False)  # for root everything may be written
    for wanted in (file, tmp_path / "new.yaml"):
        with pytest.raises(OutputFolderError, match="not yours to write"):
            claim(wanted, force=True)


def test_a_place_where_nobody_may_look_is_named(monkeypatch: pytest.MonkeyPatch) -> None:
    def refused(*_: object, **__: object) -> None:
        raise PermissionError(13, "Permission denied", "/secret/x.yaml")

    monkeypatch.setattr(Path, "is_file", refused)
    monkeypatch.setattr(Path, "exists", refused)
    assert refusal("check", "/secret/x.yaml") == "onorbit: cannot use /secret/x.yaml: Permission denied"


def test_errors_of_the_system_are_ours_and_ours_stay(tmp_path: Path) -> None:
    with (
        pytest.raises(OutputFolderError, match=r"cannot write .*: it is a folder, name"),
        replacing(tmp_path),
    ):
        pass
    picture = tmp_path / "picture"
    with pytest.raises(OutputFolderError, match=r"cannot write .*picture: why"), replacing(picture):
        raise OSError("why")
    with pytest.raises(NotFoundError, match="no recording"), replacing(picture):
        raise NotFoundError("no recording")
    assert not list(tmp_path.iterdir())


def test_a_link_in_the_way_is_neither_followed_nor_replaced(tmp_path: Path) -> None:
    """``--force`` wrote through a link that somebody had put where the file would be."""
    precious = tmp_path / "precious.yaml"
    precious.write_text("precious")
    link = tmp_path / "mine.yaml"
    link.symlink_to(precious)
    with pytest.raises(OutputFolderError, match=r"mine\.yaml: it is a symbolic link"):
        claim(link, force=True)
    with (
        pytest.raises(OutputFolderError, match=r"mine\.yaml: it is a symbolic link"),
        replacing(link) as file,
    ):
        file.write_text("new")
    assert precious.read_text() == "precious" and link.is_symlink()
    robot = ("new", "humanoid_torso", "-q", "--out", link, "--force")
    assert "mine.yaml: it is a symbolic link" in refusal(*robot)
    assert precious.read_text() == "precious"
