"""Only ``viewer/`` imports rerun, and only ``figures/`` imports matplotlib."""

from __future__ import annotations

import ast
import subprocess
import sys
from pathlib import Path

import pytest

import onorbit_rs

PACKAGE = Path(onorbit_rs.__file__).parent


@pytest.mark.parametrize(
    ("owner", "roots"), [("viewer", {"rerun", "rerun_cli"}), ("figures", {"matplotlib", "mpl_toolkits"})]
)
def test_a_drawing_library_stays_in_its_folder(owner: str, roots: set[str]) -> None:
    importers = {
        file.relative_to(PACKAGE).parts[0]
        for file in PACKAGE.rglob("*.py")
        for node in ast.walk(ast.parse(file.read_text()))
        if roots & _imported(node)
    }
    assert importers == {owner}


@pytest.mark.parametrize(
    "module", ["onorbit_rs.report", "onorbit_rs.report.numbers", "onorbit_rs.common.display_units"]
)
def test_a_report_loads_no_drawing_library_before_it_draws(module: str) -> None:
    program = f"import sys, {module}; assert not {{'matplotlib', 'rerun'}} & set(sys.modules)"
    subprocess.run([sys.executable, "-c", program], check=True)


def _imported(node: ast.AST) -> set[str]:
    if isinstance(node, ast.Import):
        return {alias.name.split(".")[0] for alias in node.names}
    if isinstance(node, ast.ImportFrom):
        return {(node.module or "").split(".")[0]}
    return set()
