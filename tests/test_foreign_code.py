"""Python code of a scenario: ``check`` parses it without running it; other commands name it first."""

from __future__ import annotations

import json
import subprocess
import sys
from pathlib import Path
from textwrap import indent
from typing import Any

import pytest

from onorbit_rs.exceptions import ControlError, NotFoundError, OnOrbitError
from onorbit_rs.scenario import load
from onorbit_rs.scenario.build import build

IMPORTED, MADE = "it_was_imported", "it_was_constructed"
SOURCE = f"""
from pathlib import Path
Path(__file__).with_name({IMPORTED!r}).touch()

class Base:
    def update(self, t, state):
        return 0.0 * state.v[6:]

class Brake(Base):
    def __init__(self, gain, *, bias=0.0):
        Path(__file__).with_name({MADE!r}).touch()
"""


def scenario(folder: Path, source: str = SOURCE, **controller: Any) -> Path:
    (folder / "brake.py").write_text(source)
    file = folder / "mine.yaml"
    law = {"kind": "python", "file": "brake.py", "class": "Brake", "arguments": {"gain": 1.0}} | controller
    data = {
        "robot": "humanoid_torso",
        "controller": {name: value for name, value in law.items() if value is not None},
        "simulation": {"duration": 0.01, "time_step": 0.002},
    }
    file.write_text(json.dumps(data))
    return file


def onorbit(*words: str | Path) -> subprocess.CompletedProcess[str]:
    command = [sys.executable, "-m", "onorbit_rs", *map(str, words)]
    return subprocess.run(command, capture_output=True, text=True, check=False)


def test_check_runs_no_code_of_a_scenario(tmp_path: Path) -> None:
    file = scenario(tmp_path)
    done = onorbit("check", file)
    assert done.returncode == 0, done.stderr
    assert f"not executed: {tmp_path / 'brake.py'}" in done.stdout
    assert not (tmp_path / IMPORTED).exists()
    trusted = onorbit("check", file, "--trust", "--json")
    assert trusted.returncode == 0, trusted.stderr
    assert f"executing Python code of this scenario: {tmp_path / 'brake.py'}" in trusted.stderr
    assert json.loads(trusted.stdout)["code_not_run"] == []
    assert (tmp_path / MADE).exists()  # negative control: there was code to run


def test_run_and_compare_name_the_code_before_they_execute_it(tmp_path: Path) -> None:
    named = f"onorbit: executing Python code of this scenario: {tmp_path / 'brake.py'}"
    file = scenario(tmp_path, "import sys\nprint('now', file=sys.stderr)\n" + SOURCE)
    for words in (("run", file, "--quiet"), ("compare", file, file)):
        done = onorbit(*words)
        assert done.returncode == 0, done.stderr
        assert done.stderr.count(named) == 1
        assert done.stderr.index(named) < done.stderr.index("now")
    assert "executes" not in onorbit("check", "python_controller", "--trust").stderr  # of this package


def test_code_of_bundled_examples_is_not_announced(tmp_path: Path) -> None:
    done = onorbit("check", "python_controller", "--json")
    assert json.loads(done.stdout)["code_not_run"] == []


NONE: dict[str, Any] = {"arguments": {}}
CLASS = "class Brake:\n    def update(self, t, state):\n        return state.v[6:]\n"
WRONG: dict[str, tuple[str, dict[str, Any], type[OnOrbitError], str]] = {
    "no file": (CLASS, {"file": "none.py"}, NotFoundError, "no such file"),
    "no Python": ("class :", {}, ControlError, "SyntaxError"),
    "zeros": ("\0", {}, ControlError, "cannot be read as Python"),
    "deep": ("(" * 5000, {}, ControlError, "cannot be read as Python"),
    "no class": (CLASS, {"class": "Brakes"}, ControlError, "did you mean 'Brake'"),
    "no update in try": (
        "try:\n    class Brake:\n        pass\nfinally:\n    x = Brake",
        {},
        ControlError,
        "has no method update",
    ),
    "no update": ("class Brake:\n    pass", {}, ControlError, "has no method update"),
    "abstract": (
        "import onorbit_rs as oo\nclass Brake(oo.Controller):\n    pass",
        {},
        ControlError,
        "has no method update",
    ),
    "missing": (SOURCE, {"arguments": {}}, ControlError, "missing a required argument: 'gain'"),
    "unknown": (SOURCE, {"arguments": {"gian": 1}}, ControlError, "argument"),
    "too many": (CLASS, {"arguments": {"gain": 1}}, ControlError, "unexpected keyword argument 'gain'"),
    "no module": (
        CLASS,
        {"file": None, "module": "json.none"},
        NotFoundError,
        "'json.none' cannot be found",
    ),
    "nowhere": (
        CLASS,
        {"file": None, "module": "no_such_x"},
        NotFoundError,
        "'no_such_x' cannot be found",
    ),
}


@pytest.mark.parametrize("name", WRONG)
def test_check_finds_errors_without_running_the_code(name: str, tmp_path: Path) -> None:
    source, changes, error, words = WRONG[name]
    with pytest.raises(error, match=words):
        build(load(scenario(tmp_path, source, **changes)), runs_code=False)


def test_a_class_with_other_abstract_methods_is_refused_by_their_names(tmp_path: Path) -> None:
    source = "from abc import ABC, abstractmethod\n" + CLASS.replace("Brake:", "Brake(ABC):")
    source += "    @abstractmethod\n    def gains(self):\n        pass\n"
    with pytest.raises(ControlError, match="is abstract: it does not define gains; define"):
        build(load(scenario(tmp_path, source, arguments={})))


FINE: dict[str, tuple[str, dict[str, Any]]] = {
    "inherits": (SOURCE, {"arguments": {"gain": 1, "bias": 2}}),
    "imported": ("from elsewhere import Brake", {}),
    "assigned": ("Brake = make()", {}),
    "starred": ("from elsewhere import *", {}),
    "unknown base": ("from elsewhere import Base\nclass Brake(Base):\n    pass", {}),
    "decorated": ("from d import dataclass\n@dataclass\n" + CLASS + "    gain: float = 1\n", {}),
    "keywords": (CLASS + "    def __init__(self, **any):\n        pass", {}),
    "in try": ("try:\n    import x\nexcept ImportError:\n    pass\nelse:\n    from x import Brake\n", {}),
    "in except": (f"try:\n    import x\nexcept ImportError:\n{indent(CLASS, '    ')}", NONE),
    "in match": (f"match 1:\n    case 1:\n{indent(CLASS, ' ' * 8)}", NONE),
    "base in except": (
        "try:\n    from x import Base\nexcept ImportError:\n    class Base: pass\nclass Brake(Base): pass",
        NONE,
    ),
    "module": (CLASS, {"file": None, "module": "collections", "class": "Counter", "arguments": {}}),
    "compiled": (CLASS, {"file": None, "module": "math", "class": "Brake"}),
}


@pytest.mark.parametrize("name", FINE)
def test_errors_that_need_execution_are_not_reported_by_check(name: str, tmp_path: Path) -> None:
    source, changes = FINE[name]
    build(load(scenario(tmp_path, source, **changes)), runs_code=False)
