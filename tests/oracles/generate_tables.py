"""Writes ``tests/fixtures/pinocchio_tables.json``: reference values for tests without Pinocchio.

    python tests/oracles/generate_tables.py

All numbers come from Pinocchio; this package supplies only the joint names.
"""

from __future__ import annotations

import json
from datetime import UTC, datetime
from pathlib import Path
from typing import Any

import numpy as np
import pin_robot
import pinocchio as pin  # type: ignore[import-untyped]

from onorbit_rs.tools.validation.trees import TOOL, build, random_state, random_tree

FILE = Path(__file__).parents[1] / "fixtures" / "pinocchio_tables.json"
SEEDS = (301, 302, 303)
STATES = 2


def plain(value: Any) -> Any:
    return np.asarray(value).tolist()


def case(seed: int) -> dict[str, Any]:
    tree = random_tree(seed, links=8)
    model = build(tree)
    robot = pin_robot.PinRobot(pin_robot.build(tree), model.joint_names)
    rng = np.random.default_rng(seed)
    states = []
    for _ in range(STATES):
        state = random_state(model, rng, frames=2)
        expected = {name: plain(value) for name, value in pin_robot.every_kernel(robot, state, TOOL).items()}
        external = {name: plain(wrench) for name, wrench in state.external.items()}
        given = {name: plain(getattr(state, name)) for name in ("q", "v", "a", "tau")}
        states.append(given | {"external": external, "expected": expected})
    return {"seed": seed, "tree": tree.as_dict(), "joint_names": model.joint_names, "states": states}


def main() -> None:
    table = {
        "generator": "tests/oracles/generate_tables.py",
        "engine": f"pinocchio {pin.__version__}",
        "date": datetime.now(UTC).date().isoformat(),
        "tolerance": 1e-12,
        "tolerance_of": "the largest entry of each array; both engines are off by 1e-14 or so",
        "layout": "q = [p, quat xyzw, joints], v = [linear, angular, rates], wrenches in their frame",
        "cases": [case(seed) for seed in SEEDS],
    }
    FILE.parent.mkdir(exist_ok=True)
    FILE.write_text(json.dumps(table, separators=(",", ":")) + "\n")
    print(f"{FILE}: {FILE.stat().st_size} bytes")


if __name__ == "__main__":
    main()
