"""A short version of ``make soak``; each part also detects the fault that it looks for."""

from __future__ import annotations

import mmap
import os
import sys
import threading
from collections.abc import Iterator
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import contact_alternatives
import pytest

HERE = Path(__file__).parent / "soak"

pytestmark = pytest.mark.skipif(
    sys.platform != "linux", reason="threads, files and memory are read from /proc"
)


@pytest.fixture(scope="module")
def soak() -> Iterator[Any]:
    """Returns the modules of the campaign, which are separate from the tests."""
    with pytest.MonkeyPatch.context() as patch:
        patch.syspath_prepend(str(HERE))
        import exact_motions
        import faults
        import leaks
        import long_runs

        yield SimpleNamespace(exact_motions=exact_motions, faults=faults, leaks=leaks, long_runs=long_runs)
    for name in ("exact_motions", "faults", "leaks", "long_runs"):
        del sys.modules[name]


def test_exact_motions_pass_their_certificates_with_small_errors(soak: Any) -> None:
    motions = soak.exact_motions
    for found in (motions.spins(3, count=5, rows=3000), motions.earth_pointing(0.02, 1e-3)):
        assert found["wrong"] == [] and found["error"] < 1e-11
    assert motions.station(0.01, 5e-3)["wrong"] == []


def test_a_long_spin_is_exact_and_passes_its_certificate(soak: Any) -> None:
    found = soak.long_runs.spin(20_000, record_every=100)
    assert found["wrong"] == []
    assert found["attitude_error"] < 1e-12  # 20 rad; rounding is 1e-14


def test_a_held_capsule_does_not_drift_and_smooth_friction_is_detected(
    soak: Any, monkeypatch: pytest.MonkeyPatch
) -> None:
    found = soak.long_runs.grasp(0.4, 12.0)
    assert found["wrong"] == [] and found["drift"] < 1e-12
    monkeypatch.setattr(soak.long_runs.contact_grasp, "held", contact_alternatives.smooth)
    assert soak.long_runs.grasp(0.4, 12.0)["wrong"] != []


def test_loops_leak_nothing(soak: Any, tmp_path: Path) -> None:
    jobs = soak.leaks.loops(tmp_path)
    for name in ("run", "controller in Python", "model", "refused models", "rollout"):
        assert soak.leaks.leaks(*soak.leaks.grown(jobs[name], seconds=5.0, most=30)) == [], name


def test_leaks_of_loops_are_detected(soak: Any) -> None:
    kept: list[Any] = []
    wait = threading.Event()

    def leaks_thread() -> None:
        kept.append(threading.Thread(target=wait.wait))
        kept[-1].start()

    def leaks_memory() -> None:
        kept.append(mmap.mmap(-1, 4_000_000))  # new pages: an array may reuse freed memory
        kept[-1].write(b"\x01" * len(kept[-1]))

    def leaks_file() -> None:
        kept.append(os.fdopen(os.open(os.devnull, os.O_RDONLY)))

    try:
        reports = [
            soak.leaks.leaks(*soak.leaks.grown(job, seconds=5.0, most=20))
            for job in (leaks_thread, leaks_memory, leaks_file)
        ]
    finally:
        wait.set()
        for one in kept:
            if isinstance(one, threading.Thread):
                one.join()
            else:
                one.close()
    assert reports[0][0] == "14 threads"
    assert len(reports[1]) == 1 and reports[1][0].endswith(" MB")
    assert reports[2] == ["14 open files"]


def test_a_run_on_a_full_disk_is_rejected_and_later_has_the_same_bits(soak: Any, tmp_path: Path) -> None:
    found = soak.faults.fault_campaign(tmp_path, seed=3, seconds=60.0, most=1, duration=0.5)
    assert found["wrong"] == []
    assert found["runs"] == 1
