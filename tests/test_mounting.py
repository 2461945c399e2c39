"""An arm on a bus from two files equals the same robot in one URDF; inertial values of links are replaced."""

from __future__ import annotations

import pickle
import warnings
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import yaml
from commands import onorbit, refusal

import onorbit_rs as oo
from onorbit_rs.scenario import load

INERTIAL = (
    '<inertial><origin xyz="{com}" rpy="0.1 0.2 0.3"/><mass value="{mass}"/>'
    '<inertia ixx="{i}" iyy="{j}" izz="{j}" ixy="0.001" ixz="0" iyz="0"/></inertial>'
)
BUS = (
    f'<link name="hull">{INERTIAL.format(com="0.1 0 0", mass=300, i=60, j=70)}</link><link name="plate"/>'
    '<joint name="bolted" type="fixed"><parent link="hull"/><child link="plate"/>'
    '<origin xyz="0.6 0 0.2" rpy="0 1.2 0.4"/></joint>'
)
PLACED = {"position": [0.1, -0.2, 0.05], "attitude": {"roll_pitch_yaw": [0.3, -0.4, 0.5]}}


def _robot(source: object) -> oo.Model:
    """Returns the robot of a scenario."""
    scenario = load(source)  # type: ignore[arg-type]
    return scenario.robot.build(scenario)


def arm(prefix: str = "", *, tool_mass: float = 2.0) -> str:
    """Return an arm of four revolute or prismatic joints with its own base and a tool frame."""
    parts = [f'<link name="{prefix}base">{INERTIAL.format(com="0 0 0.1", mass=4, i=0.03, j=0.04)}</link>']
    parent = "base"
    for index, (kind, axis) in enumerate(
        [("revolute", "0 0 1"), ("revolute", "0 1 0"), ("prismatic", "1 0 0"), ("continuous", "0.6 0 0.8")]
    ):
        limit = '<limit lower="-2" upper="2" effort="50" velocity="1"/>' if kind != "continuous" else ""
        parts += [
            f'<link name="{prefix}l{index}">'
            f"{INERTIAL.format(com='0 0 0.2', mass=tool_mass, i=0.05, j=0.04)}</link>",
            f'<joint name="{prefix}j{index}" type="{kind}"><parent link="{prefix}{parent}"/>'
            f'<child link="{prefix}l{index}"/><origin xyz="0 0.05 0.3" rpy="0.2 0 0.1"/><axis xyz="{axis}"/>'
            f"{limit}</joint>",
        ]
        parent = f"l{index}"
    parts.append(
        f'<link name="{prefix}tool"/><joint name="{prefix}t" type="fixed"><parent link="{prefix}l3"/>'
        f'<child link="{prefix}tool"/><origin xyz="0 0 0.1"/></joint>'
    )
    return "".join(parts)


def robot(name: str, inside: str) -> str:
    return f'<robot name="{name}">{inside}</robot>'


def mounted(prefix: str, link: str, xyz: str, rpy: str) -> str:
    return (
        f'{arm(prefix)}<joint name="{prefix}mount" type="fixed"><parent link="{link}"/>'
        f'<child link="{prefix}base"/><origin xyz="{xyz}" rpy="{rpy}"/></joint>'
    )


WHOLE = robot(
    "bus",
    BUS
    + mounted("left_", "plate", "0.1 -0.2 0.05", "0.3 -0.4 0.5")
    + mounted("right_", "hull", "0 0 0", "0 0 0"),
)


@pytest.fixture
def files(tmp_path: Path) -> Path:
    (tmp_path / "bus.urdf").write_text(robot("bus", BUS))
    (tmp_path / "arm.urdf").write_text(robot("arm", arm()))
    return tmp_path


def scenario(folder: Path, **robot: Any) -> Path:
    file = folder / "mine.yaml"
    file.write_text(yaml.safe_dump({"robot": robot, "simulation": {"duration": "0.1 s"}}))
    return file


