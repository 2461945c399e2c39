"""Builds two revisions of this project: the Rust contestant and the Python package of each."""

from __future__ import annotations

import hashlib
import os
import shutil
import subprocess
import sys
import tempfile
from dataclasses import dataclass
from pathlib import Path

ROOT = Path(__file__).parents[2]
AGAINST = ROOT / "target" / "against"
SOURCE, TARGET = AGAINST / "source", AGAINST / "target"
# what a build depends on
PARTS = ("Cargo.toml", "Cargo.lock", "crates", "python", "benches/contestant")
PARTS = (*PARTS, "README.md", "pyproject.toml")


@dataclass(frozen=True)
class Build:
    """A revision's name, its contestant and the folder that holds its Python package."""

    name: str
    contestant: Path
    python: Path

    def machine_code(self) -> str:
        """A digest of the contestant and of the compiled module."""
        files = [self.contestant, *sorted((self.python / "onorbit_rs").glob("_core*.so"))]
        return hashlib.sha256(b"".join(file.read_bytes() for file in files)).hexdigest()


def built(*trees: Path) -> list[Build]:
    """Trees that were built where they are."""
    builds = []
    for tree in trees:
        contestant, python = tree / "target/release/examples/contestant", tree / "python"
        if not contestant.exists() or not [*python.glob("onorbit_rs/_core*.so")]:
            sys.exit(
                f"{tree} is not built: run cargo build --release -p onorbit-core --example contestant there, "
                "and build the Python module into python/onorbit_rs"
            )
        builds.append(Build(str(tree), contestant.absolute(), python.absolute()))
    return builds


def compared(revision: str) -> list[Build]:
    """The revision and the working tree, with whatever is changed in it, both built at the same path."""
    other = git("rev-parse", "--verify", f"{revision}^{{tree}}")
    return [build(revision, other), build("the working tree", working_tree())]


def git(*words: str, **environment: str) -> str:
    told = subprocess.run(
        ["git", *words], cwd=ROOT, env=os.environ | environment, capture_output=True, text=True
    )
    if told.returncode:
        sys.exit(f"git {' '.join(words)}: {told.stderr.strip()}")
    return told.stdout.strip()


def working_tree() -> str:
    """The tree object of all files that are not ignored, by an index of its own."""
    with tempfile.TemporaryDirectory() as folder:
        index = str(Path(folder) / "index")
        git("read-tree", "HEAD", GIT_INDEX_FILE=index)
        git("add", "--all", GIT_INDEX_FILE=index)
        return git("write-tree", GIT_INDEX_FILE=index)


def build(name: str, tree: str) -> Build:
    """Build a tree object, unless its like was built before."""
    content = git("ls-tree", tree, *PARTS)
    folder = AGAINST / hashlib.sha256(content.encode()).hexdigest()[:12]
    if not folder.exists():
        print(f"building {name} ...", flush=True)
        export(tree)
        seed()
        cargo("-p", "onorbit-core", "--example", "contestant")
        cargo("-p", "onorbit-py", "--features", "pyo3/extension-module")
        partial = folder.with_suffix(".partial")
        shutil.rmtree(partial, ignore_errors=True)
        shutil.copytree(SOURCE / "python", partial / "python")
        module = next(TARGET.glob("release/lib_core.*[!d]"))
        shutil.copy(module, partial / "python" / "onorbit_rs" / "_core.abi3.so")
        shutil.copy(TARGET / "release" / "examples" / "contestant", partial)
        partial.rename(folder)
    return Build(name, folder / "contestant", folder / "python")


def export(tree: str) -> None:
    """Write the files of a tree object to the one path that everything is built at."""
    shutil.rmtree(SOURCE, ignore_errors=True)
    SOURCE.mkdir(parents=True)
    with subprocess.Popen(["git", "archive", tree], cwd=ROOT, stdout=subprocess.PIPE) as archive:
        # files are new to cargo, whatever their age
        subprocess.run(["tar", "--extract", "--touch"], cwd=SOURCE, stdin=archive.stdout, check=True)


def seed() -> None:
    """Take what the working tree has compiled of the dependencies, as hard links."""
    if TARGET.exists():
        return
    for part in (".fingerprint", "build", "deps"):
        if (ROOT / "target" / "release" / part).exists():
            shutil.copytree(
                ROOT / "target" / "release" / part, TARGET / "release" / part, copy_function=os.link
            )


def cargo(*words: str) -> None:
    environment = {"CARGO_TARGET_DIR": str(TARGET), "PYO3_PYTHON": sys.executable}
    subprocess.run(
        ["cargo", "build", "--release", "--quiet", *words],
        cwd=SOURCE,
        env=os.environ | environment,
        check=True,
    )
