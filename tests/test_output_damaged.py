"""Damaged files of a folder raise typed errors that name the file, without excessive memory use."""

from __future__ import annotations

import io
import json
import random
import struct
import tracemalloc
import zipfile
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from results import listed

import onorbit_rs as oo
from onorbit_rs.cli.summary import print_summary
from onorbit_rs.exceptions import CheckpointError, NotFoundError, OnOrbitError, ReadError
from onorbit_rs.output.npz_reader import read_arrays
from onorbit_rs.output.read import read_summary, read_trace
from onorbit_rs.output.sealed import sealed
from onorbit_rs.report.page import page


def npz(compression: int = zipfile.ZIP_STORED, **members: bytes) -> bytes:
    content = io.BytesIO()
    with zipfile.ZipFile(content, "w", compression) as archive:
        for name, data in members.items():
            archive.writestr(f"{name}.npy", data)
    return content.getvalue()


def npy(array: Any) -> bytes:
    content = io.BytesIO()
    np.save(content, array, allow_pickle=True)
    return content.getvalue()


def refused(folder: Path, content: bytes, words: str) -> None:
    (folder / "trace.npz").write_bytes(content)
    with pytest.raises(ReadError, match=rf"cannot read .*trace\.npz: .*{words}") as caught:
        read_trace(listed(folder))
    assert caught.value.path == str(folder / "trace.npz")


def test_an_npz_of_another_compression_is_not_read(tmp_path: Path) -> None:
    zeros = npy(np.zeros(4_000_000))
    content = npz(zipfile.ZIP_LZMA, time=zeros, q=zeros, v=zeros, momentum=zeros)
    assert len(content) < 1e-2 * 4 * len(zeros)
    words = "time.npy is compressed by method 14 of the zip format; arrays must be uncompressed, or"
    refused(tmp_path, content, words)  # imports would count as memory
    tracemalloc.start()
    refused(tmp_path, content, words)
    assert tracemalloc.get_traced_memory()[1] < 3e6
    tracemalloc.stop()


def test_an_npz_that_decompresses_to_much_more_takes_little_memory(tmp_path: Path) -> None:
    zeros = npy(np.zeros(4_000_000))
    content = npz(zipfile.ZIP_DEFLATED, time=zeros, q=zeros, v=zeros, momentum=zeros)
    assert len(content) < 1e-2 * 4 * len(zeros)
    words = r"column 'q' has shape \(4000000,\); expected"
    refused(tmp_path, content, words)  # imports would count as memory
    tracemalloc.start()
    refused(tmp_path, content, words)
    assert tracemalloc.get_traced_memory()[1] < len(zeros)
    tracemalloc.stop()


def test_a_header_that_claims_too_much_data_takes_no_memory(tmp_path: Path) -> None:
    honest = npy(np.zeros(3))
    claims = honest.replace(b"(3,)", b"(9**9,)").replace(b"    \n", b" \n", 1)
    huge = honest.replace(b"(3,), }" + b" " * 13, b"(30000000000000,), }")
    none = "not an array of real numbers or texts in the format that a run writes"
    for member, words in (
        (claims, none), (huge, "contains 24 bytes, but its shape"), (b"\x93NUMPY\x03\x00" + honest[8:], none),
        (npy(np.array([{}])), none), (npy(np.array(["text"])), "column 'time' has texts; expected numbers"),
        (b"", none), (b"no array", none), (honest[:-8], "contains 16 bytes, but its shape"),
    ):  # fmt: skip
        refused(tmp_path, npz(time=member), words)


@pytest.mark.parametrize(
    ("column", "array", "words"),
    [
        ("time", np.array(["0", "1", "2"]), "column 'time' has texts; expected numbers"),
        ("q", np.array([["0"] * 7] * 3), "column 'q' has texts; expected numbers"),
        ("joint_names", np.zeros(3), "column 'joint_names' has numbers; expected texts"),
    ],
)
def test_texts_and_numbers_are_not_exchanged(
    column: str, array: np.ndarray[Any, Any], words: str, tmp_path: Path
) -> None:
    whole = {
        "time": np.arange(3.0),
        "q": np.zeros((3, 7)),
        "v": np.zeros((3, 6)),
        "momentum": np.zeros((3, 6)),
    }
    refused(tmp_path, npz(**{name: npy(rows) for name, rows in (whole | {column: array}).items()}), words)


