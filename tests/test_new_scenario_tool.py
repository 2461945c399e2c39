"""The frame that ``onorbit new`` uses as the tool, with its arm and fingers."""

from __future__ import annotations

from pathlib import Path

import pytest
import yaml
from chain_robots import INERTIAL, SEVEN, arm

import onorbit_rs as oo
from onorbit_rs.tools.new_scenario import draft
from onorbit_rs.tools.new_scenario.arm import find_arm, find_fingers


def hand(fingers: int, *, name: str = "tip", length: float = 0.03) -> str:
    """Returns an arm of seven joints with fingers of two revolute joints and no link named as a tool."""
    parts = []
    for index in range(fingers):
        parent = "link_6"
        for part in ("near", "far"):
            link = f"{name}_{index}_{part}"
            parts.append(
                f'<link name="{link}">{INERTIAL.format(mass=0.05, i=1e-3)}</link>'
                f'<joint name="{link}_joint" type="revolute"><parent link="{parent}"/><child link="{link}"/>'
                f'<origin xyz="0 {length} 0"/><axis xyz="1 0 0"/><limit lower="0" upper="1" effort="9" '
                'velocity="1"/></joint>'
            )
            parent = link
    return arm(SEVEN).replace("</robot>", "".join(parts) + "</robot>")


def test_the_tool_of_a_gripper_is_the_link_that_carries_the_fingers(tmp_path: Path) -> None:
    (tmp_path / "mine.urdf").write_text(hand(2, name="tool_tip"))
    data = yaml.safe_load(draft(str(tmp_path / "mine.urdf"), beside=tmp_path).text)
    assert data["tool"] == "link_6"
    moving, held = data["controllers"]
    assert moving["joints"] == [name for name, *_ in SEVEN]
    assert held["name"] == "hold" and len(held["joints"]) == 4


def test_fingers_are_several_or_have_such_a_name_and_are_short() -> None:
    def found(urdf: str) -> tuple[int, set[str]]:
        fingers, palms = find_fingers(oo.Model.from_urdf_string(urdf))
        return len(fingers), palms

    assert found(hand(2)) == (4, {"link_6"})
    assert found(hand(5)) == (10, {"link_6"})
    assert found(hand(1, name="finger")) == (2, {"link_6"})
    assert found(hand(1, name="finger").replace('"j6"', '"finger_roll"')) == (2, {"link_6"})
    assert found(hand(5).replace('"link_6"', '"thumb"')) == (10, {"thumb"})
    assert found(hand(1)) == (0, set())  # the end of the arm
    assert found(hand(2, length=1.0)) == (0, set())  # two arms on a torso
    assert found(arm(SEVEN)) == (0, set())


def test_a_wrist_in_the_middle_of_an_arm_is_not_the_tool() -> None:
    found = find_arm(oo.Model.from_urdf_string(arm(SEVEN).replace("link_5", "wrist")))
    assert found is not None and found.tool == "link_6"


@pytest.mark.parametrize(
    ("joint", "tool"), [("gripper", "link_6"), ("gripper_roll", "link_7"), ("j7", "link_7")]
)
def test_the_joint_that_opens_a_gripper_is_not_part_of_the_arm(joint: str, tool: str) -> None:
    """One jaw on the last link (so100, z1) is not part of the arm; a joint that rotates the gripper is."""
    found = find_arm(oo.Model.from_urdf_string(arm([*SEVEN, (joint, "revolute", "0 0 1")])))
    assert found is not None and found.tool == tool


def test_a_single_finger_does_not_define_a_palm() -> None:
    """A hand without an arm moves the finger with the most joints, up to its tip."""
    urdf = arm(SEVEN[:4]).replace("link_", "thumb_")
    assert find_fingers(oo.Model.from_urdf_string(urdf)) == (set(), set())
    found = find_arm(oo.Model.from_urdf_string(urdf))
    assert found is not None and (found.tool, len(found.joints)) == ("thumb_3", 4)


def test_the_tool_is_found_or_given() -> None:
    model = oo.Model.from_urdf_string(arm(SEVEN, names="gripper"))
    found = find_arm(model)
    assert found is not None and (found.tool, found.joints) == ("gripper", [name for name, *_ in SEVEN])
    found = find_arm(model, "link_2")
    assert found is not None and found.joints == ["j0", "j1", "j2"]
    assert find_arm(model, "base") is None
    dual = draft("humanoid_dual_arm", tool="left_tool")
    assert dual.tool == "left_tool" and all(name.startswith("left") for name in dual.joints)
