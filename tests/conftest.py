"""What several tests share."""

from __future__ import annotations

import contextlib
import importlib.util

import pytest

import onorbit_rs as oo
from onorbit_rs import keeping
from onorbit_rs.validation import against_spart
from onorbit_rs.validation.case import CannotRunError


@pytest.fixture
def no_pictures(monkeypatch: pytest.MonkeyPatch) -> None:
    """Runs in this process draw no figures and write no recording, which is what they take long for."""
    monkeypatch.setattr(keeping, "write_pictures", lambda *_, **__: None)


def pytest_configure(config: pytest.Config) -> None:
    """Lets spartpy compile itself before there are workers, which would all write the same file."""
    if getattr(config.option, "numprocesses", None) and importlib.util.find_spec("SPARTpy"):
        with contextlib.suppress(CannotRunError):
            against_spart.spart(oo.robots.path("humanoid_torso").read_text())
