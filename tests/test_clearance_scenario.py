"""Keep-out zones and distances of a scenario: summary, warnings, trace.npz and errors with their lines."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from world_runs import check_line_of_error, data

import onorbit_rs as oo
from onorbit_rs.cli import main

ONE = """\
robot: ball
initial: {linear_velocity: [50 cm/s, 0, 0]}
keep_out:
  - {name: port, shape: {kind: box, size: [40 cm, 1 m, 1 m]}, links: body, pose: {position: [1 m, 0, 0]}}
simulation: {duration: 4 s, time_step: 10 ms}
"""
TWO = """\
systems:
  a: {robot: ball, initial: {linear_velocity: [50 cm/s, 0, 0]}}
  b: {robot: ball, initial: {position: [1 m, 0, 0]}}
distances:
  - {name: pair, between: [a/*, b/*]}
keep_out:
  - {name: around, shape: {kind: sphere, radius: 30 cm}, links: [a/body], fixed_to: b/body}
simulation: {duration: 2 s, time_step: 10 ms}
"""


@pytest.mark.usefixtures("no_pictures")
def test_a_run_reports_violations_and_records_distances(tmp_path: Path) -> None:
    with pytest.warns(UserWarning, match="zone 'port': 'body' was inside from 1.4 s to 2.6 s, up to 0.3 m"):
        oo.run(data(ONE), tmp_path / "run", quiet=True)
    summary = json.loads((tmp_path / "run" / "summary.json").read_text())
    assert summary["clearance_port_min_m"] == pytest.approx(-0.3)
    assert summary["clearance_port_min_time_s"] == pytest.approx(2.0, abs=0.41)
    assert "zone 'port'" in summary["warnings"]
    column = np.load(tmp_path / "run" / "trace.npz")["clearance_port"]
    assert column.shape == (401, 12) and column[0, 0] == pytest.approx(0.7)
    for command in ("show", "report"):
        with pytest.raises(SystemExit) as done:
            main([command, str(tmp_path / "run"), *(["--no-viewer"] if command == "show" else [])])
        assert done.value.code == 0


@pytest.mark.usefixtures("no_pictures")
def test_a_world_reports_the_names_of_both_systems(tmp_path: Path) -> None:
    overlap, inside = (
        "'a/body' and 'b/body' overlapped from 1.6 s",
        "'a/body' was inside from 1.2 s to the end",
    )
    with pytest.warns(UserWarning, match=overlap), pytest.warns(UserWarning, match=inside):
        run: Any = oo.run(data(TWO), tmp_path / "run", quiet=True)
    assert run.summary["clearance_pair_min_m"] == pytest.approx(-0.2)
    assert inside in run.summary["warnings"] and overlap in run.summary["warnings"]
    assert np.load(tmp_path / "run" / "trace.npz")["clearance_pair"].shape == (201, 12)
    with pytest.raises(SystemExit) as done:
        main(["report", str(tmp_path / "run")])
    assert done.value.code == 0


def test_the_motion_does_not_change() -> None:
    watched = oo.run(data(TWO, distances=[], keep_out=[]), quiet=True)
    with pytest.warns(UserWarning):
        found = oo.run(data(TWO), quiet=True)
    for name in "ab":
        np.testing.assert_array_equal(found.trace[name].q, watched.trace[name].q)


@pytest.mark.parametrize(
    ("text", "old", "new", "line", "words"),
    [
        (ONE, "links: body", "links: bdy", 4, "did you mean 'body'"),
        (ONE, "links: body", "links: body, fixed_to: lvlh", 4, "requires an orbit"),
        (ONE, "kind: box, size: [40 cm, 1 m, 1 m]", "kind: box, size: [40 cm, 0, 1 m]", 4, "above zero"),
        (TWO, "fixed_to: b/body", "fixed_to: b/bdy", 7, "did you mean 'b/body'"),
        (TWO, "[a/*, b/*]", "[a/body, a/body]", 5, "compares no two links"),
        (TWO, "name: around", "name: pair", 5, "are named 'pair'"),
    ],
)
def test_errors_name_the_line(tmp_path: Path, text: str, old: str, new: str, line: int, words: str) -> None:
    check_line_of_error(lambda file: oo.run(file, quiet=True), (text, old, new), line, words, tmp_path)
