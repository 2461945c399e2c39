"""Writes `fixtures/layouts.json`: states of a bundled robot in Drake, SPART and RBDL, and their link poses.

Run where `drake` and `spartpy` are installed, with a program built from `generate_layouts_rbdl.cc`:

    python generate_layouts.py RBDL_PROGRAM

Made with drake 1.51.1, spartpy 1.1.3 and the C++ sources in pyrbdl 0.0.2 (g++ 12), from PyPI, on 2026-11-21.
"""

from __future__ import annotations

import importlib
import json
import subprocess
import sys
import tempfile
from importlib.metadata import version
from pathlib import Path
from typing import Any
from xml.etree import ElementTree

import numpy as np

from onorbit_rs.tools.validation.against_spart import with_inertia_alone

ROOT = Path(__file__).parents[2]
URDF = ROOT / "python" / "onorbit_rs" / "robots" / "humanoid_dual_arm.urdf"
OUT = ROOT / "tests" / "fixtures" / "layouts.json"


def drake() -> dict[str, Any]:
    """Sets the state through Drake's typed calls and reads its vectors."""
    tree, parsing = (importlib.import_module(f"pydrake.multibody.{name}") for name in ("plant", "parsing"))
    math = importlib.import_module("pydrake.math")
    spatial = importlib.import_module("pydrake.multibody.math")
    geometry = importlib.import_module("pydrake.common.eigen_geometry")
    plant = tree.MultibodyPlant(0.0)
    (instance,) = parsing.Parser(plant).AddModelsFromString(URDF.read_text(), "urdf")
    plant.Finalize()
    context = plant.CreateDefaultContext()
    rng = np.random.default_rng(11)
    quat = rng.normal(size=4)
    quat /= np.linalg.norm(quat)
    p, v, w = rng.uniform(-2, 2, (3, 3))
    base = plant.GetBodyByName("torso")
    plant.SetFreeBodyPose(context, base, math.RigidTransform(geometry.Quaternion(wxyz=quat[[3, 0, 1, 2]]), p))
    plant.SetFreeBodySpatialVelocity(context=context, body=base, V_JpJc=spatial.SpatialVelocity(w, v))
    joints = [plant.get_joint(index) for index in plant.GetJointIndices()]
    joints = [joint for joint in joints if joint.num_positions() == 1]
    for joint in joints:
        angle, rate = rng.uniform(-1.5, 1.5, 2)
        joint.set_angle(context, angle)
        joint.set_angular_rate(context, rate)
    joints.sort(key=lambda joint: joint.position_start())
    links = {}
    for index in plant.GetBodyIndices(instance):
        body = plant.get_body(index)
        velocity = plant.EvalBodySpatialVelocityInWorld(context, body)
        links[body.name()] = {
            "pose": plant.EvalBodyPoseInWorld(context, body).GetAsMatrix4().tolist(),
            "velocity": [*velocity.translational(), *velocity.rotational()],
        }
    return {
        "source": f"drake {version('drake')}",
        "position_m": p.tolist(), "quat_xyzw": quat.tolist(), "joints": [joint.name() for joint in joints],
        "q": plant.GetPositions(context).tolist(), "v": plant.GetVelocities(context).tolist(), "links": links,
    }  # fmt: skip


def spart() -> dict[str, Any]:
    """Returns the states and poses of links with an inertia by SPART."""
    module = importlib.import_module("SPARTpy.SPARTpy")
    with tempfile.NamedTemporaryFile("w", suffix=".urdf") as file:
        file.write(with_inertia_alone(URDF.read_text()))
        file.flush()
        engine = module.SPART(file.name)
        _, keys = module._parse_urdf(file.name)
    n, rng = engine.robot.n_q, np.random.default_rng(13)
    quat = rng.normal(size=4)
    x, y, z, w = quat / np.linalg.norm(quat)
    rot = np.array(
        [
            [1 - 2 * (y * y + z * z), 2 * (x * y - z * w), 2 * (x * z + y * w)],
            [2 * (x * y + z * w), 1 - 2 * (x * x + z * z), 2 * (y * z - x * w)],
            [2 * (x * z - y * w), 2 * (y * z + x * w), 1 - 2 * (x * x + y * y)],
        ]
    )
    r0, qm = rng.uniform(-2, 2, 3), rng.uniform(-1.5, 1.5, n)
    u0, um = rng.uniform(-1, 1, 6), rng.uniform(-1, 1, n)
    _, link_rot, _, link_pos, e, g = engine.kinematics(rot, r0, qm)
    b_ij, b_i0, p0, pm = engine.diff_kinematics(rot, r0, link_pos, e, g)
    t0, twists = engine.velocities(b_ij, b_i0, p0, pm, u0, um)
    links = {
        name: {
            "com": link_pos[:, int(i) - 1].tolist(), "twist": twists[:, int(i) - 1].tolist(),
            "rotation": link_rot[:, 3 * (int(i) - 1) : 3 * int(i)].tolist(),
        }
        for name, i in keys["link_id"].items() if i > 0
    }  # fmt: skip
    order = {name: i for name, i in keys["q_id"].items() if i > 0}
    return {
        "source": f"spartpy {version('spartpy')}", "joints": sorted(order, key=order.__getitem__),
        "R0": rot.tolist(), "r0": r0.tolist(), "qm": qm.tolist(), "u0": u0.tolist(), "um": um.tolist(),
        "t0": t0.tolist(), "links": links,
    }  # fmt: skip


def rbdl(program: str) -> dict[str, Any]:
    """Runs the program, which draws a state in RBDL's layout and prints the links' poses and velocities."""
    names = [str(link.get("name")) for link in ElementTree.parse(URDF).getroot().findall("link")]
    done = subprocess.run([program, str(URDF), *names], capture_output=True, text=True, check=True)
    table = json.loads(done.stdout)
    order = table.pop("order")
    for link in table["links"].values():
        rows, p = np.reshape(link.pop("rotation"), (3, 3)), np.reshape(link.pop("position"), (3, 1))
        link["pose"] = [*np.hstack([rows, p]).tolist(), [0, 0, 0, 1]]
    joints = [name.replace("_link_", "_joint_") for name in sorted(order, key=order.__getitem__)]
    return {"source": "RBDL's C++ sources in pyrbdl 0.0.2", "joints": joints} | table


if __name__ == "__main__":
    OUT.write_text(json.dumps({"drake": drake(), "spart": spart(), "rbdl": rbdl(sys.argv[1])}))
