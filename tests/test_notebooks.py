"""Notebooks as plain Python with short parameters; ``make test-notebooks`` runs them whole, in Jupyter."""

from __future__ import annotations

import ast
import warnings
from pathlib import Path
from typing import Any

import matplotlib
import pytest
from notebook_cells import (
    FOLDER,
    NOTEBOOKS,
    SHORT,
    code_cells,
    content_of,
    is_expected,
    parameters_of,
    path_of,
    unexpected_lines,
)

import onorbit_rs as oo
from onorbit_rs.displays.scene import recording_of


def display(shown: Any) -> None:
    """Shows the value of a cell as a notebook does: HTML, a picture or text."""
    html = getattr(shown, "_repr_html_", lambda: None)()
    png = getattr(shown, "_repr_png_", lambda: None)()
    assert html or png or repr(shown)


def run_cells(cells: list[tuple[str, set[str]]], short: dict[str, Any]) -> dict[str, Any]:
    """Runs cells in one namespace and returns it; the parameters follow the cell that is tagged so."""
    names: dict[str, Any] = {}
    for source, tags in cells:
        tree = ast.parse(source)
        last = tree.body.pop() if tree.body and isinstance(tree.body[-1], ast.Expr) else None
        exec(compile(tree, "<cell>", "exec"), names)
        if isinstance(last, ast.Expr):
            display(eval(compile(ast.Expression(last.value), "<cell>", "eval"), names))
        if "parameters" in tags:
            names |= short
    return names


@pytest.mark.parametrize("name", NOTEBOOKS)
def test_a_short_notebook_runs(name: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    if name == "campaign":
        pytest.importorskip("pyarrow", reason="pyarrow is in the campaign extra")
    viewed: list[bytes] = []
    monkeypatch.setattr(oo, "show", lambda run: viewed.append(recording_of(run)))  # there is no browser
    monkeypatch.chdir(tmp_path)
    matplotlib.use("Agg")
    from matplotlib import pyplot as plt

    monkeypatch.setattr(plt, "show", lambda: plt.close("all"))
    with warnings.catch_warnings(record=True) as caught:
        warnings.simplefilter("always")
        run_cells(code_cells(content_of(path_of(name))), SHORT[name])
    assert [str(one.message) for one in caught if not is_expected(str(one.message), name)] == []
    assert all(recording.startswith(b"RRF2") for recording in viewed)
    assert len(viewed) == (name in ("first_run", "capture", "campaign"))


@pytest.mark.parametrize("name", NOTEBOOKS)
def test_a_notebook_stores_no_outputs_and_one_cell_of_parameters(name: str) -> None:
    content = content_of(path_of(name))
    for cell in content["cells"]:
        assert not cell.get("outputs") and cell.get("execution_count") is None, cell["id"]
    tagged = [source for source, tags in code_cells(content) if "parameters" in tags]
    assert len(tagged) == 1 and set(parameters_of(tagged[0])) == set(SHORT[name])
    assert content["cells"][0]["cell_type"] == "markdown", "a notebook begins with what it is about"


def test_every_notebook_of_the_folder_is_tested() -> None:
    assert {file.stem for file in FOLDER.glob("*.ipynb")} == set(NOTEBOOKS) == set(SHORT)


def test_a_failing_cell_and_an_unused_parameter_are_found() -> None:
    cells = [("N = 5", {"parameters"}), ("found = N", set())]
    assert run_cells(cells, {"N": 2})["found"] == 2
    with pytest.raises(ZeroDivisionError):
        run_cells([*cells, ("1 / (N - 2)", set())], {"N": 2})
    with pytest.raises(AssertionError):
        parameters_of("N = compute()")


def test_lines_on_stderr_other_than_listed_warnings_are_found() -> None:
    listed = "/tmp/a.py:3: UserWarning: event 'grasp' did not happen before the end of the run; its latch"
    other = "/tmp/a.py:3: UserWarning: another"
    assert unexpected_lines(f"{listed}\n  warnings.warn(message)\n", "campaign") == []
    assert unexpected_lines(f"{listed}\n{other}\nTraceback\n", "campaign") == [other, "Traceback"]
    assert unexpected_lines(listed, "first_run") == [listed]