def test_overlapping_columns_are_rejected(tmp_path: Path) -> None:
    """A zip whose directory lists one part of the file many times can expand to any size."""
    content = npz(**{f"column_{number:02d}": npy(np.zeros(1000)) for number in range(20)})
    first = content.index(b"PK\x01\x02")
    changed = bytearray(content)
    place = first
    while (place := changed.find(b"PK\x01\x02", place)) >= 0:  # every entry begins where the first does
        struct.pack_into("<I", changed, place + 42, 0)
        struct.pack_into("<II", changed, place + 20, len(content), len(content))
        place += 4
    refused(tmp_path, bytes(changed), "but the file has")
    twice = io.BytesIO()
    with zipfile.ZipFile(twice, "w") as archive, pytest.warns(UserWarning, match="Duplicate name"):
        archive.writestr("q.npy", npy(np.zeros(1)))
        archive.writestr("q.npy", npy(np.zeros(1)))
    refused(tmp_path, twice.getvalue(), "more than once")


def test_an_npz_file_written_by_numpy_is_read_correctly() -> None:
    draw = np.random.default_rng(14)
    arrays = {
        "rows": draw.normal(size=(5, 3)), "columns": np.asfortranarray(draw.normal(size=(4, 2, 3))),
        "empty": np.zeros((0, 7)), "number": np.array(2.5), "whole": np.arange(6), "true": np.array([True]),
    }  # fmt: skip
    stream = io.BytesIO()
    np.savez(stream, allow_pickle=False, **arrays)
    read = read_arrays(stream)
    assert list(read) == list(arrays)
    for name, array in arrays.items():
        assert read[name].dtype == array.dtype and read[name].shape == array.shape
        np.testing.assert_array_equal(read[name], array)


def test_a_damaged_trace_raises_a_typed_error(tmp_path: Path) -> None:
    """KeyError, BadZipFile, struct.error and MemoryError once escaped, even with a matching manifest."""
    stream = io.BytesIO()
    np.savez(stream, time=np.arange(3.0), q=np.zeros((3, 7)), v=np.zeros((3, 6)), momentum=np.zeros((3, 6)))
    content, draw, seen = stream.getvalue(), random.Random(14), 0
    for number in range(150):
        changed = bytearray(content)
        if number % 3 == 0:
            del changed[draw.randrange(len(changed)) :]
        for _ in range(draw.randrange(1, 4) if changed else 0):
            changed[draw.randrange(len(changed))] = draw.randrange(256)
        (tmp_path / "trace.npz").write_bytes(changed)
        try:
            read_trace(listed(tmp_path))
        except ReadError as error:
            assert "trace.npz" in str(error)
            seen += 1
    assert seen > 100, "seed 14"


@pytest.mark.parametrize(
    "spoilt",
    [
        b"", b"\xff\xfe\x00", b"[" * 100_000, b'{"a":' * 100_000, b'{"status": "x", "rows": [1]}',
        b'{"scenario": {"a": 1}}', b'{"wall_s": 1' + b"0" * 5000 + b"}", b" " * 17_000_000,
    ],
)  # fmt: skip
def test_a_damaged_summary_raises_a_typed_error(tmp_path: Path, spoilt: bytes) -> None:
    (tmp_path / "summary.json").write_bytes(spoilt)
    with pytest.raises(ReadError, match=r"cannot read .*summary\.json: ") as caught:
        read_summary(listed(tmp_path))
    assert len(str(caught.value)) < 600


