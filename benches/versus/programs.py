"""Builds the programs to be timed: the Rust program with cargo, and those of other engines with g++.

The headers and libraries of the other engines come from their wheels on PyPI.
"""

from __future__ import annotations

import hashlib
import json
import shutil
import subprocess
import sysconfig
from importlib import metadata
from pathlib import Path

HERE = Path(__file__).parent
PEERS = HERE.parent / "peers"
BUILD = HERE.parent / "build"
SITE = Path(sysconfig.get_paths()["purelib"])
WHEELS = ("pin", "libpinocchio", "cmeel-boost", "cmeel-eigen", "mujoco-core")

# programs of benches/peers and the engines that they time
PROGRAMS = {
    "kernels": "pinocchio",
    "controlled": "pinocchio",
    "loops": "pinocchio",
    "mujoco": "mujoco",
    "contact": "mujoco",
}
FLAGS = ["-std=c++17", "-O3", "-DNDEBUG", "-march=native", "-w"]
# limits of Boost that Pinocchio's joint variant requires
BOOST = ["MPL_LIMIT_LIST_SIZE=30", "MPL_LIMIT_VECTOR_SIZE=30", "FUSION_INVOKE_MAX_ARITY=12"]
BOOST = [f"-DBOOST_{limit}" for limit in [*BOOST, "MPL_CFG_NO_PREPROCESSED_HEADERS"]]


def versions() -> dict[str, str]:
    """Returns the versions of wheels and compilers by name; the text is empty for a missing one."""
    found = {}
    for wheel in (*WHEELS, "numpy"):
        try:
            found[wheel] = metadata.version(wheel)
        except metadata.PackageNotFoundError:
            found[wheel] = ""
    for tool in ("g++", "rustc"):
        path = shutil.which(tool)
        command = [path or tool, "--version"]
        found[tool] = (
            subprocess.run(command, capture_output=True, text=True).stdout.split("\n")[0] if path else ""
        )
    return found


def ours() -> Path:
    """Builds the Rust program with the flags of a release, without ``target-cpu``, and returns its path."""
    command = ["cargo", "build", "--release", "-p", "onorbit-core", "--example", "contestant"]
    output = subprocess.run(
        [*command, "--message-format=json"], cwd=HERE.parents[1], check=True, capture_output=True, text=True
    )
    built = [json.loads(line) for line in output.stdout.splitlines()]
    return next(Path(made["executable"]) for made in built if made.get("executable"))


def peers() -> tuple[dict[str, Path], dict[str, str]]:
    """Compiles the C++ programs whose sources or tools changed.

    Returns the paths of the programs, and the reasons why others are missing, both by name.
    """
    known = versions()
    if not known["g++"]:
        return {}, dict.fromkeys(PROGRAMS, "g++ is not installed")
    lib = next(iter(SITE.glob("mujoco/libmujoco.so.*")), None)
    prefix = SITE / "cmeel.prefix" / "include"
    pinocchio = [*BOOST, f"-I{prefix}", f"-I{prefix / 'eigen3'}"]
    links = [f"-I{SITE / 'mujoco' / 'include'}", str(lib), f"-Wl,-rpath,{SITE / 'mujoco'}"]
    options = {"pinocchio": pinocchio, "mujoco": links}
    needs = {"pinocchio": ("pin", "cmeel-eigen"), "mujoco": ("mujoco-core",)}
    headers = "".join(file.read_text() for file in sorted(PEERS.glob("*.hpp")))
    programs, missing, running = {}, {}, {}
    BUILD.mkdir(exist_ok=True)
    for name, engine in PROGRAMS.items():
        option = options[engine]
        if absent := [wheel for wheel in needs[engine] if not known[wheel]]:
            missing[name] = f"{' and '.join(absent)} must be installed"
            continue
        source = PEERS / f"{name}.cpp"
        recipe = [
            headers,
            source.read_text(),
            FLAGS,
            option,
            [known[x] for x in (*WHEELS, "g++")],
            processor(),
        ]
        program = BUILD / f"{name}-{hashlib.sha256(repr(recipe).encode()).hexdigest()[:12]}"
        programs[name] = program
        if not program.exists():
            command = ["g++", *FLAGS, str(source), *option, "-o", str(program) + ".new"]
            running[name] = subprocess.Popen(command, stderr=subprocess.PIPE, text=True)
    if running:
        print(f"compiling {', '.join(running)}, which can take minutes the first time ...", flush=True)
    for name, compiler in running.items():
        errors = compiler.communicate()[1]
        if compiler.returncode:
            missing[name] = f"g++ failed: {(errors.splitlines() or ['killed'])[0]}"
            del programs[name]
        else:
            Path(str(programs[name]) + ".new").rename(programs[name])
    return programs, missing


def processor() -> str:
    """Returns the name of the processor, or ``unknown``."""
    file = Path("/proc/cpuinfo")
    lines = file.read_text().splitlines() if file.exists() else []
    return next((line.split(":")[1].strip() for line in lines if line.startswith("model name")), "unknown")
