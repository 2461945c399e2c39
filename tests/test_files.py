"""Readers of user files: devices, pipes, and files that are too large, binary, nested or damaged."""

from __future__ import annotations

import io
import os
import random
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from commands import refusal
from test_earth import kernel, series

import onorbit_rs as oo
from onorbit_rs.common import files, input_files
from onorbit_rs.exceptions import NotFoundError, OnOrbitError, ReadError
from onorbit_rs.robots.expand import expand
from onorbit_rs.scenario import load
from onorbit_rs.scenario.build import build
from onorbit_rs.scenario.control import PythonController
from onorbit_rs.scenario.csv_table import read_table
from onorbit_rs.scenario.user_code import create_object, inspect_source
from onorbit_rs.scenario.yaml_lines import read_yaml
from onorbit_rs.tools.interop import onorbitros

MINE: Any = {"class": "Mine"}
EPOCH = "2024-01-10T00:00:00 TT"


def orbit(**part: str) -> Any:
    rigid = {"rigid_body": {"mass": 1.0, "inertia": [1.0, 2.0, 3.0]}}
    return build(load({"robot": rigid, "orbit": part, "simulation": {"duration": 1.0}}))


READERS: dict[str, Callable[[Path], Any]] = {
    "scenario": load,
    "TLE": lambda path: orbit(kind="sgp4", tle_file=str(path)),
    "OMM": lambda path: orbit(kind="sgp4", omm_file=str(path)),
    "points of a path": lambda path: orbit(kind="custom_path", file=str(path)),
    "columns of a CSV": lambda path: read_table(path, {"t": ("t",)}, ("t",)),
    "URDF": lambda path: oo.Model.from_urdf(path),
    "robot of a scenario": lambda path: build(
        load({"robot": {"urdf": str(path)}, "simulation": {"duration": 1.0}})
    ),
    "xacro": lambda path: expand(path),
    "controller": lambda path: inspect_source(
        PythonController(kind="python", file=str(path), **MINE), Path()
    ),
    "controller to run": lambda path: create_object(
        PythonController(kind="python", file=str(path), **MINE), Path()
    ),
    "gravity field": lambda path: oo.GravityField.from_gfc(path),
    "Earth orientation": lambda path: oo.Earth(EPOCH, eop=path),
    "space weather": lambda path: oo.Nrlmsise00(table=path),
    "SPICE kernel": lambda path: oo.Earth(EPOCH, ephemeris=path),
    "OnOrbitROS": lambda path: onorbitros.convert([path]),
}


def needs(name: str) -> None:
    if name == "SPICE kernel":
        pytest.importorskip("jplephem.spk", reason="jplephem, which is in the test extra, is not installed")
    if name == "xacro":
        pytest.importorskip("xacro", reason="xacro, which is in the test extra, is not installed")


@pytest.mark.timeout(30)
@pytest.mark.skipif(not hasattr(os, "mkfifo"), reason="there are no pipes in folders here")
@pytest.mark.parametrize("name", READERS)
def test_devices_and_pipes_are_rejected_without_reading(tmp_path: Path, name: str) -> None:
    needs(name)
    pipe = tmp_path / "pipe"
    os.mkfifo(pipe)
    for path in (pipe, Path("/dev/zero")):
        with pytest.raises(OnOrbitError, match="pipe or a device"):
            READERS[name](path)


@pytest.mark.parametrize("name", READERS)
def test_missing_folders_and_binary_files_are_named(tmp_path: Path, name: str) -> None:
    needs(name)
    with pytest.raises(NotFoundError, match="nowhere"):
        READERS[name](tmp_path / "nowhere")
    with pytest.raises(ReadError):
        READERS[name](tmp_path)
    binary = tmp_path / "binary"
    binary.write_bytes(bytes(range(256)))
    with pytest.raises(OnOrbitError, match="binary"):
        READERS[name](binary)


def test_check_of_a_pipe_terminates(tmp_path: Path) -> None:
    if not hasattr(os, "mkfifo"):
        pytest.skip("there are no pipes in folders here")
    os.mkfifo(tmp_path / "mine.yaml")
    assert "pipe or a device" in refusal("check", tmp_path / "mine.yaml")


