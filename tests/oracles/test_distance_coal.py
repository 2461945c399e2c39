"""Distances of links against coal (formerly hpp-fcl), which has another GJK and EPA and other hulls."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import pytest
from collision_robots import body, element, obj_file, random_pose, world_of

import onorbit_rs as oo

coal = pytest.importorskip("coal", reason="the oracle is not installed: pip install pin")

KINDS = ("sphere", "capsule", "box", "cylinder", "hull")
ACCEPTED = 1e-9
"""Accepted difference for shapes of 1 m, m."""

ACCEPTED_OF_ROUND_EPA = 3e-8
"""The same for overlapping cylinders. With a tolerance below 1e-8, the EPA of coal fails, and with 1e-8 its
translation is sometimes far from the shortest one; it is then only an upper bound of the depth."""


def geometry(kind: str, rng: np.random.Generator, folder: Path) -> tuple[str, Any]:
    """Return the same shape as URDF and as an object of coal."""
    radius, length, *edges = (float(x) for x in rng.uniform(0.2, 1.0, 5))
    if kind == "sphere":
        return f"<sphere radius='{radius!r}'/>", coal.Sphere(radius)
    if kind == "capsule":
        return f"<capsule radius='{radius!r}' length='{length!r}'/>", coal.Capsule(radius, length)
    if kind == "box":
        return f"<box size='{' '.join(map(repr, edges))}'/>", coal.Box(*edges)
    if kind == "cylinder":
        return f"<cylinder radius='{radius!r}' length='{length!r}'/>", coal.Cylinder(radius, length)
    points = rng.uniform(-0.5, 0.5, (20, 3))
    listed = coal.StdVec_Vec3s()
    for point in points:
        listed.append(point)
    faces = [(i, i + 1, i + 2) for i in range(18)]
    file = obj_file(folder / f"{rng.integers(1 << 40)}.obj", points, faces)
    return f"<mesh filename='{file}'/>", coal.Convex.convexHull(listed, True, "")


def rotation(quat_xyzw: np.ndarray) -> np.ndarray:
    x, y, z, w = quat_xyzw
    return np.array(
        [
            [1 - 2 * (y * y + z * z), 2 * (x * y - z * w), 2 * (x * z + y * w)],
            [2 * (x * y + z * w), 1 - 2 * (x * x + z * z), 2 * (y * z - x * w)],
            [2 * (x * z - y * w), 2 * (y * z + x * w), 1 - 2 * (x * x + y * y)],
        ]
    )


def coal_distance(a: Any, qa: np.ndarray, b: Any, qb: np.ndarray, epa_tolerance: float) -> float:
    request, result = coal.DistanceRequest(), coal.DistanceResult()
    request.gjk_tolerance, request.epa_tolerance = 1e-12, epa_tolerance
    request.gjk_max_iterations, request.epa_max_iterations = 2000, 250
    place = [coal.Transform3s(rotation(q[3:]), q[:3]) for q in (qa, qb)]
    return float(coal.distance(a, place[0], b, place[1], request, result))


@pytest.mark.filterwarnings("ignore:the collision mesh")
@pytest.mark.parametrize("first", range(5))
@pytest.mark.parametrize("second", range(5))
def test_random_pairs_have_the_distance_of_coal(first: int, second: int, tmp_path: Path) -> None:
    rng = np.random.default_rng(10 * first + second)
    is_round = "cylinder" in (KINDS[first], KINDS[second])
    apart, overlapping = [], []
    for k in range(40):
        (urdf_a, a), (urdf_b, b) = (geometry(KINDS[kind], rng, tmp_path) for kind in (first, second))
        world = world_of(body(element(urdf_a)), body(element(urdf_b)))
        q = {"a": random_pose(rng, 0.3), "b": random_pose(rng, 0.5 if k % 2 else 3.0)}
        found = oo.distance(world, q, "a/body", "b/body").distance
        expected = coal_distance(a, q["a"], b, q["b"], 1e-8 if found < 0 and is_round else 1e-12)
        (overlapping if found < 0 else apart).append(found - expected)
    assert len(apart) >= 10 and len(overlapping) >= 10
    assert np.abs(apart).max() < ACCEPTED
    if is_round:
        assert min(overlapping) > -ACCEPTED_OF_ROUND_EPA
        assert np.median(np.abs(overlapping)) < ACCEPTED_OF_ROUND_EPA
    else:
        assert np.abs(overlapping).max() < ACCEPTED
