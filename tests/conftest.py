"""What several tests share."""

from __future__ import annotations

import contextlib
import importlib.util
from pathlib import Path

import pytest

import onorbit_rs as oo
from onorbit_rs import running
from onorbit_rs.validation import against_spart
from onorbit_rs.validation.case import CannotRunError

REPOSITORY = Path(__file__).resolve().parents[1]


@pytest.fixture
def no_pictures(monkeypatch: pytest.MonkeyPatch) -> None:
    """Runs in this process draw no figures and write no recording, which is what they take long for."""
    monkeypatch.setattr(running, "write_pictures", lambda *_, **__: None)


def pytest_configure(config: pytest.Config) -> None:
    """Lets spartpy compile itself before there are workers, which would all write the same file."""
    if getattr(config.option, "numprocesses", None) and importlib.util.find_spec("SPARTpy"):
        with contextlib.suppress(CannotRunError):
            against_spart.spart(oo.robots.path("humanoid_torso").read_text())


@pytest.fixture(scope="session")
def shared() -> Path:
    """The folder of robots and validation data beside the repository; a clone alone does not have it."""
    folder = REPOSITORY.parent / "shared"
    if not folder.is_dir():
        pytest.skip(f"{folder} is not there: it comes with the workplace, not with the repository")
    return folder
