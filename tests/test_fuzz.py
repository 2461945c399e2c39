"""A short version of ``make fuzz``: corpus and mutations are parsed or rejected, findings are kept."""

from __future__ import annotations

import sys
from collections.abc import Iterator
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import pytest

from onorbit_rs.exceptions import InputError

HERE = Path(__file__).parent / "fuzz"
MUTATIONS, SEED = 20, 14
NAMES = (
    "quantity", "expression", "yaml", "scenario", "mean_elements", "tle_file", "point_file", "spice_kernel",
    "onorbitros", "trace", "summary", "manifest", "checkpoint", "controller_state", "xacro", "mesh",
    "urdf_file",
)  # fmt: skip


@pytest.fixture(scope="module")
def fuzz() -> Iterator[Any]:
    """Returns the modules of the campaign, which are separate from the tests."""
    with pytest.MonkeyPatch.context() as patch:
        from onorbit_rs.simulation import finish

        patch.setattr(finish, "write_pictures", finish.write_pictures)  # restored at the end
        patch.syspath_prepend(str(HERE))
        import rounds
        import targets
        import tried

        yield SimpleNamespace(rounds=rounds, targets=targets, tried=tried)
    for name in ("pausing", "rounds", "targets", "tried"):
        del sys.modules[name]


def corpus(fuzz: Any, name: str, room: Any) -> list[bytes]:
    files = sorted((HERE / "corpus" / name).glob("*"))
    return [file.read_bytes() for file in files] + list(fuzz.targets.seeds(name, room))


@pytest.mark.parametrize("name", NAMES)
@pytest.mark.filterwarnings("ignore")
def test_a_parser_reads_its_corpus_and_reads_or_rejects_mutations(
    fuzz: Any, name: str, tmp_path: Path
) -> None:
    trial = fuzz.tried.Trial(name, tmp_path, SEED)
    try:
        inputs = corpus(fuzz, name, trial.room)
        for data in inputs:
            trial.target(data, trial.room)  # a rejected corpus would cover nothing
        assert fuzz.tried.blind(trial, inputs, MUTATIONS) == len(inputs) + MUTATIONS
    finally:
        trial.room.close()
    assert not trial.places, [file.read_text() for file in tmp_path.glob("*.txt")]


def test_every_target_has_a_corpus_or_seeds(fuzz: Any) -> None:
    assert set(fuzz.targets.TARGETS) == set(NAMES)


def test_an_error_of_another_class_is_a_finding_and_keeps_its_input(
    fuzz: Any, monkeypatch: pytest.MonkeyPatch, tmp_path: Path
) -> None:
    def fails(data: bytes, room: Any) -> None:
        if data == b"typed":
            raise InputError("nothing is wrong with this")
        if data == b"silent":
            raise InputError("")
        if data != b"read":
            raise ZeroDivisionError(data)

    monkeypatch.setitem(fuzz.targets.TARGETS, "quantity", fails)
    trial = fuzz.tried.Trial("quantity", tmp_path, 77)
    for data in (b"read", b"typed"):
        trial(data)
    assert not trial.places
    for data in (b"first", b"second", b"silent"):
        trial(data)
    trial.room.close()
    assert [place.split()[0] for place in sorted(trial.places)] == ["InputError", "ZeroDivisionError"]
    assert sorted(file.read_bytes() for file in tmp_path.glob("*") if not file.suffix) == [
        b"first",
        b"silent",
    ]
    assert all("seed 77" in file.read_text() for file in tmp_path.glob("*.txt"))


def test_inputs_that_slow_parsers_cannot_process_go_to_fast_ones(fuzz: Any) -> None:
    rates = {"fast": 50_000.0, "fair": 5_000.0, "slow": 10.0, "broken": 50_000.0}
    calls: dict[str, list[tuple[int, int]]] = {name: [] for name in rates}

    def run(name: str, count: int, seconds: float, number: int) -> dict[str, Any]:
        done = min(count, int(rates[name] * seconds))
        calls[name].append((number, done))
        spent = {"inputs": done, "seconds": done / rates[name], "kept": 1}
        return spent | {"findings": int(name == "broken")}

    weights = {"fast": 2.0, "fair": 2.0, "slow": 1.0, "broken": 1.0}
    reports = fuzz.rounds.in_rounds(weights, 600_000, 60.0, run)
    assert sum(report["inputs"] for report in reports) == 600_000
    assert max(report["seconds"] for report in reports) <= 60.0
    assert calls == {
        "fast": [(0, 200_000), (1, 49_700)],
        "fair": [(0, 200_000), (1, 49_700)],
        "slow": [(0, 600)],  # its time limit is reached
        "broken": [(0, 100_000)],
    }
    hasty = fuzz.rounds.in_rounds(weights, 10**9, 10.0, run)  # time for fewer than these
    assert sum(report["inputs"] for report in hasty) == 10 * (50_000 + 5_000 + 10 + 50_000)
