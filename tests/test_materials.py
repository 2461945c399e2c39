"""Friction by the names of two materials, in Python and in a scenario."""

from __future__ import annotations

from pathlib import Path

import pytest
from world_runs import built, check_line_of_error

import onorbit_rs as oo
from onorbit_rs.exceptions import InputError

TEXT = """\
systems:
  a: {robot: ball}
  b: {robot: ball, initial: {position: [30 cm, 0, 0]}}
materials:
  rubber-aluminium: {static: 0.8, kinetic: 0.6}
contacts:
  - between: [a/body, b/*]
    normal: {kind: hunt_crossley, stiffness: 1e6}
    friction: {materials: [aluminium, rubber], torsional: 1 mm}
simulation: {duration: 0.2 s, time_step: 2 ms}
"""


@pytest.mark.parametrize(
    ("pair", "coefficients"),
    [
        ("[aluminium, rubber]", (0.8, 0.6)),
        ("[mild steel, aluminum]", (0.61, 0.47)),
        ("[teflon, steel]", (0.04, 0.04)),
    ],
)
def test_the_coefficients_are_those_of_the_pair(
    pair: str, coefficients: tuple[float, float], tmp_path: Path
) -> None:
    file = tmp_path / "scenario.yaml"
    file.write_text(TEXT.replace("[aluminium, rubber]", pair))
    scenario = built(file).scenario
    friction = scenario.contacts[0].build().friction
    assert friction is not None and (friction.static, friction.kinetic, friction.torsional) == (
        *coefficients,
        0.001,
    )
    assert type(scenario)(**scenario.resolved()).contacts[0].friction == scenario.contacts[0].friction


@pytest.mark.parametrize(
    ("old", "new", "line", "words"),
    [
        (
            "[aluminium, rubber]",
            "[aluminium, ruber]",
            9,
            "'aluminium' on 'ruber'.*rubber-aluminium",
        ),
        ("torsional: 1 mm", "static: 0.5", 9, "'materials' and coefficients are both given"),
        ("materials: [aluminium, rubber], torsional: 1 mm", "torsional: 1 mm", 9, "has no coefficients"),
        ("kinetic: 0.6", "kinetic: 0.9", 5, "exceeds the static coefficient"),
    ],
)
def test_errors_name_the_line(old: str, new: str, line: int, words: str, tmp_path: Path) -> None:
    check_line_of_error(built, (TEXT, old, new), line, words, tmp_path)


def test_python_lists_the_known_pairs() -> None:
    friction = oo.Friction.of("mild steel", "aluminium", torsional=0.01)
    assert (friction.static, friction.kinetic, friction.torsional) == (0.61, 0.47, 0.01)
    with pytest.raises(InputError, match=r"'cheese' on 'steel'.*known pairs: aluminium-aluminium"):
        oo.Friction.of("cheese", "steel")
