"""Checks the structure of the source: order of the folders, circles, users of each library, file lengths."""

from __future__ import annotations

import ast
import re
import subprocess
import sys
from collections.abc import Iterator
from graphlib import TopologicalSorter
from pathlib import Path

import pytest
from rust_imports import Crate, circles

import onorbit_rs as oo

REPOSITORY = Path(__file__).parents[1]
CORE = REPOSITORY / "crates" / "core" / "src"
GLUE = REPOSITORY / "crates" / "py" / "src"
PACKAGE = REPOSITORY / "python" / "onorbit_rs"

# a folder may use itself and the folders before it
ORDER = (
    "spatial",
    "model",
    "geometry",
    "dynamics",
    "earth",
    "gravity",
    "orbit",
    "environment",
    "reference",
    "control",
    "world",
    "contact",
    "simulation",
    "batch",
)

LONGEST = 400
LONGER_WITH_REASON = {
    "python/onorbit_rs/_core.pyi": "one module, one stub",
    "crates/core/tests/simulation_nasa.rs": "NASA's tables stand beside the cases they belong to",
}


def rust_files(folder: Path) -> list[Path]:
    files = sorted(folder.rglob("*.rs"))
    assert files, f"no Rust in {folder}"
    return files


def code(file: Path) -> str:
    """Returns the source without comments and with single spaces, so that a grouped ``use`` is one line."""
    text = re.sub(r"//[^\n]*", "", file.read_text())
    return re.sub(r"\s+", " ", text)


def used_folders(text: str) -> set[str]:
    """Returns the top folders named after ``crate::``, alone or in a group."""
    used = set(re.findall(r"\bcrate::([a-z_]+)", text))
    for start in (match.end() for match in re.finditer(r"\bcrate::\{", text)):
        depth, name = 1, ""
        for char in text[start:]:
            depth += (char == "{") - (char == "}")
            if char in ",}" and depth <= 1:
                used.add(name.strip().split("::")[0])
                name = ""
            elif depth >= 1:
                name += char
            if depth == 0:
                break
    return {name for name in used if name}


def test_the_scan_reads_every_way_to_write_a_use() -> None:
    text = "use crate::spatial::{A, B}; use crate::{model::{C, D}, orbit, batch::E}; crate::control::f()"
    assert used_folders(text) == {"spatial", "model", "orbit", "batch", "control"}


def test_every_folder_of_the_core_has_a_place_in_the_order() -> None:
    folders = {path.name for path in CORE.iterdir() if path.is_dir()}
    assert folders == set(ORDER), "add the new folder to ORDER and to the head of lib.rs"


@pytest.mark.parametrize("folder", ORDER)
def test_a_folder_uses_only_itself_and_earlier_folders(folder: str) -> None:
    allowed = set(ORDER[: ORDER.index(folder) + 1])
    for file in rust_files(CORE / folder):
        later = used_folders(code(file)) & set(ORDER) - allowed
        assert not later, (
            f"{file.relative_to(REPOSITORY)} uses {', '.join(later)}, which comes after {folder}"
        )


def test_no_files_of_a_folder_use_each_other_in_a_circle() -> None:
    found = circles(Crate(CORE).graph())
    for folder in ORDER:
        inside = [circle for circle in found if circle[0].startswith(f"{folder}/")]
        assert inside == []


def test_the_search_finds_circles_through_every_kind_of_path(tmp_path: Path) -> None:
    sources = {
        "lib.rs": "pub mod a; pub mod b; pub mod c; pub mod d; pub mod e;",
        "a.rs": "use crate::{b::{B, inner::Inner as Renamed}, c}; pub struct A(c::C, Renamed, B);",
        "b/mod.rs": "mod inner; pub use inner::Inner; pub struct B; // crate::a::A in a comment is no use",
        "b/inner.rs": "pub struct Inner; #[cfg(test)] mod tests { use crate::a::A; }",
        "c.rs": 'pub struct C; fn f() -> &\'static str { let _: crate::d::D; "crate::a::A" }',
        "d.rs": "use super::b::Inner; pub struct D(pub(crate) super::a::A);",
        "e.rs": "use std::fmt::Debug; use super::{self as root, e}; pub struct E;",
    }
    for name, source in sources.items():
        file = tmp_path / name
        file.parent.mkdir(exist_ok=True)
        file.write_text(source)
    graph = Crate(tmp_path).graph()
    assert graph["a.rs"] == {"b/mod.rs", "b/inner.rs", "c.rs"}
    assert graph["d.rs"] == {"b/inner.rs", "a.rs"}, "the name that b/mod.rs exports is defined in b/inner.rs"
    assert graph["b/mod.rs"] == graph["b/inner.rs"] == graph["e.rs"] == set()
    assert circles(graph) == [("a.rs", "c.rs", "d.rs")]


