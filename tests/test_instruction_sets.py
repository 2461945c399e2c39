"""One wheel for all processors: equal results on each instruction set; unknown sets are rejected."""

from __future__ import annotations

import json
import os
import re
import shutil
import subprocess
import sys
from pathlib import Path

import pytest

import onorbit_rs as oo

REPOSITORY = Path(__file__).parents[1]
LEVELS = ("baseline", "avx2+fma", "avx512")
BEST = oo.build_info()["instruction_set"]
# kernels against Pinocchio and MuJoCo, batches, rollouts, forces from outside, the environment
KERNELS = (
    "oracles/test_pinocchio.py",
    "oracles/test_pinocchio_derivatives.py",
    "oracles/test_mujoco.py",
    "test_border_batches.py",
    "test_border_rollouts.py",
    "test_wrenches.py",
)


def python(level: str, *arguments: str) -> subprocess.CompletedProcess[str]:
    environment = os.environ | {"ONORBIT_INSTRUCTION_SET": level}
    return subprocess.run(
        [sys.executable, *arguments], env=environment, cwd=REPOSITORY, capture_output=True, text=True
    )


INFO = "import onorbit_rs as oo; print(oo.build_info()['instruction_set'])"


@pytest.mark.skipif(BEST not in LEVELS, reason=f"the processor is not x86-64: it has {BEST}")
@pytest.mark.parametrize("level", LEVELS)
def test_a_lower_instruction_set_can_be_selected(level: str) -> None:
    # a higher set than available selects the best one
    expected = LEVELS[min(LEVELS.index(level), LEVELS.index(BEST))]
    assert python(level, "-c", INFO).stdout.strip() == expected


def test_an_unknown_instruction_set_is_rejected() -> None:
    done = python("sse9", "-c", INFO)
    assert done.returncode != 0
    assert 'ONORBIT_INSTRUCTION_SET is "sse9"; it must be one of baseline, ' in done.stderr


@pytest.mark.skipif(BEST not in LEVELS, reason=f"the processor is not x86-64: it has {BEST}")
@pytest.mark.parametrize("level", LEVELS)
def test_kernels_pass_their_tests_on(level: str) -> None:
    if LEVELS.index(level) >= LEVELS.index(BEST):
        pytest.skip(f"all other tests already run with {BEST}, the best instruction set of this processor")
    done = python(level, "-m", "pytest", "-q", *(f"tests/{name}" for name in KERNELS))
    assert done.returncode == 0, done.stdout
    passed = re.search(r"(\d+) passed", done.stdout)
    assert passed
    assert int(passed[1]) > 250


DIGESTS = """
import json, sys
sys.path.insert(0, "tests")
import recorded_bits
robot = recorded_bits._of_scenario("humanoid_reach")
print(json.dumps([robot, recorded_bits._of_world("capture_tumbling_target")]))
"""


def has_wide_registers() -> bool:
    """Whether the kernels of one state use the registers of AVX-512: on processors of AMD."""
    info = Path("/proc/cpuinfo")
    return BEST == "avx512" and info.exists() and "sse4a" in info.read_text().split()


@pytest.mark.skipif(not has_wide_registers(), reason=f"not a processor of AMD with AVX-512: it has {BEST}")
def test_the_registers_of_avx512_change_no_bit_of_a_run() -> None:
    digests = {level: json.loads(python(level, "-c", DIGESTS).stdout) for level in LEVELS}
    assert digests["avx512"] == digests["avx2+fma"]
    assert digests["baseline"] != digests["avx2+fma"]  # without fused multiply-add, rounding differs


def test_the_build_does_not_depend_on_the_processor() -> None:
    recipes = [*REPOSITORY.glob("crates/*/Cargo.toml")]
    recipes += [REPOSITORY / name for name in ("Cargo.toml", "pyproject.toml", "Makefile")]
    recipes += [file for folder in (".cargo", ".ci") for file in (REPOSITORY / folder).glob("*")]
    for file in recipes:
        assert not re.search(r"target-(cpu|feature)|RUSTFLAGS|rustflags", file.read_text()), file


OLD = """
import numpy as np, onorbit_rs as oo
model = oo.robots.load("humanoid_torso")
v = np.full(model.nv, 0.1)
q, _ = oo.rollout(model, np.tile(model.neutral(), (9, 1)), np.tile(v, (9, 1)), steps=5)
print(oo.build_info()["instruction_set"], repr(q[8].sum()))
"""


def test_a_processor_of_2008_runs_the_wheel() -> None:
    emulator = shutil.which("qemu-x86_64-static") or shutil.which("qemu-x86_64")
    if emulator is None:
        pytest.skip("qemu-user is not installed (Debian: apt install qemu-user-static)")
    # without AVX, the oldest processor that numpy's wheel supports
    path = os.pathsep.join(sys.path)
    old = subprocess.run(
        [emulator, "-cpu", "Nehalem", str(Path(sys.executable).resolve()), "-c", OLD],
        env=os.environ | {"PYTHONPATH": path, "OPENBLAS_NUM_THREADS": "1"},
        capture_output=True,
        text=True,
        check=True,
    )
    level, number = old.stdout.split()
    assert level == "baseline"
    assert python("", "-c", OLD).stdout.split()[1][:18] == number[:18]
