"""Convex pieces of meshes: distances in a notch, contact with two pieces, the cache, and invalid input."""

from __future__ import annotations

import importlib.metadata
import os
import pickle
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest
from collision_robots import INERTIAL, body, element, world_of
from prisms import BRICK, L, U, prism

import onorbit_rs as oo
from onorbit_rs.convex_pieces import cache, divide
from onorbit_rs.exceptions import InputError, ModelError
from onorbit_rs.robots.urdf import urdf_text
from onorbit_rs.visuals.shapes import collision_shapes

needs_coacd = pytest.mark.skipif(
    "coacd" not in {d.metadata["Name"] for d in importlib.metadata.distributions()},
    reason="CoACD is not installed: pip install 'onorbit-rs[meshes]'",
)
AT_ORIGIN = [0, 0, 0, 0, 0, 0, 1]


@pytest.fixture(autouse=True)
def _own_cache(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("LOCALAPPDATA" if sys.platform == "win32" else "XDG_CACHE_HOME", str(tmp_path))
    monkeypatch.setenv("HOME", str(tmp_path))
    monkeypatch.setattr(divide, "_known", {})


def rigid(shape: oo.Shape, mass: float = 1.0) -> oo.Model:
    return oo.Model.rigid_body(mass, mass * np.eye(3)).with_collision("base", shape)


def points(shape: oo.Shape) -> list[np.ndarray]:
    return [np.array(piece.points) for piece in rigid(shape).collisions]


def gap(solid: oo.Shape, radius: float, at: np.ndarray) -> float:
    world = world_of(rigid(solid), rigid(oo.Shape.sphere(radius)))
    return oo.distance(world, {"a": AT_ORIGIN, "b": [*at, 0, 0, 0, 1]}, "a/base", "b/base").distance


@needs_coacd
def test_a_probe_in_the_notch_has_the_distance_of_the_walls(tmp_path: Path) -> None:
    file = prism(tmp_path / "u.obj", U)
    pieces, hull = oo.Shape.mesh(file, pieces=8), oo.Shape.mesh(file)
    assert (pieces.kind, len(points(pieces))) == ("mesh", 3)
    rng = np.random.default_rng(7)
    for _ in range(50):
        radius = rng.uniform(0.02, 0.05)
        at = rng.uniform([-0.24, -0.15, 0.26], [0.24, 0.15, 0.7])
        exact = min(0.3 - abs(at[0]), at[2] - 0.2) - radius
        assert abs(gap(pieces, radius, at) - exact) < 1e-12
        assert gap(hull, radius, at) < -radius, "the hull fills the notch"


@needs_coacd
@pytest.mark.parametrize("scale", [(1.0, 1.0, 1.0), (2.0, 1.0, -0.5), (-1.0, -1.0, -1.0)])
def test_scaled_and_mirrored_pieces_fill_the_mesh(scale: tuple[float, ...], tmp_path: Path) -> None:
    pieces = oo.Shape.mesh(prism(tmp_path / "l.obj", L), scale=scale, pieces=4)
    inside, outside = np.array([-0.4, 0.1, 0.6]), np.array([0.2, 0.1, 0.5])
    for at, is_inside in [(inside, True), (outside, False), (np.array([0.4, -0.2, 0.1]), True)]:
        assert (gap(pieces, 1e-6, at * scale) < 0.0) == is_inside
    corners = np.vstack(points(pieces))
    limits = np.array([[-0.5, -0.25, 0.0], [0.5, 0.25, 0.8]]) * scale
    assert np.allclose(np.ptp(corners, axis=0), np.ptp(limits, axis=0), atol=1e-12)


@needs_coacd
def test_a_capsule_in_the_notch_bounces_off_floor_and_wall_at_once(tmp_path: Path) -> None:
    """Across smooth planes at a right angle, an elastic impact reverses both components of the velocity."""
    file = prism(tmp_path / "u.obj", U)
    capsule = rigid(oo.Shape.capsule(0.05, 0.1))
    along_y = [np.sqrt(0.5), 0, 0, np.sqrt(0.5)]
    start = [-0.23, 0, 0.27, *along_y]  # 2 cm from the floor and from a wall
    velocity = [-0.1, -0.1, 0, 0, 0, 0]  # base axes: towards both, at 0.1 m/s
    law = oo.HuntCrossley(1e6)

    def world(shape: oo.Shape) -> oo.World:
        heavy = rigid(shape, 1e7)
        systems = [oo.System("channel", heavy, AT_ORIGIN, np.zeros(6))]
        systems.append(oo.System("rod", capsule, start, velocity))
        contact = oo.Contact("channel/*", "rod/*", normal=law, friction=None, name="touch")
        return oo.World(systems, contacts=[contact])

    moved = capsule.frame_velocity(start, velocity, "base")[:3]
    assert np.allclose(moved, [-0.1, 0.0, -0.1]), moved
    with pytest.raises(oo.exceptions.WorldError, match=r"overlap by 0\.32 m"):
        oo.Simulation(world(oo.Shape.mesh(file)), time_step=0.01).run(0.1)
    trace = oo.Simulation(world(oo.Shape.mesh(file, pieces=8)), time_step=0.01).run(0.5)
    touch = trace.contacts["touch"]
    assert touch.touches[-1] == 1, "both pieces belong to one touch"
    peak = touch.force[np.linalg.norm(touch.force, axis=1).argmax()]
    assert np.allclose(peak / np.linalg.norm(peak), [np.sqrt(0.5), 0, np.sqrt(0.5)], atol=1e-6)
    np.testing.assert_allclose(touch.impulse[-1], [0.2, 0, 0.2], atol=1e-6)
    assert np.abs(trace.momentum - trace.momentum[0]).max() < 1e-12


@needs_coacd
def test_the_cache_has_the_bits_of_a_new_division(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    file = prism(tmp_path / "u.obj", U)
    new = points(oo.Shape.mesh(file, pieces=8))
    home = cache.folder()
    assert home is not None
    (entry,) = home.iterdir()
    content = entry.read_bytes()

    def again() -> list[np.ndarray]:
        monkeypatch.setattr(divide, "_known", {})
        return points(oo.Shape.mesh(file, pieces=8))

    program = divide.PROGRAM
    monkeypatch.setattr(divide, "PROGRAM", tmp_path / "absent.py")
    assert all(np.array_equal(a, b) for a, b in zip(again(), new, strict=True)), "from the file"
    for damage in (b"", content[:40], content[:-1] + bytes([content[-1] ^ 1]), b"x" * len(content)):
        entry.write_bytes(damage)
        monkeypatch.setattr(divide, "PROGRAM", tmp_path / "absent.py")
        with pytest.raises(ModelError, match="CoACD failed"):
            again()
        monkeypatch.setattr(divide, "PROGRAM", program)
        assert all(np.array_equal(a, b) for a, b in zip(again(), new, strict=True))
        assert entry.read_bytes() == content, "the damaged file is replaced"
    oo.Shape.mesh(file, pieces=7)
    oo.Shape.mesh(file, pieces=8, scale=[1, 1, 2])
    assert len(list(home.iterdir())) == 3, "each mesh and number of pieces has its own file"


@needs_coacd
@pytest.mark.skipif(sys.platform == "win32", reason="the cache is in another folder on Windows")
def test_without_write_access_nothing_is_cached(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    file = prism(tmp_path / "u.obj", U)
    monkeypatch.setenv("XDG_CACHE_HOME", str(file))  # a file, in which no folder can be made
    assert len(points(oo.Shape.mesh(file, pieces=8))) == 3
    monkeypatch.setattr(divide, "PROGRAM", tmp_path / "absent.py")
    assert len(points(oo.Shape.mesh(file, pieces=8))) == 3, "this process remembers them"


@needs_coacd
def test_two_processes_divide_the_same_mesh_at_once(tmp_path: Path) -> None:
    file = prism(tmp_path / "u.obj", U)
    program = (
        "import sys, onorbit_rs as oo, numpy as np\n"
        "shape = oo.Shape.mesh(sys.argv[1], pieces=8)\n"
        "model = oo.Model.rigid_body(1.0, np.eye(3)).with_collision('base', shape)\n"
        "print(*[x.hex() for piece in model.collisions for point in piece.points for x in point])"
    )
    command = [sys.executable, "-c", program, str(file)]
    runs = [subprocess.Popen(command, stdout=subprocess.PIPE, env=os.environ) for _ in range(2)]
    texts = [run.communicate()[0].split() for run in runs]
    expected = [x.hex() for x in np.concatenate(points(oo.Shape.mesh(file, pieces=8))).ravel().tolist()]
    assert [text.decode() for text in texts[0]] == [text.decode() for text in texts[1]] == expected
    home = cache.folder()
    assert home is not None and len(list(home.iterdir())) == 1, "no temporary file remains"


def link_with(file: Path) -> oo.Model:
    return body(element(f"<mesh filename='{file}'/>", (0, 0, 1)), element("<sphere radius='0.1'/>"))


@needs_coacd
def test_meshes_of_a_robot_file_are_divided_in_place(tmp_path: Path) -> None:
    model = link_with(prism(tmp_path / "u.obj", U))
    divided = model.with_convex_pieces("body", 8)
    assert [shape.kind for shape in model.collisions] == ["mesh", "sphere"]
    assert [shape.kind for shape in divided.collisions] == ["hull", "hull", "hull", "sphere"]
    probe = rigid(oo.Shape.sphere(0.05))
    q = {"a": AT_ORIGIN, "b": [0.1, 0, 1.5, 0, 0, 0, 1]}
    for copy in (divided, pickle.loads(pickle.dumps(divided))):
        assert abs(oo.distance(world_of(copy, probe), q, "a/body", "b/base").distance - 0.15) < 1e-12
    assert "hull" not in urdf_text(divided) and "<sphere" in urdf_text(divided)
    drawn = [shape for shape in collision_shapes(divided) if shape.mesh is not None]
    heights = [shape.mesh.bounds[1][2] for shape in drawn if shape.mesh is not None]
    assert sorted(round(float(height), 6) for height in heights) == [0.2, 0.8, 0.8]


@needs_coacd
def test_mujoco_has_the_same_pieces(tmp_path: Path) -> None:
    channel = rigid(oo.Shape.mesh(prism(tmp_path / "u.obj", U), pieces=8), 1e3)
    ball = rigid(oo.Shape.sphere(0.05))
    systems = [
        oo.System("channel", channel, AT_ORIGIN, np.zeros(6)),
        oo.System("ball", ball, [0, 0, 0.27, 0, 0, 0, 1], [0, 0, -0.1, 0, 0, 0]),
    ]
    contact = oo.Contact("channel/*", "ball/*", normal=oo.HuntCrossley(1e5), name="touch")
    world = oo.World(systems, contacts=[contact])
    engine = oo.engines.Mujoco({"channel": channel, "ball": ball}, contacts=[contact])
    bounced = [
        oo.Simulation(world, time_step=1e-3, engine=engine_or_none).run(0.5)["ball"].v[-1, 2]
        for engine_or_none in (None, engine)
    ]
    assert abs(bounced[0] - 0.0998) < 2e-4 and abs(bounced[1] - bounced[0]) < 1e-3, bounced


SCENARIO = """\
systems:
  channel:
    robot: {rigid_body: {mass: 100, inertia: [10, 10, 10]}}
    collision:
      - {link: base, shape: {kind: mesh, file: u.obj, pieces: 8}}
  probe:
    robot: ball
    initial: {position: [0, 0, 50 cm]}
distances:
  - {name: pair, between: [channel/*, probe/*]}
simulation: {duration: 0.1 s, time_step: 10 ms}
"""


@needs_coacd
def test_pieces_in_a_scenario(tmp_path: Path) -> None:
    prism(tmp_path / "u.obj", U)
    (tmp_path / "notch.yaml").write_text(SCENARIO)
    run = oo.run(tmp_path / "notch.yaml", out=None)
    assert abs(run.summary["clearance_pair_min_m"] - 0.2) < 1e-12
    collision = element("<mesh filename='u.obj'/>")
    (tmp_path / "box.urdf").write_text(
        f"<robot name='c'><link name='base'>{INERTIAL}{collision}</link></robot>"
    )
    text = SCENARIO.replace("{rigid_body: {mass: 100, inertia: [10, 10, 10]}}", "box.urdf")
    text = text.replace("shape: {kind: mesh, file: u.obj, pieces: 8}", "pieces: 8")
    (tmp_path / "notch.yaml").write_text(text)
    run = oo.run(tmp_path / "notch.yaml", out=None)
    assert abs(run.summary["clearance_pair_min_m"] - 0.2) < 1e-12


@pytest.mark.parametrize(
    ("entry", "message"),
    [
        ("{link: base}", "neither 'shape' nor 'pieces' is given"),
        ("{link: base, pieces: 0}", "pieces: 0 is below the minimum, 1"),
        ("{link: base, pieces: 4, shape: {kind: sphere, radius: 1}}", "move 'pieces' into 'shape'"),
        ("{link: base, pieces: 4, pose: {position: [0, 0, 1]}}", "add 'shape' or omit 'pose'"),
        ("{link: base, pieces: 4}", "the link has none"),
    ],
)
def test_wrong_entries_of_a_scenario(entry: str, message: str, tmp_path: Path) -> None:
    text = SCENARIO.replace("{link: base, shape: {kind: mesh, file: u.obj, pieces: 8}}", entry)
    (tmp_path / "notch.yaml").write_text(text)
    with pytest.raises((oo.exceptions.ScenarioError, ModelError), match=message) as caught:
        oo.run(tmp_path / "notch.yaml", out=None)
    assert "notch.yaml:5" in str(caught.value)


@needs_coacd
def test_too_few_pieces_are_a_warning(tmp_path: Path) -> None:
    with pytest.warns(
        UserWarning, match=r"the 2 convex pieces of .* have \d+ % more volume .* 'pieces', which is 2"
    ):
        oo.Shape.mesh(prism(tmp_path / "u.obj", U), pieces=2)


@needs_coacd
def test_a_mesh_inside_out_is_divided_with_a_warning(tmp_path: Path) -> None:
    expected = points(oo.Shape.mesh(prism(tmp_path / "u.obj", U), pieces=8))
    with pytest.warns(UserWarning, match=r"is inside out .*; its triangles are reversed") as caught:
        shape = oo.Shape.mesh(prism(tmp_path / "r.obj", U, is_reversed=True), pieces=8)
    assert len(caught) == 1 and len(points(shape)) == len(expected)
    assert abs(gap(shape, 0.05, np.array([0, 0, 0.5])) - 0.25) < 1e-12


def test_an_open_or_missing_mesh_has_no_pieces(tmp_path: Path) -> None:
    file = prism(tmp_path / "open.obj", U, drop=1)
    for attempt in (
        lambda: oo.Shape.mesh(file, pieces=8),
        lambda: link_with(file).with_convex_pieces("body", 8),
    ):
        with pytest.raises(ModelError, match=r"oriented at 3 edges, .* no inside .* omit 'pieces'"):
            attempt()
    with pytest.raises(ModelError, match=r"absent\.obj"):
        oo.Shape.mesh(tmp_path / "absent.obj", pieces=8)
    missing = link_with(tmp_path / "absent.obj")
    with pytest.raises(ModelError, match=r"link 'body'.*absent\.obj"):
        missing.with_convex_pieces("body", 8)
    with pytest.raises(ModelError, match=r"link 'base' .*: none of them is a mesh"):
        rigid(oo.Shape.sphere(1.0)).with_convex_pieces("base", 8)
    with pytest.raises(oo.exceptions.FrameError, match="hand"):
        link_with(prism(tmp_path / "u.obj", U)).with_convex_pieces("hand", 8)


@pytest.mark.parametrize("pieces", [0, -1, 1001])
def test_the_number_of_pieces_has_a_range(pieces: int, tmp_path: Path) -> None:
    with pytest.raises(InputError, match=f"pieces is {pieces}; .* from 1 to 1000, such as 16"):
        oo.Shape.mesh(prism(tmp_path / "u.obj", U), pieces=pieces)


def test_without_the_library_the_message_says_what_to_install(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    def absent(name: str) -> str:
        raise importlib.metadata.PackageNotFoundError(name)

    monkeypatch.setattr(importlib.metadata, "version", absent)
    with pytest.raises(ModelError, match=r"pip install 'onorbit-rs\[meshes\]'") as caught:
        oo.Shape.mesh(prism(tmp_path / "u.obj", U), pieces=8)
    assert caught.value.path == str(tmp_path / "u.obj")
    # a convex mesh, and one piece, are hulls
    assert len(points(oo.Shape.mesh(prism(tmp_path / "brick.obj", BRICK), pieces=8))) == 1
    assert len(points(oo.Shape.mesh(tmp_path / "u.obj", pieces=1))) == 1


@needs_coacd
def test_a_crash_of_the_library_is_an_error(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    program = tmp_path / "crash.py"
    program.write_text("import os; os.abort()")
    monkeypatch.setattr(divide, "PROGRAM", program)
    with pytest.raises(ModelError, match=r"CoACD failed .* ended with the code -6\); simplify the mesh"):
        oo.Shape.mesh(prism(tmp_path / "u.obj", U), pieces=8)