@pytest.mark.parametrize(
    "spoilt",
    ["[]", "null", "3", '{"certificate_passed": "yes"}', '{"simulated_s": "long"}', '{"status": 1}', "{"],
)
def test_an_invalid_summary_is_rejected_with_a_fix(tmp_path: Path, spoilt: str) -> None:
    (tmp_path / "summary.json").write_text(spoilt)
    with pytest.raises(ReadError, match=r"cannot read .*: .*; repeat the run .* onorbit run .* --out DIR"):
        read_summary(listed(tmp_path))


def test_a_summary_with_entries_of_other_types_prints_or_is_rejected(tmp_path: Path) -> None:
    whole = oo.run({"robot": "humanoid_torso", "simulation": {"duration": 0.01}}, quiet=True).summary
    printed = 0
    for name in whole:
        for value in (None, -1, "text", []):
            (tmp_path / "summary.json").write_text(json.dumps(whole | {name: value}))
            try:
                summary = read_summary(listed(tmp_path))
                print_summary(summary, tmp_path)
                assert page(
                    summary, description="", scenario="", pictures=[], remarks=[], again="", version=""
                )
                printed += 1
            except ReadError as error:
                assert "summary.json" in str(error)
    assert printed > 2 * len(whole)


@pytest.mark.parametrize(
    "spoilt", [b"", b"{", b"[]", b"3", b"[" * 100_000, b"\xff", b"{}", b'{"sha256": 1}', b'{"rows": 1e999}']
)
def test_a_damaged_state_raises_a_typed_error(tmp_path: Path, spoilt: bytes) -> None:
    (tmp_path / "scenario.yaml").write_text("robot: humanoid_torso\nsimulation: {duration: 1 s}\n")
    (tmp_path / "checkpoint").mkdir()
    (tmp_path / "checkpoint" / "state.json").write_bytes(spoilt)
    with pytest.raises(CheckpointError, match=r"damaged or cannot be read: .*state\.json \(") as caught:
        oo.resume(tmp_path)
    assert caught.value.path == str(tmp_path / "checkpoint" / "state.json")


@pytest.mark.parametrize("spoilt", [b"", b"{", b"[]", b"[" * 100_000, b"\xff", b'{"format": 1, "files": {}}'])
def test_a_damaged_manifest_raises_a_typed_error(tmp_path: Path, spoilt: bytes) -> None:
    (tmp_path / "manifest.json").write_bytes(spoilt)
    for ask in (read_summary, read_trace):
        with pytest.raises(ReadError, match=r"cannot read .*manifest\.json: .*remove manifest\.json to read"):
            ask(tmp_path)
    with pytest.raises(OnOrbitError, match=r"manifest\.json"):
        oo.run("kepler_orbit", tmp_path, force=True)


@pytest.mark.parametrize(
    ("files", "checkpoint"),
    [({"figures/\ud800.png": {"size": 1, "sha256": "0"}}, []), ({}, ["state.json", "\udfff.f64"])],
)
def test_a_manifest_with_half_a_surrogate_pair_in_a_name_is_rejected(
    tmp_path: Path, files: dict[str, Any], checkpoint: list[str]
) -> None:
    """``--force``, which searches the listed files, once raised UnicodeEncodeError."""
    (tmp_path / "checkpoint").mkdir()
    record = {"format": 1, "files": files, "checkpoint": checkpoint}
    (tmp_path / "manifest.json").write_bytes(sealed(record))
    for ask in (read_summary, lambda folder: oo.run("kepler_orbit", folder, force=True)):
        with pytest.raises(
            ReadError,
            match=r"manifest\.json: it (names|lists) .*, so the files of the run cannot be verified",
        ):
            ask(tmp_path)


def test_folders_in_place_of_files_raise_typed_errors(tmp_path: Path) -> None:
    for name in ("summary.json", "trace.npz", "manifest.json"):
        folder = tmp_path / name.replace(".", "_")
        (folder / name).mkdir(parents=True)
        with pytest.raises((ReadError, NotFoundError), match="must be a regular file"):
            read_trace(folder) if name == "trace.npz" else read_summary(folder)
