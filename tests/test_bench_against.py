"""``make bench-against`` measures the named revisions and distinguishes changes of speed from noise."""

from __future__ import annotations

import math
import random
import subprocess
import sys
from collections.abc import Iterator
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import pytest

VERSUS = Path(__file__).parents[1] / "benches" / "versus"


@pytest.fixture
def versus(monkeypatch: pytest.MonkeyPatch) -> Iterator[Any]:
    before = set(sys.modules)
    monkeypatch.syspath_prepend(str(VERSUS))
    import build_comparison
    import revisions

    yield SimpleNamespace(build_comparison=build_comparison, revisions=revisions)
    for name in set(sys.modules) - before:
        if str(getattr(sys.modules[name], "__file__", "")).startswith(str(VERSUS)):
            del sys.modules[name]


def test_the_confidence_interval_agrees_with_published_tables(versus: Any) -> None:
    # Conover, Practical Nonparametric Statistics: 14th and 28th of 41, first and last of six, none of five
    assert versus.build_comparison.interval([float(x) for x in range(1, 42)]) == (14.0, 28.0)
    assert versus.build_comparison.interval([3.0, 1.0, 2.0, 6.0, 5.0, 4.0]) == (1.0, 6.0)
    assert versus.build_comparison.interval([1.0] * 5) == (-math.inf, math.inf)


@pytest.mark.parametrize(
    ("slower", "expected"), [(1.0, "same"), (1.015, "same"), (1.06, "SLOWER"), (0.94, "faster")]
)
def test_a_change_of_speed_is_distinguished_from_noise(versus: Any, slower: float, expected: str) -> None:
    draw = random.Random(7)
    # other processes slow down single rounds of either side by half
    times = [[draw.gauss(1.0, 0.01) * draw.choice([1.0, 1.0, 1.0, 1.5]) for _ in range(41)] for _ in range(2)]
    ratios = [other / (slower * here) for other, here in zip(*times, strict=True)]
    assert versus.build_comparison.verdict(*versus.build_comparison.interval(ratios)) == expected


def test_the_working_tree_is_measured_with_uncommitted_changes(
    versus: Any, monkeypatch: pytest.MonkeyPatch, tmp_path: Path
) -> None:
    def run(*words: str) -> None:
        identity = ["-c", "user.name=a", "-c", "user.email=a@b"]
        subprocess.run(["git", *identity, *words], cwd=tmp_path, check=True, capture_output=True)

    monkeypatch.setattr(versus.revisions, "ROOT", tmp_path)
    run("init")
    (tmp_path / "one").write_text("1")
    run("add", "one")
    run("commit", "-m", "one")
    committed = versus.revisions.git("rev-parse", "HEAD^{tree}")
    assert versus.revisions.working_tree() == committed
    (tmp_path / "two").write_text("2")
    changed = versus.revisions.working_tree()
    assert versus.revisions.git("ls-tree", "--name-only", changed).split() == ["one", "two"]
    assert versus.revisions.git("status", "--porcelain") == "?? two"  # nothing was staged


def test_a_tree_without_binaries_is_rejected(versus: Any, tmp_path: Path) -> None:
    with pytest.raises(SystemExit, match="is not built: run cargo build"):
        versus.revisions.built(tmp_path)
