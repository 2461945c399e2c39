"""Documentation: examples run, public objects have docstrings, and arrays state shape and unit."""

from __future__ import annotations

import ast
import doctest
import importlib
import inspect
import pkgutil
import re
from pathlib import Path
from types import ModuleType

import pytest

import onorbit_rs as oo
from onorbit_rs import _core

REPOSITORY = Path(__file__).parents[1]
OPTIONAL = ("onorbit_rs.__main__",)  # runs the command line


def modules() -> list[str]:
    found = [module.name for module in pkgutil.walk_packages(oo.__path__, "onorbit_rs.")]
    return ["onorbit_rs", *(name for name in found if name not in OPTIONAL)]


def examples(name: str) -> list[doctest.DocTest]:
    module = importlib.import_module(name)
    finder = doctest.DocTestFinder(exclude_empty=True)
    tests = finder.find(module, name)
    for kind in vars(module).values() if name == "onorbit_rs._core" else []:
        if inspect.isclass(kind):
            tests += finder.find(kind, f"{name}.{kind.__name__}", module=False)
    return [test for test in tests if test.examples]


@pytest.mark.parametrize("name", modules())
def test_examples_in_docstrings_run(name: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    runner = doctest.DocTestRunner(optionflags=doctest.NORMALIZE_WHITESPACE | doctest.ELLIPSIS)
    for test in examples(name):
        output: list[str] = []
        result = runner.run(test, out=output.append)
        assert result.failed == 0, "".join(output)


def test_the_package_has_an_example() -> None:
    assert examples("onorbit_rs")


PAGES = [
    *sorted(REPOSITORY.glob("*.md")),
    *sorted((REPOSITORY / "docs").rglob("*.md")),
    REPOSITORY / "benches" / "README.md",
]


def unbalanced(text: str) -> int | None:
    """Returns the line of the first code fence that is nested or never closed, or None."""
    opened = None
    for number, line in enumerate(text.splitlines(), 1):
        if not line.lstrip().startswith("```"):
            continue
        if opened is None:
            opened = number
        elif line.strip() == "```":
            opened = None
        else:
            return opened
    return opened


@pytest.mark.parametrize("file", PAGES, ids=lambda file: file.name)
def test_code_fences_in_the_documents_are_closed(file: Path) -> None:
    text = file.read_text()
    assert unbalanced(text) is None, f"{file.name}:{unbalanced(text)}: this fence is not closed"
    # negative control: the same page with one closing fence lost
    for lost in re.finditer(r"^```\n", text, re.MULTILINE):
        assert unbalanced(text[: lost.start()] + text[lost.end() :]) is not None


def public(kind: type) -> list[str]:
    return [name for name in vars(kind) if not name.startswith("_")]


CORE_CLASSES = [kind for kind in vars(_core).values() if inspect.isclass(kind)]


@pytest.mark.parametrize("kind", CORE_CLASSES, ids=lambda kind: kind.__name__)
def test_public_objects_of_the_engine_have_docstrings(kind: type) -> None:
    assert inspect.getdoc(kind), kind
    for name in public(kind):
        assert (getattr(kind, name).__doc__ or "").strip(), f"{kind.__name__}.{name}"


# methods and properties that return arrays state shape and unit, or that they are dimensionless
WITH_SHAPE = re.compile(r"\([^()]*\b(\d|nq|nv|n|T|B|K)\b[^()]*\)")
ARRAYS = [
    *((oo.Model, name) for name in (
        "neutral", "integrate", "difference", "frame_pose", "frame_velocity", "frame_jacobian", "mass_matrix",
        "bias_forces", "inverse_dynamics", "forward_dynamics", "momentum", "kinetic_energy", "center_of_mass",
        "inverse_dynamics_derivatives", "forward_dynamics_derivatives", "free_floating_derivatives",
    )),
    *((oo.Trace, name) for name in (
        "time", "q", "v", "tau", "acceleration", "momentum", "impulse", "kinetic_energy", "work",
        "center_of_mass", "tool_pose", "reference_pose", "position_error", "attitude_error", "position_eci",
        "velocity_eci",
    )),
    *((oo.FreeFloating, name) for name in ("inertia", "bias", "external", "jacobian", "drift")),
    *((oo.FreeFloatingDerivatives, name) for name in (
        "torque_dq", "torque_dv", "acceleration_dq", "acceleration_dv", "velocity_dq",
    )),
    *((oo.State, name) for name in (
        "q", "v", "reference_pose", "reference_velocity", "reference_acceleration",
    )),
    *((oo.Kepler, name) for name in ("state", "lvlh")),
]  # fmt: skip


@pytest.mark.parametrize(("kind", "name"), ARRAYS, ids=lambda x: getattr(x, "__name__", x))
def test_arrays_state_their_shape(kind: type, name: str) -> None:
    text = getattr(kind, name).__doc__
    assert WITH_SHAPE.search(text), f"{kind.__name__}.{name}: {text}"


def python_files() -> list[Path]:
    return sorted((REPOSITORY / "python" / "onorbit_rs").rglob("*.py"))


@pytest.mark.parametrize("file", python_files(), ids=lambda file: file.stem)
def test_public_functions_and_modules_have_docstrings(file: Path) -> None:
    tree = ast.parse(file.read_text())
    assert ast.get_docstring(tree) or file.name == "__main__.py", file
    for node in tree.body:
        if isinstance(node, ast.FunctionDef | ast.ClassDef) and not node.name.startswith("_"):
            assert ast.get_docstring(node), f"{file.name}: {node.name}"


def test_the_imported_module_belongs_to_the_stub() -> None:
    assert isinstance(_core, ModuleType) and Path(_core.__file__ or "").parent == Path(oo.__file__).parent
