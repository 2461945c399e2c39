"""Builds the wheel and the source distribution, and tests each in a new environment (``make wheel``).

Both are written to ``dist/``. zig links the wheel against glibc 2.28 (tag ``manylinux_2_28``), so that it
installs on Linux distributions from 2018 on. The script prints the size of the installation and the time of
an import.
"""

from __future__ import annotations

import os
import re
import shutil
import subprocess
import sys
import tempfile
import time
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
DIST = ROOT / "dist"
GLIBC = (2, 28)
MAXIMUM_GLIBC = re.compile(rb"GLIBC_(\d+)\.(\d+)")
IMPORT = "import time; began = time.perf_counter(); import onorbit_rs; print(time.perf_counter() - began)"


def run(*command: object, cwd: Path = ROOT) -> str:
    """Runs a command and returns its standard output; ends the program if the command fails."""
    arguments = [str(argument) for argument in command]
    done = subprocess.run(arguments, cwd=cwd, stdout=subprocess.PIPE, text=True, check=False)
    if done.returncode:
        sys.exit(f"{done.stdout}\nfailed with exit code {done.returncode}: {' '.join(arguments)}")
    return done.stdout


def build() -> tuple[Path, Path]:
    """Builds and returns the wheel and the source distribution."""
    shutil.rmtree(DIST, ignore_errors=True)
    maturin = Path(sys.executable).with_name("maturin")
    tag = f"manylinux_{GLIBC[0]}_{GLIBC[1]}"
    run(maturin, "build", "--release", "--zig", "--compatibility", tag, "--out", DIST)
    run(maturin, "sdist", "--out", DIST)
    (wheel,), (source,) = DIST.glob("*.whl"), DIST.glob("*.tar.gz")
    assert tag in wheel.name, wheel.name
    return wheel, source


def newest_glibc(module: Path) -> tuple[int, int]:
    """Returns the newest version of glibc whose symbols a compiled module needs."""
    return max((int(major), int(minor)) for major, minor in MAXIMUM_GLIBC.findall(module.read_bytes()))


def check(distribution: Path) -> None:
    """Installs a distribution into a new environment, and runs the validation suite and a scenario there."""
    with tempfile.TemporaryDirectory() as folder:
        environment, empty = Path(folder, "environment"), Path(folder, "empty")
        empty.mkdir()
        run(sys.executable, "-m", "venv", environment)
        python = environment / "bin/python"
        before = size(environment)
        began = time.monotonic()
        run(python, "-m", "pip", "install", "--quiet", distribution)
        elapsed = time.monotonic() - began
        installed = size(environment) - before
        package = Path(
            run(python, "-c", "import onorbit_rs; print(onorbit_rs.__path__[0])", cwd=empty).strip()
        )
        imports = [float(run(python, "-c", IMPORT, cwd=empty)) for _ in range(5)]
        run(environment / "bin/onorbit", "validate", cwd=empty)
        run(environment / "bin/onorbit", "run", "humanoid_reach", "--out", "reach", cwd=empty)
        needs = newest_glibc(package / "_core.abi3.so")
        sizes = f"{size(package) / 1e6:.0f} MB, with all requirements {installed / 1e6:.0f} MB"
        print(
            f"{distribution.name}: {distribution.stat().st_size / 1e6:.1f} MB; onorbit_rs installs {sizes},"
        )
        print(f"  in {elapsed:.0f} s; import {min(imports):.2f} s; glibc {needs[0]}.{needs[1]};", end=" ")
        print("the validation suite and a run passed", flush=True)
        if distribution.suffix == ".whl":
            assert needs <= GLIBC, needs


def size(folder: Path) -> int:
    """Returns the total size of the files in a folder, bytes; symbolic links do not count."""
    return sum(file.stat().st_size for file in folder.rglob("*") if file.is_file() and not file.is_symlink())


def main() -> None:
    """Builds the distributions and checks them."""
    os.environ.pop("PYTHONPATH", None)
    os.environ["PATH"] = (
        f"{Path(sys.executable).parent}{os.pathsep}{os.environ['PATH']}"  # zig is a Python module
    )
    for distribution in build():
        check(distribution)


if __name__ == "__main__":
    main()
