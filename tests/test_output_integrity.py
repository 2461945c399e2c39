"""Flipped bits in output files are detected; once, 76 of 150 in a checkpoint changed a certified trace."""

from __future__ import annotations

import json
import random
import shutil
import warnings
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from commands import SPIN, onorbit, refusal

import onorbit_rs as oo
from onorbit_rs import figures
from onorbit_rs.exceptions import CheckpointError, IntegrityError, OnOrbitError, RunInterrupted
from onorbit_rs.output.checkpoint import SavedCheckpoint
from onorbit_rs.output.folder import OutputFolder
from onorbit_rs.output.manifest import MANIFEST
from onorbit_rs.output.read import SavedRun, read_summary, read_trace
from onorbit_rs.report import write_report
from onorbit_rs.scenario import load
from onorbit_rs.simulation.run import read_checkpoint

SEED, FLIPS = 14, 150


def flipped(content: bytes, draw: random.Random) -> bytes:
    """Flips one bit."""
    place = draw.randrange(8 * len(content))
    changed = bytearray(content)
    changed[place // 8] ^= 1 << place % 8
    return bytes(changed)


def tumbling() -> dict[str, Any]:
    data = load("free_tumble").resolved()
    data["simulation"] = {"duration": 0.4, "time_step": 1e-3}
    return data


class _StopsAt:
    """A progress callback that raises Ctrl-C after some checkpoints."""

    def __init__(self, folder: Path) -> None:
        self.state = folder / "checkpoint" / "state.json"

    def __call__(self, t: float, duration: float) -> None:
        if self.state.exists():
            raise KeyboardInterrupt


@pytest.fixture(scope="module")
def stopped(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Returns the folder of a stopped run with its checkpoint."""
    out = tmp_path_factory.mktemp("flips") / "out"
    data = tumbling()
    data["simulation"] |= {"duration": 400.0, "record_every": 10}  # several checkpoints on any machine
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr("onorbit_rs.simulation.finish.write_pictures", lambda *_, **__: None)
        patch.setattr("onorbit_rs.simulation.run.progress_bar", _progress(_StopsAt(out)))
        with pytest.raises(RunInterrupted, match="continue with: onorbit resume"):
            oo.run(data, out, quiet=True, checkpoint_every=0.0)
    return out


def _progress(move: Any) -> Any:
    from contextlib import contextmanager

    from onorbit_rs.common.progress import Progress

    @contextmanager
    def bar(*_: Any, **__: Any) -> Any:
        yield Progress(move)

    return bar


def written(saved: SavedCheckpoint) -> dict[str, tuple[int, int, str]]:
    """Returns numbers and widths of the rows of each column, and the digests of the columns."""
    return {name: (own.rows, own.width, own.digest.hexdigest()) for name, own in saved.written.items()}


def test_a_checkpoint_with_a_flipped_bit_is_rejected_or_equivalent(stopped: Path, tmp_path: Path) -> None:
    from onorbit_rs.simulation.run import _digest

    out = Path(shutil.copytree(stopped, tmp_path / "out"))
    digest = _digest(load(out / "scenario.yaml"))
    whole = read_checkpoint(out, digest)
    files = sorted((out / "checkpoint").iterdir())
    assert len(files) > 10
    draw, refused = random.Random(SEED), 0
    for number in range(FLIPS):
        file = files[number % len(files)] if number % 2 else out / "checkpoint" / "state.json"
        content = file.read_bytes()
        file.write_bytes(flipped(content, draw))
        try:
            read = read_checkpoint(out, digest)
        except CheckpointError as error:
            assert file.name in str(error)
            refused += 1
        else:  # such as 1e-5 for 1E-5: equal numbers
            assert json.loads(read.checkpoint.state) == json.loads(whole.checkpoint.state)
            assert read.checkpoint.wall_s == whole.checkpoint.wall_s and written(read) == written(whole)
            for name, rows in whole.checkpoint.columns.items():
                assert read.checkpoint.columns[name][:].tobytes() == rows[:].tobytes(), (number, name)
        file.write_bytes(content)
    assert refused > 0.9 * FLIPS, f"seed {SEED}"
    assert written(read_checkpoint(out, digest)) == written(whole)


@pytest.fixture(scope="module")
def recorded(tmp_path_factory: pytest.TempPathFactory) -> Path:
    folder = tmp_path_factory.mktemp("recorded")
    (folder / "mine.yaml").write_text(SPIN)
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr("onorbit_rs.simulation.finish.write_pictures", _write_a_recording)
        assert onorbit("run", "mine.yaml", "--out", "out", cwd=folder).returncode == 0
    return folder / "out"


def _write_a_recording(folder: OutputFolder, *_: Any, **__: Any) -> None:
    with folder.writing("run.rrd") as path:
        path.write_bytes(random.Random(SEED).randbytes(10_000))


def _read_all(folder: Path) -> tuple[Any, ...]:
    saved = SavedRun(folder)
    trace = saved.trace()
    rows = b"".join(np.asarray(getattr(trace, name)).tobytes() for name in trace.columns())
    saved.check("run.rrd")
    return saved.summary(), saved.scenario_text(), rows, (folder / "run.rrd").read_bytes()


def test_a_result_with_a_flipped_bit_is_rejected_or_equivalent(recorded: Path, tmp_path: Path) -> None:
    out = Path(shutil.copytree(recorded, tmp_path / "out"))
    whole = _read_all(out)
    names = ("trace.npz", "summary.json", "scenario.yaml", "run.rrd", MANIFEST)
    draw, refused = random.Random(SEED), 0
    for number in range(FLIPS):
        file = out / names[number % len(names)]
        content = file.read_bytes()
        file.write_bytes(flipped(content, draw))
        try:
            assert _read_all(out) == whole, (number, file)
        except OnOrbitError as error:
            assert file.name in str(error)
            refused += 1
        file.write_bytes(content)
    assert refused > 0.9 * FLIPS, f"seed {SEED}"
    assert _read_all(out) == whole


@pytest.mark.parametrize("name", ["trace.npz", "summary.json", "scenario.yaml"])
def test_a_file_edited_by_the_user_is_named_with_a_fix(recorded: Path, tmp_path: Path, name: str) -> None:
    out = Path(shutil.copytree(recorded, tmp_path / "out"))
    file = out / name
    for content, why in (
        (file.read_bytes() + b"\n", "bytes, not"),
        (b"%" + file.read_bytes()[1:], "SHA-256"),
    ):
        file.write_bytes(content)
        for ask in (write_report, oo.compare):
            with pytest.raises(
                IntegrityError, match=f"{name} in .* has changed since the run.*{why}"
            ) as caught:
                ask(out)
            assert caught.value.path == str(file) and "onorbit run " in str(caught.value)
            assert caught.value.expected != caught.value.got and isinstance(caught.value, OSError)
        for command in ("report", "compare", *(["show"] if name != "trace.npz" else [])):
            assert f"{name} in " in refusal(command, out)
    with pytest.raises(IntegrityError, match=f"{name} in"):
        read_trace(out) if name == "trace.npz" else SavedRun(out).check(name)


def test_a_changed_recording_is_not_opened(recorded: Path, tmp_path: Path) -> None:
    out = Path(shutil.copytree(recorded, tmp_path / "out"))
    (out / "run.rrd").write_bytes(b"another")
    assert onorbit("show", out, "--no-viewer").returncode == 0
    done = onorbit("show", out)
    assert done.returncode == 2 and "run.rrd in " in done.stderr


def test_a_folder_of_an_earlier_version_is_read_with_a_warning(
    recorded: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    out = Path(shutil.copytree(recorded, tmp_path / "out"))
    (out / MANIFEST).unlink()
    with pytest.warns(UserWarning, match=r"has no manifest.json .it was removed, or an earlier"):
        assert read_summary(out) == read_summary(recorded)
    done = onorbit("show", out, "--no-viewer")
    assert done.returncode == 0 and len(done.stderr.splitlines()) == 1
    monkeypatch.setattr(figures, "drawings", lambda subject: [])
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        write_report(out)
    assert (out / "report.html").is_file() and not (out / MANIFEST).exists()
    assert "manifest.json does not list it" in refusal("run", out / "scenario.yaml", "--out", out, "--force")


def test_a_checkpoint_of_an_earlier_version_is_rejected(stopped: Path, tmp_path: Path) -> None:
    out = Path(shutil.copytree(stopped, tmp_path / "out"))
    file = out / "checkpoint" / "state.json"
    record = json.loads(file.read_text())
    del record["sha256"]
    file.write_text(json.dumps(record))
    with pytest.raises(CheckpointError, match=r"it has no checksum\); run the scenario again"):
        oo.resume(out)