def off(one: oo.Model, other: oo.Model) -> float:
    """Return the largest relative difference of mass matrix, bias forces and frame poses."""
    assert (one.joint_names, one.body_names) == (other.joint_names, other.body_names)
    rng = np.random.default_rng(4)
    q = one.integrate(one.neutral(), rng.normal(size=one.nv))
    v = rng.normal(size=one.nv)
    pairs = [(one.mass_matrix(q), other.mass_matrix(q)), (one.bias_forces(q, v), other.bias_forces(q, v))]
    pairs += [(one.frame_pose(q, name), other.frame_pose(q, name)) for name in one.frame_names]
    return max(float(np.abs(a - b).max() / np.abs(b).max()) for a, b in pairs)


def pose(xyz: list[float], rpy: list[float]) -> Any:
    """Return a transform (4, 4), with its rotation as a product of three elementary rotations."""
    (a, b, c), made = rpy, np.eye(4)
    x = [[1, 0, 0], [0, np.cos(a), -np.sin(a)], [0, np.sin(a), np.cos(a)]]
    y = [[np.cos(b), 0, np.sin(b)], [0, 1, 0], [-np.sin(b), 0, np.cos(b)]]
    z = [[np.cos(c), -np.sin(c), 0], [np.sin(c), np.cos(c), 0], [0, 0, 1]]
    made[:3, :3], made[:3, 3] = np.array(z) @ y @ x, xyz
    return made


def test_two_arms_on_a_bus_are_the_robot_of_one_file(files: Path) -> None:
    bus, arm_of_file = oo.robots.load(files / "bus.urdf"), oo.robots.load(files / "arm.urdf")
    place = pose([0.1, -0.2, 0.05], [0.3, -0.4, 0.5])
    one_arm = oo.attach(bus, "plate", arm_of_file, pose=place, prefix="left_")
    both = oo.attach(one_arm, "hull", arm_of_file, "base", prefix="right_")
    whole = oo.Model.from_urdf_string(WHOLE)
    assert both.name == "bus" and set(both.frame_names) == set(whole.frame_names)
    assert off(both, whole) < 1e-13
    misplaced = oo.attach(one_arm, "plate", arm_of_file, prefix="right_")
    assert off(misplaced, whole) > 1e-3  # negative control


def test_pinocchio_appends_the_same_model(files: Path) -> None:
    pin = pytest.importorskip("pinocchio", reason="the oracle is not installed: pip install pin")
    bus = pin.buildModelFromXML(robot("bus", BUS), pin.JointModelFreeFlyer())
    arm_alone = pin.buildModelFromXML(robot("arm", arm()))
    place = pose([0.1, -0.2, 0.05], [0.3, -0.4, 0.5])
    theirs = pin.appendModel(bus, arm_alone, bus.getFrameId("plate"), pin.SE3(place))
    ours = oo.attach(
        oo.robots.load(files / "bus.urdf"),
        "plate",
        oo.robots.load(files / "arm.urdf"),
        pose=place,
        prefix="x_",
    )
    rng = np.random.default_rng(2)
    q = ours.integrate(ours.neutral(), rng.normal(size=ours.nv))
    turn = q[-1]  # its last joint, unbounded, is a cosine and a sine to Pinocchio
    data = theirs.createData()
    found = pin.crba(theirs, data, np.concatenate([q[:-1], [np.cos(turn), np.sin(turn)]]))
    found = np.triu(found) + np.triu(found, 1).T
    np.testing.assert_allclose(ours.mass_matrix(q), found, rtol=0, atol=1e-13 * np.abs(found).max())


