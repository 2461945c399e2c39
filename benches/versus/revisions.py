"""Builds of two revisions of this project, each with the Rust program `contestant` and the Python package."""

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
# files on which a build depends
PARTS = ("Cargo.toml", "Cargo.lock", "crates", "python", "benches/contestant")
PARTS = (*PARTS, "README.md", "pyproject.toml")


@dataclass(frozen=True)
class Build:
    """Build of a revision: its name, its Rust program and the folder that contains its Python package."""

    name: str
    contestant: Path
    python: Path

    def machine_code(self) -> str:
        """Returns a digest of the Rust program and of the compiled module."""
        files = [self.contestant, *sorted((self.python / "onorbit_rs").glob("_core*.so"))]
        return hashlib.sha256(b"".join(file.read_bytes() for file in files)).hexdigest()


def built(*trees: Path) -> list[Build]:
    """Returns the builds of source trees that were built in place, or exits if one is not built."""
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
    """Builds a revision, then the working tree with its uncommitted changes, both at the same path."""
    other = git("rev-parse", "--verify", f"{revision}^{{tree}}")
    return [build(revision, other), build("the working tree", working_tree())]


def git(*words: str, **environment: str) -> str:
    done = subprocess.run(
        ["git", *words], cwd=ROOT, env=os.environ | environment, capture_output=True, text=True
    )
    if done.returncode:
        sys.exit(f"git {' '.join(words)}: {done.stderr.strip()}")
    return done.stdout.strip()


def working_tree() -> str:
    """Writes a git tree object of all files that are not ignored and returns its hash.

    A temporary index is used, so that nothing is staged.
    """
    with tempfile.TemporaryDirectory() as folder:
        index = str(Path(folder) / "index")
        git("read-tree", "HEAD", GIT_INDEX_FILE=index)
        git("add", "--all", GIT_INDEX_FILE=index)
        return git("write-tree", GIT_INDEX_FILE=index)


def build(name: str, tree: str) -> Build:
    """Builds a git tree object and returns the build, which is reused if an equal tree was built before."""
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
    """Writes the files of a git tree object to the common path of all builds."""
    shutil.rmtree(SOURCE, ignore_errors=True)
    SOURCE.mkdir(parents=True)
    with subprocess.Popen(["git", "archive", tree], cwd=ROOT, stdout=subprocess.PIPE) as archive:
        # current time stamps make cargo rebuild the files
        subprocess.run(["tar", "--extract", "--touch"], cwd=SOURCE, stdin=archive.stdout, check=True)


def seed() -> None:
    """Links the dependencies that were compiled in the working tree into the build folder, if it is new."""
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
