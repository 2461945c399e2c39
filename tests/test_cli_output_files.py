"""Output files of commands: problems are reported early and in one line."""

from __future__ import annotations

import os
from pathlib import Path

import pytest
from commands import refusal

from onorbit_rs.cli.output_files import check_output_file
from onorbit_rs.common.files import replacing
from onorbit_rs.exceptions import NotFoundError, OutputFolderError, OutputNotEmptyError


def test_an_output_file_that_cannot_be_written_is_rejected_early(tmp_path: Path) -> None:
    file = tmp_path / "mine.yaml"
    check_output_file(None, force=False)
    check_output_file(file, force=False)
    file.touch()
    check_output_file(file, force=True)
    with pytest.raises(OutputNotEmptyError, match=r"mine\.yaml already exists; replace it with --force"):
        check_output_file(file, force=False)
    with pytest.raises(
        OutputFolderError, match=r"cannot write .*mine\.yaml: the folder .* does not exist"
    ) as refused:
        check_output_file(tmp_path / "none" / "mine.yaml", force=True)
    assert refused.value.path == str(tmp_path / "none" / "mine.yaml")


def test_an_output_file_without_permission_is_rejected_early(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    with pytest.raises(OutputFolderError, match="it is a folder; give a file"):
        check_output_file(tmp_path, force=True)
    file = tmp_path / "mine.yaml"
    file.touch()
    monkeypatch.setattr(os, "access", lambda path, mode: False)  # root may write everywhere
    for wanted in (file, tmp_path / "new.yaml"):
        with pytest.raises(OutputFolderError, match=r"the folder .* is not writable"):
            check_output_file(wanted, force=True)


def test_a_folder_without_read_permission_is_named(monkeypatch: pytest.MonkeyPatch) -> None:
    def refused(*_: object, **__: object) -> None:
        raise PermissionError(13, "Permission denied", "/secret/x.yaml")

    monkeypatch.setattr(Path, "is_file", refused)
    monkeypatch.setattr(Path, "exists", refused)
    assert refusal("check", "/secret/x.yaml") == "onorbit: cannot use /secret/x.yaml: Permission denied"


def test_system_errors_are_converted_and_typed_errors_kept(tmp_path: Path) -> None:
    with (
        pytest.raises(OutputFolderError, match=r"cannot write .*: it is a folder; give"),
        replacing(tmp_path),
    ):
        pass
    picture = tmp_path / "picture"
    with pytest.raises(OutputFolderError, match=r"cannot write .*picture: why"), replacing(picture):
        raise OSError("why")
    with pytest.raises(NotFoundError, match="no recording"), replacing(picture):
        raise NotFoundError("no recording")
    assert not list(tmp_path.iterdir())


def test_a_symbolic_link_is_neither_followed_nor_replaced(tmp_path: Path) -> None:
    """An earlier ``--force`` wrote through a symbolic link at the place of the file."""
    precious = tmp_path / "precious.yaml"
    precious.write_text("precious")
    link = tmp_path / "mine.yaml"
    link.symlink_to(precious)
    with pytest.raises(OutputFolderError, match=r"mine\.yaml: it is a symbolic link"):
        check_output_file(link, force=True)
    with (
        pytest.raises(OutputFolderError, match=r"mine\.yaml: it is a symbolic link"),
        replacing(link) as file,
    ):
        file.write_text("new")
    assert precious.read_text() == "precious" and link.is_symlink()
    robot = ("new", "humanoid_torso", "-q", "--out", link, "--force")
    assert "mine.yaml: it is a symbolic link" in refusal(*robot)
    assert precious.read_text() == "precious"