def test_a_scenario_mounts_and_changes(files: Path) -> None:
    file = scenario(
        files,
        bus="bus.urdf",
        arms=[
            {"urdf": "arm.urdf", "at": "plate", "pose": PLACED, "prefix": "left_"},
            {"urdf": "arm.urdf", "at": "hull", "frame": "base", "prefix": "right_",
             "links": {"l3": {"mass": "5 kg"}}},
        ],
        links={"hull": {"mass": "0.2 t", "com": [0, "10 cm", 0], "inertia": [30, 40, 50]}},
    )  # fmt: skip
    model = _robot(file)
    expected = oo.Model.from_urdf_string(WHOLE).with_link("right_l3", mass=5.0)
    expected = expected.with_link("hull", mass=200.0, com=[0, 0.1, 0], inertia=np.diag([30.0, 40.0, 50.0]))
    assert off(model, expected) < 1e-13
    assert model.mass == pytest.approx(200 + 2 * (4 + 4 * 2) + 3, rel=1e-15)
    # the resolved scenario builds the same robot
    again = _robot(load(file).resolved(files))
    assert off(again, model) == 0.0
    done = onorbit("run", file, "--out", files / "out", cwd=files)
    assert done.returncode == 0 and "certificate passed" in done.stdout, done
    assert onorbit("report", files / "out").returncode == 0


def test_links_are_changed_before_a_file_is_checked(files: Path) -> None:
    bare = robot("bus", '<link name="hull"/>')
    (files / "bare.urdf").write_text(bare)
    with pytest.raises(oo.exceptions.ModelError, match=r"bare\.urdf: the robot has no mass.*'links'"):
        oo.Model.from_urdf(files / "bare.urdf")
    given = {"mass": 10.0, "inertia": np.diag([1.0, 2.0, 2.5])}
    model = oo.Model.from_urdf(files / "bare.urdf", links={"hull": given})
    given["inertia"][0, 0] = 7.0  # modified from here on
    assert model.mass == 10.0 and pickle.loads(pickle.dumps(model)).bodies[0].inertia[0][0] == 1.0
    file = scenario(files, bus={"urdf": "bare.urdf", "links": {"hull": {"mass": 10, "inertia": [1, 2, 2.5]}}},
                    arms=[{"urdf": "arm.urdf", "at": "hull"}])  # fmt: skip
    assert _robot(file).mass == 10.0 + 12.0
    for links, message in [
        ({"hul": {"mass": 1}}, "did you mean 'hull'"),
        (
            {"hull": {"mas": 1}},
            "links\\[\"hull\"\\] has the unknown key 'mas'; the keys are mass, com and inertia",
        ),
        ({"hull": 3}, "expected a dict with mass, com or inertia"),
        ({"hull": {"com": [0, 0, 1]}}, "link 'hull' has no mass; give it a mass together"),
        ({"hull": {"mass": "3 kg"}}, 'the mass in links\\["hull"\\] is not a number'),
    ]:
        with pytest.raises(oo.OnOrbitError, match=message):
            oo.Model.from_urdf(files / "bare.urdf", links=links)  # type: ignore[dict-item]  # some are wrong


def test_combined_robots_can_be_pickled(files: Path) -> None:
    bus, arm_of_file = oo.robots.load(files / "bus.urdf"), oo.robots.load(files / "arm.urdf")
    changed = oo.attach(bus, "plate", arm_of_file, pose=np.eye(4), prefix="x_").with_link("x_l3", mass=9.0)
    assert off(pickle.loads(pickle.dumps(changed)), changed) == 0.0
    looped = bus
    for step in range(2000):  # no history is kept
        looped = looped.with_link("hull", mass=300.0 + step)
    again = pickle.loads(pickle.dumps(looped.with_link("hull", com=[0.0, 0.0, 0.2])))
    assert again.mass == 2299.0 and list(again.bodies[0].com) == [0.0, 0.0, 0.2]
    (files / "arm.urdf").write_text(robot("arm", arm(tool_mass=2.5)))
    with pytest.raises(oo.exceptions.ModelError, match="no longer describes the pickled robot"):
        pickle.loads(pickle.dumps(changed))


