"""Progress on a stderr that is not a terminal: lines at growing intervals."""

from __future__ import annotations

import pytest

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
