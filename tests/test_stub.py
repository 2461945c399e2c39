"""The stub agrees with the module: signatures, defaults and properties."""

from __future__ import annotations

import os
import subprocess
import sys
from pathlib import Path

import pytest

pytest.importorskip("mypy", reason="mypy is in the lint extra")

MODULE = "onorbit_rs._core"


def stubtest(*arguments: str, cwd: Path, path: Path | None = None) -> subprocess.CompletedProcess[str]:
    environment = dict(os.environ) | ({"MYPYPATH": str(path)} if path else {})
    return subprocess.run(
        [sys.executable, "-m", "mypy.stubtest", MODULE, "--concise", *arguments],
        cwd=cwd, env=environment, capture_output=True, text=True, timeout=250, check=False,
    )  # fmt: skip


def test_stub_and_module_agree(tmp_path: Path) -> None:
    result = stubtest(cwd=tmp_path)
    assert result.returncode == 0, f"\n{result.stdout}{result.stderr}"


def test_a_stub_with_a_missing_argument_is_detected(tmp_path: Path) -> None:
    import onorbit_rs

    # a stub-only package with an error takes precedence over the real one
    wrong = tmp_path / "onorbit_rs"
    wrong.mkdir()
    stub = (Path(onorbit_rs.__file__).parent / "_core.pyi").read_text()
    assert "record_every: int = 1," in stub
    (wrong / "__init__.pyi").write_text("")
    (wrong / "_core.pyi").write_text(stub.replace("record_every: int = 1,", "record_all: int = 1,"))
    result = stubtest(cwd=tmp_path, path=tmp_path)
    assert result.returncode != 0
    assert "record_every" in result.stdout