@pytest.mark.parametrize(
    ("pattern", "where", "home"),
    [
        (r"\b(roxmltree|urdf_rs)\b", CORE, "model/urdf/"),
        (r"\b(pyo3|numpy)\b", CORE, "nowhere"),
        (r"\b(SystemTime|Instant::now|thread::sleep)\b", CORE, "nowhere"),  # nothing reads the clock
        (r"\b(println|eprintln|dbg)!", CORE, "nowhere"),
        (r"\bstatic mut\b", CORE, "nowhere"),
        (r"\brayon\b", CORE, "batch/"),
    ],
)
def test_only_one_folder_uses_the_library(pattern: str, where: Path, home: str) -> None:
    for file in rust_files(where):
        name = str(file.relative_to(where))
        if re.search(pattern, code(file)):
            assert name.startswith(home), f"{name} uses {pattern}, which is allowed in {home} only"


def test_no_bare_unwrap_outside_tests() -> None:
    for folder in (CORE, GLUE):
        for file in rust_files(folder):
            shipped = code(file).split("#[cfg(test)]")[0]
            assert ".unwrap()" not in shipped, (
                f"{file.relative_to(REPOSITORY)}: use expect, which states the invariant"
            )


def imports(file: Path) -> Iterator[tuple[str, bool]]:
    """Yields the modules that a Python file imports, and whether only the type checker imports them."""
    tree = ast.parse(file.read_text())
    for_types = {
        id(inner)
        for node in ast.walk(tree)
        if isinstance(node, ast.If) and "TYPE_CHECKING" in ast.unparse(node.test)
        for inner in ast.walk(node)
    }
    for node in ast.walk(tree):
        names = [alias.name for alias in node.names] if isinstance(node, ast.Import) else []
        if isinstance(node, ast.ImportFrom) and node.module and node.level == 0:
            names = [node.module, *(f"{node.module}.{alias.name}" for alias in node.names)]
        if isinstance(node, ast.Call) and re.search(r"\b(import_module|__import__)$", ast.unparse(node.func)):
            names = [part.value for part in node.args[:1] if isinstance(part, ast.Constant)]
        yield from ((name, id(node) in for_types) for name in names)


def test_the_scan_reads_every_way_to_import(tmp_path: Path) -> None:
    file = tmp_path / "some.py"
    file.write_text(
        "import a.b\nfrom c import d\ne: Any = importlib.import_module('e.f')\ng = import_module('g')\n"
        "h = __import__('h')\nimportlib.util.find_spec('i')\nimport_module(j)\n"
    )
    assert {name for name, _ in imports(file)} == {"a.b", "c", "c.d", "e.f", "g", "h"}


ELSEWHERE = {
    ("mujoco", "tools/validation"): "an independent oracle: it shares no code with the engine that it checks",
    ("PIL", "pictures"): "writes pictures, and the letters in them; meshes only read textures",
}


@pytest.mark.parametrize(
    ("module", "home"),
    [
        ("rerun", "viewer"), ("matplotlib", "figures"), ("mujoco", "engines"),
        ("trimesh", "visuals/meshes"), ("collada", "visuals/meshes"), ("PIL", "visuals/meshes"),
        ("coacd", "convex_pieces"),
    ],
)  # fmt: skip
def test_only_one_folder_imports_the_module(module: str, home: str) -> None:
    users = {
        file.relative_to(PACKAGE).parent.as_posix()
        for file in PACKAGE.rglob("*.py")
        if any(name.split(".")[0] == module for name, _ in imports(file))
    }
    assert users == {home, *(folder for name, folder in ELSEWHERE if name == module)}


