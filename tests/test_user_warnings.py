"""Warnings of a run refer to the line of the user that caused them."""

from __future__ import annotations

import warnings
from pathlib import Path

import pytest

import onorbit_rs as oo
from onorbit_rs.common.user_warnings import warn_user


def test_the_warning_of_an_event_that_did_not_happen_is_at_the_line_of_the_call() -> None:
    with warnings.catch_warnings(record=True) as caught:
        warnings.simplefilter("always")
        oo.run("capture_tumbling_target", quiet=True, changes={"simulation.duration": "1 s"})
    assert any("event 'grasp' did not happen" in str(one.message) for one in caught)
    assert {Path(one.filename) for one in caught} == {Path(__file__)}


def test_a_warning_without_code_of_the_user_is_issued() -> None:
    names = {"warn_user": warn_user}
    package = str(Path(oo.__file__).parent)
    code = compile("def issue():\n    warn_user('mind the gap')\nissue()", f"{package}/inside.py", "exec")
    with pytest.warns(UserWarning, match="mind the gap") as caught:
        exec(code, names)
    assert caught[0].filename == __file__