def test_joints_on_the_base_keep_their_order(files: Path) -> None:
    """Robots attached first stay first, independent of the base frame of later ones."""
    bus, arm_of_file = oo.robots.load(files / "bus.urdf"), oo.robots.load(files / "arm.urdf")
    one = oo.attach(bus, "hull", arm_of_file, prefix="a_")
    two = oo.attach(one, "plate", arm_of_file, prefix="b_")
    assert two.joint_names == [*one.joint_names, *(f"b_{name}" for name in arm_of_file.joint_names)]
    # robots on a link of the first arm follow the joints beyond it
    on_link = oo.attach(one, "a_l1", arm_of_file, prefix="b_")
    assert [name[0] for name in on_link.joint_names] == ["a"] * 4 + ["b"] * 4


def test_an_arm_need_not_be_a_valid_free_floating_robot(files: Path) -> None:
    """Its base may lack mass, because it is combined with the bus."""
    (files / "light.urdf").write_text(robot("arm", _light(arm())))
    with pytest.raises(oo.exceptions.ModelError, match="nothing resists the motion of the base"):
        oo.robots.load(files / "light.urdf")
    bus = oo.robots.load(files / "bus.urdf")
    model = oo.attach(bus, "plate", files / "light.urdf", pose=np.eye(4), prefix="x_")
    whole = oo.Model.from_urdf_string(
        robot("bus", BUS + mounted("x_", "plate", "0 0 0", "0 0 0").replace(arm("x_"), _light(arm("x_"))))
    )
    assert off(model, whole) < 1e-13
    assert off(pickle.loads(pickle.dumps(model)), model) == 0.0
    file = scenario(files, bus="bus.urdf", arms=[{"urdf": "light.urdf", "at": "plate", "prefix": "x_"}])
    assert off(_robot(file), model) == 0.0
    done = onorbit("new", "light.urdf", "--bus", "bus.urdf", "--at", "plate", cwd=files)
    assert done.returncode == 0, done
    with pytest.raises(oo.exceptions.DtypeError, match="other is of type int"):
        oo.attach(bus, "plate", 3)  # type: ignore[arg-type]
    far = np.eye(4)
    far[0, 3] = 1e13
    with pytest.raises(oo.exceptions.ModelError, match=r"between -1e12 and 1e12 \(positions in m\)"):
        oo.attach(bus, "plate", files / "light.urdf", pose=far)
    with pytest.raises(oo.exceptions.NotFoundError):
        oo.attach(bus, "plate", files / "none.urdf")


def _light(text: str) -> str:
    """Returns the URDF text of an arm whose base has no inertial element."""
    start, end = text.index("<inertial>"), text.index("</inertial>") + len("</inertial>")
    return text[:start] + text[end:]


def test_warnings_are_issued_once(files: Path) -> None:
    odd = robot("arm", arm().replace('ixx="0.05"', 'ixx="5"', 1))
    with pytest.warns(UserWarning, match="'l0' violates the triangle"):
        arm_of_text = oo.Model.from_urdf_string(odd)
    bus = oo.robots.load(files / "bus.urdf")
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        whole = oo.attach(bus, "plate", arm_of_text, prefix="x_")
        whole = whole.with_link("hull", mass=250.0)
    assert [warning for warning in whole.warnings if "'x_l0'" in warning] == whole.warnings != []
    with pytest.warns(UserWarning, match="'hull' violates the triangle"):
        whole.with_link("hull", inertia=np.diag([1.0, 1.0, 9.0]))