def test_a_scenario_imports_neither_viewer_nor_figures() -> None:
    for file in (PACKAGE / "scenario").glob("*.py"):
        for name, _ in imports(file):
            assert not name.startswith(("onorbit_rs.viewer", "onorbit_rs.figures", "onorbit_rs.cli")), file


def test_no_python_modules_import_each_other_in_a_circle() -> None:
    """Imports inside functions count too."""
    modules = {
        ".".join(file.relative_to(PACKAGE.parent).with_suffix("").parts): file
        for file in PACKAGE.rglob("*.py")
        if file.stem != "__init__"
    }
    uses = {
        module: {name for name, is_for_types in imports(file) if not is_for_types and name in modules}
        for module, file in modules.items()
    }
    assert list(TopologicalSorter(uses).static_order())  # a CycleError names the circle


HEAVY = {"rerun", "matplotlib", "mujoco", "numpy", "pydantic", "yaml", "rich", "trimesh", "collada", "PIL"}
"""Modules that take a tenth of a second or more to load and that many programs do not need."""


@pytest.mark.parametrize(
    "program",
    [
        "import onorbit_rs",
        "import onorbit_rs; onorbit_rs.Model, onorbit_rs.robots.names()",
        "from onorbit_rs.cli import main; main(['--help'])",
        "from onorbit_rs.cli import main; main(['--version'])",
    ],
)
def test_heavy_modules_are_loaded_only_when_used(program: str) -> None:
    report = (
        f"import atexit, sys; atexit.register(lambda: print(*{HEAVY} & set(sys.modules), file=sys.stderr))"
    )
    command = [sys.executable, "-c", f"{report}; {program}"]
    result = subprocess.run(command, capture_output=True, text=True, check=True)
    assert result.stderr.split() == []


def test_the_commands_are_not_loaded_with_the_package() -> None:
    program = "import sys, onorbit_rs; print('typer' in sys.modules, onorbit_rs.run, 'numpy' in sys.modules)"
    result = subprocess.run([sys.executable, "-c", program], capture_output=True, text=True, check=True)
    assert result.stdout.startswith("False <function run") and result.stdout.endswith(" True\n")
    with pytest.raises(AttributeError, match="no attribute 'runn'"):
        _ = oo.runn  # type: ignore[attr-defined]


@pytest.mark.parametrize("words", ["already exists", "cannot write {"])
def test_only_one_file_of_the_commands_reports_why_nothing_is_written(words: str) -> None:
    users = {file.name for file in (PACKAGE / "cli").glob("*.py") if words in file.read_text()}
    assert users == {"output_files.py"}


def test_every_public_name_exists() -> None:
    assert len(set(oo.__all__)) == len(oo.__all__)
    for name in oo.__all__:
        assert getattr(oo, name) is not None, name
    for name in oo.exceptions.__all__:
        assert issubclass(getattr(oo.exceptions, name), BaseException), name
    assert oo.__version__ == oo.build_info()["version"]


def source_files() -> list[Path]:
    found = [
        file
        for folder in ("crates", "python", "tests", "benches")
        for pattern in ("*.rs", "*.py", "*.pyi")
        for file in (REPOSITORY / folder).rglob(pattern)
        if "build" not in file.relative_to(REPOSITORY).parts
    ]
    assert len(found) > 100
    return found


def test_no_file_is_too_long() -> None:
    for file in source_files():
        name = str(file.relative_to(REPOSITORY))
        lines = len(file.read_text().splitlines())
        assert lines <= LONGEST or name in LONGER_WITH_REASON, f"{name} has {lines} lines: split it"


def test_most_files_are_short() -> None:
    lengths = sorted(
        len(file.read_text().splitlines())
        for file in source_files()
        if "tests" not in file.relative_to(REPOSITORY).parts
    )
    assert lengths[len(lengths) // 2] <= 135, "readable code bases have a median of 95 to 135 lines"


def test_no_coverage_profile_lies_at_the_root() -> None:
    assert not list(REPOSITORY.glob("*.profraw"))