def test_no_file_is_read_beyond_its_limit(tmp_path: Path) -> None:
    file = tmp_path / "mine.txt"
    file.write_text("1234")
    assert input_files.read_text(file, 4) == "1234"
    with pytest.raises(ReadError, match="more than 3 bytes"):
        input_files.read_text(file, 3)
    with file.open("wb") as stream:
        stream.truncate(100_000_001)  # a sparse file
    for name in ("scenario", "TLE", "OMM", "URDF", "Earth orientation", "space weather", "OnOrbitROS"):
        with pytest.raises(OnOrbitError, match=r"larger than|more than \d+"):
            READERS[name](file)


def test_a_file_that_grows_while_it_is_read_is_rejected(tmp_path: Path) -> None:
    (tmp_path / "small").write_bytes(b"x")

    class Grown(io.BytesIO):
        def fileno(self) -> int:
            return small.fileno()

    with (tmp_path / "small").open("rb") as small:
        assert files.read_bounded(Grown(b"x" * 10), 10) == b"x" * 10
        with pytest.raises(ValueError, match="more than 10 bytes"):
            files.read_bounded(Grown(b"x" * 11), 10)


@pytest.mark.skipif(not hasattr(os, "mkfifo"), reason="only POSIX has named pipes")
def test_a_pipe_that_replaces_a_file_does_not_block(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    os.mkfifo(tmp_path / "pipe")
    monkeypatch.setattr(input_files, "check_regular", lambda *_: None)  # still a file at this instant
    with pytest.raises(ReadError, match="must be a regular file"):
        input_files.read_bytes(tmp_path / "pipe", 10)


@pytest.mark.timeout(60)
@pytest.mark.parametrize(
    "text",
    [
        "[" * 2000,
        "{a: " * 20_000,
        "- " * 20_000 + "1",
        "\n".join(f"a{k}: &a{k} [{', '.join([f'*a{k - 1}' if k else 'x'] * 9)}]" for k in range(12)),
        "a: &a [*a]",
    ],
    ids=["lists", "mappings", "items", "alias bomb", "alias of itself"],
)
def test_deeply_nested_yaml_raises_a_typed_error(tmp_path: Path, text: str) -> None:
    file = tmp_path / "mine.yaml"
    file.write_text(text)
    with pytest.raises(OnOrbitError, match=r"nested too deeply|including those of aliases"):
        read_yaml(file)


def test_a_deeply_nested_mapping_raises_a_typed_error() -> None:
    deep: Any = 1.0
    for _ in range(100_000):
        deep = {"a": deep}
    with pytest.raises(OnOrbitError):
        load(deep)
    with pytest.raises(OnOrbitError):
        load({"robot": deep, "simulation": {"duration": 1.0}})


def small_kernel(path: Path) -> bytes:
    start, length = 24 * 365.25 * 86_400.0, 64 * 86_400.0
    bodies = [(10, 0), (3, 0), (301, 3), (399, 3)]
    kernel(path, [(*pair, start, length, series(k, 1e6, pieces=1)) for k, pair in enumerate(bodies)])
    return path.read_bytes()


@pytest.mark.timeout(60)
def test_damaged_spice_kernels_raise_typed_errors(tmp_path: Path) -> None:
    needs("SPICE kernel")
    whole = small_kernel(tmp_path / "whole.bsp")
    oo.Earth(EPOCH, ephemeris=tmp_path / "whole.bsp")
    damaged, rng, refused = tmp_path / "damaged.bsp", random.Random(14), 0
    cases = [whole[:size] for size in range(0, len(whole), 397)]
    in_circle = bytearray(whole)
    in_circle[1024:1032] = np.array(2.0).tobytes()  # the summary record points to itself
    cases.append(bytes(in_circle))
    for _ in range(150):
        one = bytearray(whole)
        for _ in range(rng.randint(1, 4)):
            place = rng.choice([rng.randrange(100), rng.randrange(1024, 1300), rng.randrange(len(whole))])
            one[place] = rng.randrange(256)
        cases.append(bytes(one))
    for case in cases:
        damaged.write_bytes(case)
        try:
            oo.Earth(EPOCH, ephemeris=damaged)
        except OnOrbitError:
            refused += 1
    assert refused > len(whole) // 397
