"""Runs with ``compress=True``: numpy, the reader and an interrupted run open a compressed ``trace.npz``."""

from __future__ import annotations

import errno
import io
import tracemalloc
import zipfile
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest
from run_files import SHORT, columns_of, plain, stream_all, without_times
from typer.testing import CliRunner

import onorbit_rs as oo
from onorbit_rs.cli.app import app
from onorbit_rs.exceptions import OutputFolderError, ReadError, RunInterrupted
from onorbit_rs.output import npz_reader
from onorbit_rs.output.npz import write_arrays
from onorbit_rs.output.npz_reader import read_arrays
from onorbit_rs.output.read import read_trace
from onorbit_rs.simulation import memory, streaming


def size_of(folder: Path) -> int:
    return (folder / "trace.npz").stat().st_size


@pytest.mark.parametrize("name", ["humanoid_reach", "two_spheres"])
@pytest.mark.parametrize("is_streamed", [False, True])
def test_a_compressed_run_has_the_bits_of_an_uncompressed_run(
    name: str, is_streamed: bool, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    whole = plain(name, tmp_path / "stored", changes=SHORT)
    if is_streamed:
        stream_all(monkeypatch)
    run = plain(name, tmp_path / "small", changes=SHORT, compress=True)
    assert columns_of(tmp_path / "small") == columns_of(tmp_path / "stored")
    assert without_times(run.summary) == without_times(whole.summary)
    assert size_of(tmp_path / "small") < 0.75 * size_of(tmp_path / "stored")
    read, kept = oo.read_run(tmp_path / "small"), oo.read_run(tmp_path / "stored")
    system = {} if name == "humanoid_reach" else {"system": next(iter(run.trace.names))}
    np.testing.assert_array_equal(read.table(**system)[1], kept.table(**system)[1])
    time = np.array(run.trace.time)  # of a streamed run: from files that were removed
    np.testing.assert_array_equal(time, whole.trace.time)
    assert not (tmp_path / "small" / "checkpoint").exists()
    if name == "humanoid_reach":
        assert oo.compare(tmp_path / "small", tmp_path / "stored").parts_at is None


def test_the_same_run_gives_the_same_file(tmp_path: Path) -> None:
    for name in "ab":
        plain("free_tumble", tmp_path / name, changes=SHORT, compress=True)
    assert (tmp_path / "a" / "trace.npz").read_bytes() == (tmp_path / "b" / "trace.npz").read_bytes()


def test_the_command_line_compresses_a_run_and_its_continuation(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    def call(*words: str) -> Any:
        options = ["--no-figures", "--no-recording", "--quiet"]
        return CliRunner().invoke(app, [*words, *options], catch_exceptions=False)

    short = ["--set", "simulation.duration=0.1"]
    assert call("run", "free_tumble", "--out", str(tmp_path / "stored"), *short).exit_code == 0
    assert call("run", "free_tumble", "--out", str(tmp_path / "small"), *short, "--compress").exit_code == 0
    assert size_of(tmp_path / "small") < 0.75 * size_of(tmp_path / "stored")

    stream_all(monkeypatch, block=20)
    apply_due = streaming.Queue.apply_due

    def interrupt(queue: streaming.Queue, stepper: oo.Stepper) -> None:
        apply_due(queue, stepper)
        if stepper.time > 0.15:
            raise KeyboardInterrupt

    out = tmp_path / "interrupted"
    with monkeypatch.context() as patched, pytest.raises(RunInterrupted):
        patched.setattr(streaming.Queue, "apply_due", interrupt)
        plain("free_tumble", out, changes=SHORT, compress=True)
    assert len(read_trace(out).time) > 100
    assert call("resume", str(out), "--compress").exit_code == 0
    plain("free_tumble", tmp_path / "whole", changes=SHORT)
    assert columns_of(out) == columns_of(tmp_path / "whole")
    assert size_of(out) < 0.75 * size_of(tmp_path / "whole")


def compressed(arrays: dict[str, Any], file: Path) -> Path:
    with file.open("wb") as stream:
        write_arrays(stream, arrays, compress=True)
    return file


def test_large_compressed_arrays_are_mapped_from_temporary_files(tmp_path: Path) -> None:
    draw = np.random.default_rng(3)
    arrays = {"q": draw.normal(size=(1_000_000, 3)).round(2), "time": np.arange(5.0)}
    assert arrays["q"].nbytes > npz_reader._MAPPED
    file = compressed(arrays, tmp_path / "large.npz")
    tracemalloc.start()
    with file.open("rb") as stream:
        read = read_arrays(stream)
    assert tracemalloc.get_traced_memory()[1] < arrays["q"].nbytes
    tracemalloc.stop()
    assert isinstance(read["q"], np.memmap) and not isinstance(read["time"], np.memmap)
    for name, array in arrays.items():
        np.testing.assert_array_equal(read[name], array)
        with np.load(file) as stored:
            np.testing.assert_array_equal(stored[name], array)
    with pytest.raises(ValueError, match="read-only"):
        read["q"][0] = 0.0


def test_all_arrays_together_take_little_memory(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(npz_reader, "_MOST_EXPANDED", 1_000_000)
    arrays = {f"column{i}": np.zeros(100_000) for i in range(3)}
    with compressed(arrays, tmp_path / "many.npz").open("rb") as stream:
        read = read_arrays(stream)
    assert [isinstance(array, np.memmap) for array in read.values()] == [False, True, True]


def test_too_little_space_for_temporary_files_is_an_error(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    plain("free_tumble", tmp_path, changes=SHORT, compress=True)
    monkeypatch.setattr(npz_reader, "_MAPPED", 100)
    monkeypatch.setattr(npz_reader.shutil, "disk_usage", lambda path: SimpleNamespace(free=1000.0))
    words = r"cannot read .*trace.npz: time.npy is compressed and needs 2408 bytes in .*; set .* TMPDIR"
    with pytest.raises(ReadError, match=words) as caught:
        read_trace(tmp_path)
    assert isinstance(caught.value.__cause__, OSError) and caught.value.__cause__.errno == errno.ENOSPC


def test_a_compressed_array_that_states_an_impossible_size_is_refused() -> None:
    content = io.BytesIO()
    write_arrays(content, {"time": np.zeros(100_000)}, compress=True)
    with zipfile.ZipFile(content) as archive:
        (member,) = archive.infolist()
    assert member.file_size < npz_reader._MOST_RATIO * member.compress_size, "zeros, the extreme case"
    changed = bytearray(content.getvalue())
    at = changed.rindex(b"PK\x01\x02") + 24  # the expanded size in the directory
    assert int.from_bytes(changed[at : at + 4], "little") == member.file_size
    changed[at : at + 4] = (1 << 30).to_bytes(4, "little")
    with pytest.raises(ValueError, match=r"states 1073741824 bytes, which is impossible for its \d+ bytes"):
        read_arrays(io.BytesIO(changed))


def test_a_damaged_compressed_array_is_an_error() -> None:
    content = io.BytesIO()
    write_arrays(content, {"time": np.random.default_rng(5).normal(size=1000)}, compress=True)
    changed = bytearray(content.getvalue())
    changed[len(changed) // 2] ^= 1
    with pytest.raises(ValueError, match=r"(?i)crc|invalid|error -3|ends after"):
        read_arrays(io.BytesIO(changed))


def test_the_estimate_states_what_compression_saves(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    long = {"simulation.duration": "4000 s", "simulation.time_step": "1 ms"}
    built = oo.scenario.build.build(oo.scenario.load("free_tumble", changes=long))
    size = memory.estimated_bytes(built)
    words = (
        r"will have about 2\.\d+ GB; .* to about 1\.\d+ GB with --compress .* simulation\.record_every to 5"
    )
    with pytest.warns(UserWarning, match=words):
        memory.check_size(built, tmp_path)
    memory.check_size(built, tmp_path, compress=True)  # without a warning, which would be an error
    free = 1.8 * size
    monkeypatch.setattr(memory.shutil, "disk_usage", lambda path: SimpleNamespace(free=free))
    with pytest.raises(OutputFolderError, match=r"room, use --compress \(compress=True\), or set"):
        memory.check_size(built, tmp_path)
    memory.check_size(built, tmp_path, compress=True)
    free = 1.5 * size
    with pytest.raises(OutputFolderError, match=r"room, or set simulation.record_every"):
        memory.check_size(built, tmp_path, compress=True)


def test_the_measured_ratio_is_that_of_the_estimate(tmp_path: Path) -> None:
    changes = {"simulation.duration": "2 s", "simulation.time_step": "1 ms"}
    ratios = []
    for name in ("humanoid_reach", "free_tumble"):
        for which, compress in (("stored", False), ("small", True)):
            plain(name, tmp_path / name / which, changes=changes, compress=compress)
        ratios.append(size_of(tmp_path / name / "small") / size_of(tmp_path / name / "stored"))
    assert np.mean(ratios) == pytest.approx(memory.COMPRESSED, rel=0.05), ratios
