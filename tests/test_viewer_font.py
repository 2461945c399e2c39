"""All characters sent to the viewer exist in its font; a missing one would crash the viewer."""

from __future__ import annotations

import io
import mmap
import re
import struct
from pathlib import Path
from typing import Any

import pytest
from fontTools.ttLib import TTFont
from recordings import chunks
from rerun.chunk import RrdReader

import onorbit_rs as oo
from onorbit_rs.viewer.font import shown
from onorbit_rs.viewer.screen import command_of

_ROBOT = """<robot name="腕">
<link name="基"><inertial><mass value="50"/>
<inertia ixx="3" iyy="4" izz="5" ixy="0" ixz="0" iyz="0"/></inertial>
<visual><geometry><box size="0.6 0.6 0.6"/></geometry></visual></link>
<link name="連"><inertial><mass value="3"/>
<inertia ixx="1" iyy="1" izz="1" ixy="0" ixz="0" iyz="0"/></inertial>
<visual><geometry><box size="0.4 0.1 0.1"/></geometry></visual></link>
<joint name="関節" type="revolute"><parent link="基"/><child link="連"/><axis xyz="0 0 1"/>
<limit lower="-2" upper="2" velocity="1" effort="20"/></joint>
<link name="手"/><joint name="固" type="fixed"><parent link="連"/><child link="手"/></joint></robot>"""


def test_shown_text_is_in_the_viewers_font() -> None:
    letters = [chr(code) for code in range(0x110000)]
    as_they_are = {letter for letter in letters if shown(letter) == letter}
    assert {ord(letter) for letter in as_they_are} <= _inter()
    assert set("aäЖωµ²→≤Δ°·−√…€") <= as_they_are
    assert not as_they_are & set("関手🚀\u200b\n")


def test_different_names_are_shown_differently() -> None:
    assert shown("関節 1") == r"\u95a2\u7bc0 1"
    assert len({shown(name) for name in ("関", "節", "手", "🚀")}) == 4


def test_every_text_of_a_recording_is_in_the_font(tmp_path: Path) -> None:
    (tmp_path / "robot.urdf").write_text(_ROBOT)
    held = {
        "kind": "joint_pid",
        "name": "arm",
        "p": 1.0,
        "d": 1.0,
        "i": 0.0,
        "reference": {"kind": "joint_hold"},
    }
    oo.run(
        {
            "name": "運🚀",
            "description": "説明 🚀",
            "robot": str(tmp_path / "robot.urdf"),
            "tool": "手",
            "orbit": {"kind": "kepler", "semi_major_axis": 7e6, "inclination": 1.0},
            "environment": [{"kind": "gravity_gradient"}],
            "controllers": [held | {"joints": ["関節"]}],
            "simulation": {"duration": 0.1, "time_step": 0.01, "record_wrenches": True},
        },
        tmp_path / "out",
        quiet=True,
    )
    texts = set(_texts(tmp_path / "out" / "run.rrd"))
    assert any(r"\u95a2\u7bc0" in text for text in texts) and any("kinetic energy" in text for text in texts)
    assert [text for text in texts for line in text.split("\n") if shown(line) != line] == []


def _texts(path: Path) -> list[str]:
    """Returns all texts in a recording and its blueprint."""
    reader = RrdReader(path)
    found: list[str] = []
    (blueprint,) = reader.blueprints()
    for chunk in [*chunks(path), *reader.stream(store=blueprint).to_chunks()]:
        found.append(chunk.entity_path)
        for values in chunk.to_record_batch().columns:
            if "string" in str(values.type):
                _collect(values.to_pylist(), found)
    return found


def _collect(value: Any, found: list[str]) -> None:
    if isinstance(value, str):
        found.append(value)
    elif isinstance(value, dict):
        for part in value.values():
            _collect(part, found)
    elif isinstance(value, list):
        for part in value:
            _collect(part, found)


def _inter() -> set[int]:
    """Returns the characters of the font inside the viewer."""
    with (
        Path(command_of(0)[0]).open("rb") as file,
        mmap.mmap(file.fileno(), 0, access=mmap.ACCESS_READ) as binary,
    ):
        for found in re.finditer(
            rb"\x00\x01\x00\x00\x00[\x08-\x28].{6}(?:DSIG.{12})?GDEF", binary, re.DOTALL
        ):
            start, count = found.start(), found[0][5]
            tables = [struct.unpack_from(">4sLLL", binary, start + 12 + 16 * index) for index in range(count)]
            font = TTFont(io.BytesIO(binary[start : start + max(at + size for _, _, at, size in tables)]))
            if font["name"].getDebugName(1).startswith("Inter"):
                return set(font.getBestCmap())
    pytest.fail("the viewer holds no font named Inter")