@pytest.mark.parametrize(
    ("robot", "message"),
    [
        ({"bus": "bus.urdf", "arms": [{"urdf": "arm.urdf", "at": "plte"}]},
         "robot.arms[0]: there is no frame 'plte'; did you mean 'plate'?"),
        ({"bus": "bus.urdf", "arms": [{"urdf": "arm.urdf", "at": "plate"}] * 2},
         "robot.arms[1]: both robots have a link or frame 'base'; give the attached robot a prefix"),
        ({"bus": "bus.urdf", "arms": [{"urdf": "arm.urdf", "at": "plate", "prefix": "a_"}] * 2},
         "robot.arms[1]: with the prefix 'a_', both robots have a link or frame 'a_base'"),
        ({"bus": "bus.urdf", "arms": [{"urdf": "amr.urdf", "at": "plate"}]},
         "amr.urdf: there is no such file"),
        ({"bus": "bus.urdf", "arms": [{"urdf": "arm.urdf"}]}, "robot.arms[0].at: is missing"),
        ({"bus": "bus.urdf", "arms": []}, "robot.arms: has 0 entries; give at least one"),
        ({"bus": "bus.urdf"}, "robot: 'bus' requires 'arms'; list at least one"),
        ({"bus": "bus.urdf", "arms": None}, "robot: 'bus' requires 'arms'; list at least one"),
        ({"urdf": "bus.urdf", "bus": None, "arms": [{"urdf": "arm.urdf", "at": "plate"}]},
         "robot: 'arms' requires 'bus'"),
        ({"bus": "bus.urdf", "arms": [{"urdf": "arm.urdf", "at": "plate", "prefix": "\ud800"}]},
         "contains characters that cannot be printed"),
        ({"arms": [{"urdf": "arm.urdf", "at": "plate"}]}, "robot: 'arms' requires 'bus'"),
        ({"bus": "bus.urdf", "urdf": "arm.urdf", "arms": [{"urdf": "arm.urdf", "at": "plate"}]},
         "give exactly one of 'bundled', 'urdf', 'rigid_body' and 'bus'; given: urdf, bus"),
        ({"urdf": "arm.urdf", "links": {"l8": {"mass": 1}}}, "there is no link 'l8'; did you mean 'l0'?"),
        ({"urdf": "arm.urdf", "links": {"l1": {"mass": "1 m"}}}, "'1 m' is not a mass"),
        ({"rigid_body": {"mass": 1, "inertia": [1, 1, 1]}, "links": {"base": {"mass": 1}}},
         "'links' applies only to robots from files"),
    ],
)  # fmt: skip
def test_invalid_mounts_in_a_scenario_are_rejected(robot: dict[str, Any], message: str, files: Path) -> None:
    message_text = refusal("check", scenario(files, **robot), cwd=files)
    assert message in message_text and "mine.yaml:" in message_text, message_text


def test_from_two_files_to_a_run(files: Path) -> None:
    done = onorbit("new", "arm.urdf", "--bus", "bus.urdf", "--at", "plate", "--prefix", "x_",
                   "--out", "mine.yaml", "--picture", "mine.png", cwd=files)  # fmt: skip
    assert done.returncode == 0 and "picture: mine.png" in done.stdout, done
    assert (files / "mine.png").read_bytes().startswith(b"\x89PNG")
    assert load(files / "mine.yaml").robot.arms is not None
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        run = oo.run(files / "mine.yaml", quiet=True)
    assert run.summary["certificate_passed"] and run.summary["joint_limits_exceeded"] == ""
    assert _robot(files / "mine.yaml").mass == 312.0
    assert "choose one with --at FRAME: hull, plate" in refusal(
        "new", "arm.urdf", "--bus", "bus.urdf", cwd=files
    )
    assert "did you mean 'plate'" in refusal(
        "new", "arm.urdf", "--bus", "bus.urdf", "--at", "plat", cwd=files
    )
    assert "mine.png already exists" in refusal("info", "arm.urdf", "--picture", "mine.png", cwd=files)
    assert "mine.jpg must end in .png" in refusal("info", "arm.urdf", "--picture", "mine.jpg", cwd=files)
    assert "give two different files" in refusal(
        "new", "arm.urdf", "--out", "a.png", "--picture", "a.png", cwd=files
    )
    assert "add --bus ROBOT" in refusal("new", "arm.urdf", "--at", "plate", cwd=files)
    message_text = refusal("new", "arm.urdf", "--bus", "b.xacro", "--at", "plate", "--arg", "m=9", cwd=files)
    assert "robot.bus.xacro_arguments" in message_text
