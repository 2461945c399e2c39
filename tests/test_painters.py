"""Figures are drawn by several processes, with the bytes of one; a process that ends loses no figure."""

from __future__ import annotations

import os
import signal
import subprocess
import sys
import threading
from functools import partial
from pathlib import Path
from typing import Any

import pytest

import onorbit_rs as oo
from onorbit_rs import figures
from onorbit_rs.figures.painter import drawings_of
from onorbit_rs.output import painters
from onorbit_rs.output.painters import Album
from onorbit_rs.scenario import load


@pytest.fixture(scope="module")
def albums() -> list[Album]:
    data = load("humanoid_reach").resolved()
    data["simulation"] |= {"time_step": 1e-2, "duration": 0.5}
    run = oo.run(data, quiet=True)
    return [Album("own_", figures.subject_of(run.trace, run.scenario, run.model, None, None))]


def drawn(albums: list[Album]) -> list[tuple[str, Any]]:
    def png(drawing: figures.Drawing) -> bytes:
        return figures.as_bytes(drawing.draw(), "png")

    return [(name, partial(png, drawing)) for name, drawing in drawings_of(albums)]


def test_helpers_draw_the_same_bytes_as_this_process(
    albums: list[Album], monkeypatch: pytest.MonkeyPatch
) -> None:
    found = drawn(albums)
    expected = [draw() for _, draw in found]
    assert len(found) >= 6 and all(name.startswith("own_") for name, _ in found)

    def in_the_helper() -> bytes:
        raise AssertionError("the helper draws every figure")

    monkeypatch.setattr(painters, "_helper_count", lambda figures: 1)
    queue = painters._Queue(len(found))
    helper = painters._started()
    painters._serve(helper, albums, queue)  # negative control: without the program, nothing is drawn
    painters.end(helper)
    assert [queue.contents[number] for number in range(len(found))] == expected
    with painters.painters(albums, [in_the_helper for _ in found]) as helpers, pytest.raises(AssertionError):
        list(helpers.contents())


def test_a_helper_that_is_killed_loses_no_figure(
    albums: list[Album], monkeypatch: pytest.MonkeyPatch
) -> None:
    found = drawn(albums)
    started: list[subprocess.Popen[bytes]] = []
    real = painters._started
    monkeypatch.setattr(painters, "_helper_count", lambda figures: 1)
    monkeypatch.setattr(painters, "_started", lambda: started.append(real()) or started[-1])
    with painters.painters(albums, [draw for _, draw in found]) as helpers:
        threading.Timer(0.3, lambda: os.kill(started[0].pid, signal.SIGKILL)).start()
        numbers = [number for number, _ in helpers.contents()]
    assert numbers == list(range(len(found)))
    assert started[0].poll() is not None


def test_without_python_or_a_second_processor_the_figures_are_drawn_here(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    assert painters._helper_count(2) == 0
    monkeypatch.setattr(sys, "executable", "")
    assert painters._helper_count(100) == 0


def test_pictures_can_be_omitted(tmp_path: Path) -> None:
    data = load("humanoid_reach").resolved()
    data["simulation"] |= {"time_step": 1e-2, "duration": 0.05}
    oo.run(data, tmp_path / "none", quiet=True, figures=False, recording=False)
    assert not (tmp_path / "none" / "figures").exists() and not (tmp_path / "none" / "run.rrd").exists()
    oo.run(data, tmp_path / "figures", quiet=True, recording=False)
    assert (tmp_path / "figures" / "figures").is_dir() and not (tmp_path / "figures" / "run.rrd").exists()
    oo.run(data, tmp_path / "recording", quiet=True, figures=False)
    assert (
        not (tmp_path / "recording" / "figures").exists() and (tmp_path / "recording" / "run.rrd").is_file()
    )
