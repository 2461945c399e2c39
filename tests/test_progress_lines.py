"""Progress on a stderr that is not a terminal: lines at growing intervals."""

from __future__ import annotations

import pytest

from onorbit_rs.campaigns import progress as campaign_progress
from onorbit_rs.campaigns.progress import CampaignProgress, _duration
from onorbit_rs.common import progress, progress_lines
from onorbit_rs.common.progress import progress_bar


@pytest.fixture
def clock(monkeypatch: pytest.MonkeyPatch) -> list[float]:
    now = [0.0]
    monkeypatch.setattr(progress_lines.time, "monotonic", lambda: now[0])
    monkeypatch.setattr(progress.time, "perf_counter", lambda: now[0])
    return now


def test_lines_are_printed_at_growing_intervals(
    clock: list[float], capsys: pytest.CaptureFixture[str]
) -> None:
    with progress_bar("reach\n", 1000.0, quiet=False) as shown:
        assert shown.move is not None
        printed = []
        for second in range(61):
            clock[0] = float(second)
            shown.move(10.0 * second, 1000.0)
            if line := capsys.readouterr().err:
                printed.append((second, line))
        assert [second for second, _ in printed] == [3, 9, 21, 45]
        assert printed[0][1] == "onorbit: reach\\n: t = 30 / 1000 s, 10x real time\n"
        shown.tell("writing the trace")
        assert capsys.readouterr().err == "onorbit: reach\\n: writing the trace\n"
        shown.tell("drawing at the same instant")
        assert capsys.readouterr().err == ""


def test_short_and_quiet_runs_print_no_lines(clock: list[float], capsys: pytest.CaptureFixture[str]) -> None:
    for quiet, seconds in ((False, 2.9), (True, 100.0)):
        clock[0] = 0.0
        with progress_bar("reach", 1000.0, quiet=quiet) as shown:
            clock[0] = seconds
            if shown.move is not None:
                shown.move(1.0, 1000.0)
            shown.tell("certificate")
        assert capsys.readouterr().err == ""


def test_a_campaign_shows_cases_errors_and_the_time_left(monkeypatch: pytest.MonkeyPatch) -> None:
    now, shown = [100.0], []
    monkeypatch.setattr(campaign_progress.time, "monotonic", lambda: now[0])
    progress = CampaignProgress(10, 4, lambda text, part: shown.append((text, part)))
    for errors, seconds in ((False, 3.0), (True, 3.0), (True, 9000.0)):
        now[0] += seconds
        progress.add(has_error=errors)
    assert shown == [
        ("5 of 10 cases, 15 s left", 0.5),  # 3 s a case, of those that this call runs
        ("6 of 10 cases, 1 error, 12 s left", 0.6),
        ("7 of 10 cases, 2 errors, 2 h 30 min left", 0.7),
    ]


def test_a_campaign_that_begins_or_is_continued_after_its_last_case_has_no_time_left() -> None:
    assert CampaignProgress(1, 0, lambda *_: None).text(0.0) == "0 of 1 case, 0 s left"
    assert CampaignProgress(3, 3, lambda *_: None).text(0.0) == "3 of 3 cases, 0 s left"


@pytest.mark.parametrize(
    ("seconds", "text"),
    [(0.4, "0 s"), (89.0, "89 s"), (90.0, "2 min"), (5340.0, "89 min"), (7500.0, "2 h 5 min")],
)
def test_durations_have_suitable_units(seconds: float, text: str) -> None:
    assert _duration(seconds) == text
