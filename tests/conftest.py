"""What several tests share."""

from __future__ import annotations

from pathlib import Path

import pytest

from onorbit_rs import running

REPOSITORY = Path(__file__).resolve().parents[1]


@pytest.fixture
def no_pictures(monkeypatch: pytest.MonkeyPatch) -> None:
    """Runs in this process draw no figures and write no recording, which is what they take long for."""
    monkeypatch.setattr(running, "write_pictures", lambda *_, **__: None)


@pytest.fixture(scope="session")
def shared() -> Path:
    """The folder of robots and validation data beside the repository; a clone alone does not have it."""
    folder = REPOSITORY.parent / "shared"
    if not folder.is_dir():
        pytest.skip(f"{folder} is not there: it comes with the workplace, not with the repository")
    return folder
