"""Rows of the table. Each row is a job that is compared for each robot."""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True)
class Row:
    """Job of this package, compared with jobs of one other engine, of which the fastest counts.

    `ours` names the program and its job, `peer` the other program and `jobs` its jobs. `goal` is the required
    ratio, optionally by instruction set or nv; None means no requirement. `parts` lists the widths of the
    results of a state, as products of nq, nv, n and numbers.
    """

    what: str
    ours: tuple[str, str]
    peer: str
    jobs: tuple[str, ...]
    against: str
    goal: float | dict[object, float] | None
    parts: str

    def minimum(self, nv: int, level: str) -> float | None:
        """Returns the required ratio for this `nv` and this instruction set; None without requirement."""
        if not isinstance(self.goal, dict):
            return self.goal
        return self.goal.get(nv, self.goal.get(level))

    def widths(self, nv: int) -> list[int]:
        sizes = {"nq": nv + 1, "nv": nv, "n": nv - 6, "6": 6}

        def size(term: str) -> int:
            return int(sizes[term]) if term in sizes else size(term.split("*")[0]) * size(term.split("*")[1])

        return [size(term) for term in self.parts.split()]


PIN, MUJOCO = "Pinocchio C++", "MuJoCo"
BATCH: dict[object, float] = {"avx512": 14.0, "avx2+fma": 8.0}
ROLLOUT: dict[object, float] = {13: 15.0, 20: 12.0}

ROWS = [
    Row("ABA", ("rust", "aba"), "kernels", ("aba", "aba_local"), f"{PIN} aba", 2.5, "nv"),
    Row("CRBA", ("rust", "crba"), "kernels", ("crba", "crba_world"), f"{PIN} crba", 1.5, "nv*nv"),
    Row("RNEA", ("rust", "rnea"), "kernels", ("rnea",), f"{PIN} rnea", 1.5, "nv"),
    Row(
        "frame Jacobian and drift",
        ("rust", "jacobian"),
        "kernels",
        ("jacobian", "jacobian_rate"),
        f"{PIN}, by accelerations or by its rate",
        1.5,
        "6*nv 6",
    ),
    Row(
        "M*, c*, Jg, d together",
        ("rust", "reduced"),
        "kernels",
        ("reduced", "reduced_rate"),
        f"{PIN} and Eigen",
        2.5,
        "n*n n 6*n 6",
    ),
    Row(
        "both hands on one load",
        ("rust_loops", "constrained"),
        "loops",
        ("constrained", "constrained_proximal"),
        f"{PIN} constraintDynamics",
        3.0,
        "nv",
    ),
    Row(
        "the same by its loop-constrained ABA",
        ("rust_loops", "constrained"),
        "loops",
        ("lcaba",),
        f"{PIN} lcaba",
        None,
        "nv",
    ),
    Row(
        "batch forward dynamics",
        ("ours", "batch"),
        "kernels",
        ("aba", "aba_local"),
        f"{PIN} aba",
        BATCH,
        "nv",
    ),
    Row(
        "batch forward dynamics, AVX2",
        ("ours_avx2", "batch"),
        "kernels",
        ("aba", "aba_local"),
        f"{PIN} aba",
        BATCH,
        "nv",
    ),
    Row(
        "passive step in Simulation.run",
        ("ours", "passive"),
        "mujoco",
        ("step",),
        f"{MUJOCO} C, RK4",
        2.0,
        "nq nv",
    ),
    Row(
        "two craft in contact, step",
        ("ours", "contact"),
        "contact",
        ("rk4",),
        f"{MUJOCO} C, RK4",
        {13: 2.0},
        "nq nv",
    ),
    Row(
        "rollout, RK4, one thread",
        ("ours", "rollout"),
        "mujoco_rollout",
        ("rollout",),
        "mujoco.rollout",
        ROLLOUT,
        "nq nv",
    ),
    Row(
        "rollout, RK4, all cores",
        ("ours_all", "rollout_threads"),
        "mujoco_rollout_all",
        ("rollout_threads",),
        "mujoco.rollout",
        ROLLOUT,
        "nq nv",
    ),
    Row(
        "humanoid_reach, controlled step",
        ("ours", "reach"),
        "reach",
        ("step", "step_rate"),
        f"{PIN} loop, RK4",
        2.5,
        "nq nv",
    ),
    Row(
        "the same without orbit",
        ("ours", "reach_empty"),
        "reach",
        ("step", "step_rate"),
        f"{PIN} loop, RK4",
        None,
        "nq nv",
    ),
    Row(
        "controlled rollout of 1024 arms",
        ("ours", "controlled_rollout"),
        "controlled",
        ("step", "step_rate"),
        f"{PIN} loop, RK4",
        12.0,
        "nq nv",
    ),
    Row(
        "derivatives of forward dynamics, batch",
        ("ours", "derivatives"),
        "kernels",
        ("derivatives",),
        f"{PIN} computeABADerivatives",
        4.0,
        "nv*nv nv*nv nv*nv",
    ),
    Row("one call from Python", ("ours", "call"), "pinocchio_calls", ("call",), "pin.aba", 2.0, "nv"),
]
