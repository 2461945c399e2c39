"""Fixtures and hooks shared by the tests."""

from __future__ import annotations

import contextlib
import importlib.util

import pytest

import onorbit_rs as oo
from onorbit_rs.simulation import finish
from onorbit_rs.tools.validation import against_spart
from onorbit_rs.tools.validation.case import CannotRunError


@pytest.fixture
def no_pictures(monkeypatch: pytest.MonkeyPatch) -> None:
    """Turns off the figures and recordings of runs in this process, because they take most of their time."""
    monkeypatch.setattr(finish, "write_pictures", lambda *_, **__: None)


@pytest.fixture
def no_campaign_report(monkeypatch: pytest.MonkeyPatch) -> None:
    """Turns off the report of campaigns in this process, whose figures take more time than short cases."""
    monkeypatch.setattr("onorbit_rs.campaigns.run.write_report", lambda *_: None)


def pytest_configure(config: pytest.Config) -> None:
    """Compiles spartpy before the workers start; otherwise all of them would write the same file."""
    if getattr(config.option, "numprocesses", None) and importlib.util.find_spec("SPARTpy"):
        with contextlib.suppress(CannotRunError):
            against_spart.spart(oo.robots.path("humanoid_torso").read_text())
