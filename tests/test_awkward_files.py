"""Robot files with one peculiarity each: they load, load with a warning, or are rejected with a reason."""

from __future__ import annotations

import importlib.util
import re
import warnings

import awkward
import pytest

import onorbit_rs as oo

NEEDS_NO_COMMENT = {"utf8_bom", "utf16"}  # their peculiarity does not permit a comment
HAS_XACRO = importlib.util.find_spec("xacro") is not None


def load(name: str) -> tuple[oo.Model, list[str]]:
    file = awkward.path(name)
    if file.suffix == ".xacro" and not HAS_XACRO:
        pytest.skip("xacro is not installed: pip install 'onorbit-rs[xacro]'")
    with warnings.catch_warnings(record=True) as caught:
        warnings.simplefilter("always")
        model = oo.Model.from_urdf(file)
    messages = [str(warning.message) for warning in caught]
    assert messages == model.warnings
    return model, messages


def test_every_file_is_in_the_table_and_explains_its_peculiarity() -> None:
    files = [file for file in awkward.FOLDER.iterdir() if not file.name.startswith(".")]
    assert {file.stem for file in files} == set(awkward.EXPECTED)
    for file in files:
        comment = re.search(rb"<!-- .+?\. -->", file.read_bytes())
        assert comment or file.stem in NEEDS_NO_COMMENT, file


@pytest.mark.parametrize("name", [name for name, to in awkward.EXPECTED.items() if to.loads])
def test_the_file_loads(name: str) -> None:
    expected = awkward.EXPECTED[name].text
    _, messages = load(name)
    if expected:
        assert any(expected in warning for warning in messages), messages
    else:
        assert messages == []


@pytest.mark.parametrize("name", [name for name, to in awkward.EXPECTED.items() if not to.loads])
def test_the_file_is_rejected_in_one_line(name: str) -> None:
    with pytest.raises(oo.exceptions.ModelError) as caught:
        oo.Model.from_urdf(awkward.path(name))
    said = str(caught.value)
    assert awkward.EXPECTED[name].text in said
    assert str(awkward.path(name)) in said and "\n" not in said


def test_bytes_are_not_normalised() -> None:
    """Version control or an editor might normalize these bytes."""
    first = {name: awkward.path(name).read_bytes() for name in ("crlf", "utf8_bom", "latin1_comment")}
    assert first["crlf"].count(b"\r\n") == first["crlf"].count(b"\n") > 20
    assert first["utf8_bom"].startswith(b"\xef\xbb\xbf")
    assert b"L\xe4nge" in first["latin1_comment"]
