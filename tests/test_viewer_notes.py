"""User names in the notes of a recording are shown as plain text."""

from __future__ import annotations

from pathlib import Path

import pytest
from recordings import column
from rerun.chunk import RrdReader

import onorbit_rs as oo
from onorbit_rs import viewer
from onorbit_rs.scenario import load
from onorbit_rs.scenario.build import build
from onorbit_rs.viewer.notes import escaped


@pytest.mark.parametrize(
    ("name", "expected"),
    [
        ("humanoid_reach", "humanoid_reach"),
        ("a | b", r"a \| b"),
        ("two\nlines", r"two\\nlines"),
        ("<b>bold</b>", r"\<b\>bold\</b\>"),
        ("turned \u202e round", r"turned \\u202e round"),
        ("_x_ *y* `z` [a](b) # c", r"\_x\_ \*y\* \`z\` \[a\]\(b\) \# c"),
        ("Längstisch 机器人 µ", "Längstisch 机器人 µ"),
        ("\u2028\x07\u200b", r"\\u2028\\x07\\u200b"),
    ],
)
def test_markup_in_a_name_is_shown_as_text(name: str, expected: str) -> None:
    assert escaped(name) == expected
    assert len(escaped(name).splitlines()) == 1


def test_the_table_of_the_notes_has_two_cells_per_line(tmp_path: Path) -> None:
    data = load("humanoid_reach").resolved() | {
        "name": "a|b\n<i>\u202ec",
        "description": "# not a\ntitle | x",
    }
    data["simulation"] |= {"duration": 0.01}
    run = oo.run(data, quiet=True)
    setting, notes = viewer.Setting.of(build(run.scenario)), viewer.notes(run.summary, run.scenario)
    path = viewer.write_recording(tmp_path / "run.rrd", run.trace, setting, notes=notes)
    ((text,),) = column(path, "/notes", "TextDocument:text", static=True)
    title, _, about, _, *table = text.splitlines()
    assert title == r"# a\|b\\n\<i\>\\u202ec" and about == r"\# not a title \| x"
    assert r"| scenario | a\|b\\n\<i\>\\u202ec |" in table
    for line in table:
        assert line.replace(r"\|", "").count("|") == 3, line
    assert len(RrdReader(path).recordings()) == 1
