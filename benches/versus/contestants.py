"""Programs that are timed for one robot. Each is started on first use."""

from __future__ import annotations

import os
import sys
from pathlib import Path

import contact
import inputs
import numpy as np
import programs
from timing import Array, Contestant

import onorbit_rs as oo

HERE = Path(__file__).parent
# the last core runs all single-threaded programs; the first core handles interrupts
CORE = max(os.sched_getaffinity(0)) if hasattr(os, "sched_getaffinity") else None

# Python scripts; programs whose names end in _all may use every core
SCRIPTS = {
    "ours": "ours.py",
    "ours_all": "ours.py",
    "ours_avx2": "ours.py",
    "pinocchio_calls": "pinocchio_calls.py",
    "mujoco_rollout": "mujoco_rollout.py",
    "mujoco_rollout_all": "mujoco_rollout.py",
}
# programs of benches/peers and their input files
COMPILED = {
    "kernels": ("kernels", "robot.txt states.bin"),
    "reach": ("controlled", "robot.txt arm.bin reach.txt"),
    "controlled": ("controlled", "robot.txt arms.bin controlled.txt"),
    "mujoco": ("mujoco", f"robot.xml mujoco.bin {inputs.PASSIVE_RUNS} {inputs.PASSIVE_STEPS}"),
    "loops": ("loops", "held.txt held.bin grips.txt"),
    "contact": ("contact", f"contact.xml contact_soft.bin {contact.SOFT.steps}"),
    "hard_contact": ("contact", f"contact.xml contact_hard.bin {contact.HARD.steps}"),
}
QPOS = ("mujoco", "contact", "hard_contact")  # programs whose states are in the layout of MuJoCo

NEEDS = {"pinocchio_calls": "pin", "mujoco_rollout": "mujoco-core", "mujoco_rollout_all": "mujoco-core"}


class Contestants:
    """Processes by name: this package (`ours` in Python, `rust` without Python) and the other engines.

    `missing` maps the names of programs that cannot be run to the reasons.
    """

    def __init__(self, arms: int, ours: Path, peers: dict[str, Path], missing: dict[str, str]) -> None:
        self.folder = programs.BUILD / f"nv{6 + 7 * arms}"
        inputs.write(self.folder, arms)
        known = programs.versions()
        self.missing = {
            name: f"{wheel} is not installed" for name, wheel in NEEDS.items() if not known[wheel]
        }
        self.running: dict[str, Contestant] = {}
        self.commands = {
            name: [ours, self.folder / f"{robot}.urdf", self.folder / f"{states}.bin", inputs.STATES]
            for name, robot, states in (("rust", "robot", "states"), ("rust_loops", "held", "held"))
        }
        for name, script in SCRIPTS.items():
            self.commands[name] = [sys.executable, HERE / script, self.folder]
        for name, (program, given) in COMPILED.items():
            if program in missing:
                self.missing[name] = missing[program]
            else:
                files = [self.folder / word if "." in word else word for word in given.split()]
                self.commands[name] = [peers[program], *files]
        if arms == 1:
            self.missing.setdefault("loops", "the robot has only one hand")

    def __getitem__(self, name: str) -> Contestant:
        if name not in self.running:
            environment = {"ONORBIT_INSTRUCTION_SET": "avx2+fma"} if name == "ours_avx2" else {}
            core = None if name.endswith("_all") else CORE
            self.running[name] = Contestant([*map(str, self.commands[name])], core=core, **environment)
        return self.running[name]

    def result(self, name: str, job: str) -> Array:
        """Returns all results of a job of the program `name`, in the layout of this package."""
        rows = self[name].result(job, self.folder)
        if name not in QPOS:
            return rows
        model = oo.Model.from_urdf(self.folder / "robot.urdf")
        rows = rows.reshape(-1, model.nq + model.nv)
        return np.hstack(oo.layouts.from_mujoco(model, rows[:, : model.nq], rows[:, model.nq :])).ravel()

    def close(self) -> None:
        for contestant in self.running.values():
            contestant.close()
