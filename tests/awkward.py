"""Expected result for each file of ``tests/fixtures/awkward``: robots with one oddity each.

A file that Pinocchio reads loads here too, with a warning where its author may have meant something else,
or is refused for a reason of physics.
"""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

FOLDER = Path(__file__).parent / "fixtures" / "awkward"


@dataclass(frozen=True)
class Expected:
    """Expected result for a file: whether it loads, and a part of its warning or error.

    ``text`` is empty for a file that loads without a warning. ``is_physics`` is true if Pinocchio loads the
    file, but a robot in orbit cannot be simulated from it.
    """

    loads: bool
    text: str = ""
    is_physics: bool = False


LOADS = Expected(loads=True)


def warns(text: str) -> Expected:
    return Expected(loads=True, text=text)


def physics(text: str) -> Expected:
    """Returns the result for a file that is rejected, although Pinocchio loads it.

    The reasons are unknown masses, links that form no tree, and undetermined motions.
    """
    return Expected(loads=False, text=text, is_physics=True)


def malformed(text: str) -> Expected:
    """Returns the result for a file that both this package and Pinocchio reject."""
    return Expected(loads=False, text=text)


EXPECTED = {
    "ampersand_in_name": LOADS,
    "armature": LOADS,
    "attributes_without_space": LOADS,
    "axis_missing": LOADS,
    "axis_nearly_principal": LOADS,
    "axis_not_normalised": LOADS,
    "axis_of_fixed_joint_zero": LOADS,
    "axis_without_xyz": LOADS,
    "axis_zero": physics("joint 'shoulder' has an axis of length zero"),
    "ball_joint": warns("joint 'shoulder' is a ball joint"),
    "body_alone": LOADS,
    "branch_on_fixed_link": LOADS,
    "capsule": LOADS,
    "cdata": LOADS,
    "chain_of_fixed_joints": LOADS,
    "closed_loop": malformed("the links 'base', 'arm' form a closed loop"),
    "color_of_255": LOADS,
    "comma_in_vector": malformed('xyz="0, 0.1, 0.5" of <origin>'),
    "comment_between": LOADS,
    "continuous_with_position_limit": LOADS,
    "continuous_without_limit": LOADS,
    "control_character_in_comment": LOADS,
    "crlf": LOADS,
    "cut_short": malformed("not XML"),
    "damping_negative": physics("damping is -0.5"),
    "dashes_in_comment": LOADS,
    "declaration_other_encoding": LOADS,
    "declaration_twice": LOADS,
    "default_namespace": LOADS,
    "default_namespace_of_xacro": LOADS,
    "doctype": LOADS,
    "doctype_with_entity": LOADS,
    "drake_extension": warns("<drake:collision_filter_group> has a prefix that URDF does not define"),
    "duplicate_joint": malformed("the joint name 'shoulder' is used twice"),
    "duplicate_link": malformed("the link name 'arm' is used twice"),
    "duplicate_material": LOADS,
    "dynamics_empty": LOADS,
    "dynamics_with_foreign_attributes": LOADS,
    "effort_and_velocity_negative": warns("velocity limit is negative"),
    "effort_and_velocity_zero": LOADS,
    "empty_geometry": warns("a visual shape is skipped: "),
    "empty_link_between": LOADS,
    "empty_visual": warns("link 'base' has no <geometry>"),
    "entities": LOADS,
    "floating_by_six_joints": physics("remove the joints 'virtual_joint_1', 'virtual_joint_2'"),
    "floating_joint_below_massless_root": LOADS,
    "floating_joint_between_bodies": warns("joint 'shoulder' is floating"),
    "foreign_elements_in_link": LOADS,
    "gazebo_plugin": LOADS,
    "gbk_comment": warns("UTF-8"),
    "heavy_on_light": LOADS,
    "huge_limits": LOADS,
    "inertia_all_rounding": warns("the principal moments of inertia of link 'pin' are"),
    "inertia_breaking_triangle": warns("the inertia of link 'arm' violates the triangle inequality"),
    "inertia_indefinite": physics("the inertia of link 'arm' is indefinite"),
    "inertia_indefinite_part": warns("the inertia of link 'part' is not positive definite"),
    "inertia_infinite": physics('izz="inf" of <inertia>'),
    "inertia_negative_by_rounding": LOADS,
    "inertia_without_mass_at_root": warns("link 'base' has no mass but a rotational inertia"),
    "inertia_without_mass_below_body": warns("link 'world' has no mass but a rotational inertia"),
    "inertia_without_mass_moving": warns("link 'arm' has no mass but a rotational inertia"),
    "inertia_without_mass_on_fixed_joint": warns("link 'rotor' has no mass but a rotational inertia"),
    "inertia_without_products": warns("ixy"),
    "inertial_empty": warns("link 'tool' has no <mass>"),
    "inertial_offset_far": LOADS,
    "inertial_out_of_order": LOADS,
    "inertial_with_density": warns("link 'tool' has no <mass>"),
    "infinite_limits": LOADS,
    "joint_before_links": LOADS,
    "joint_type_in_capitals": malformed("write it in lower case"),
    "joint_without_child": malformed("joint 'shoulder' has no <child>"),
    "joint_without_type": malformed("no attribute 'type'"),
    "latin1_comment": warns("UTF-8"),
    "latin1_name": warns("UTF-8"),
    "limit_without_lower": LOADS,
    "limit_without_velocity": LOADS,
    "link_without_name": malformed("no attribute 'name'"),
    "loop_beside_the_tree": physics("the links 'left', 'right' form a closed loop"),
    "loop_joint": LOADS,
    "lower_above_upper": warns("the lower limit 0 is above the upper limit -1"),
    "lower_equal_to_upper": LOADS,
    "mass_not_a_number": physics('value="nan" of <mass>'),
    "mass_with_comma": physics('value="3,0" of <mass>'),
    "mass_with_unit": physics('value="3 kg" of <mass>'),
    "mass_without_inertia": warns("link 'payload' has a mass but no <inertia>"),
    "massless_between_parallel_axes": physics("nothing resists the motion of joint 'shoulder'"),
    "massless_moving_tip": physics("nothing resists the motion of joint 'wrist'"),
    "massless_root_chain": LOADS,
    "massless_root_fixed_child": LOADS,
    "massless_root_moving_children": LOADS,
    "massless_root_one_moving_child": physics("remove both it and the joint 'rail'; the robot floats"),
    "massless_root_with_frame": LOADS,
    "massless_root_with_visual": LOADS,
    "massless_root_zero_inertial": LOADS,
    "material_defined_later": LOADS,
    "material_empty_name": LOADS,
    "material_in_other_visual": LOADS,
    "material_nowhere": LOADS,
    "material_without_name": LOADS,
    "mesh_missing": warns("package 'arm_description'"),
    "mesh_scale_negative": warns("1 mesh file was not found"),
    "mesh_scale_single": warns('scale="0.001" of <mesh>'),
    "mesh_with_backslashes": warns("base.STL"),
    "mimic": LOADS,
    "mimic_of_nothing": physics("mimics joint 'elbow'"),
    "moveit_groups": LOADS,
    "mujoco_compiler": LOADS,
    "name_of_link_and_joint": LOADS,
    "name_with_spaces": LOADS,
    "names_are_numbers": LOADS,
    "names_with_slashes": LOADS,
    "names_with_unicode": LOADS,
    "namespace_of_one_link": LOADS,
    "negative_mass": physics("link 'arm' has a mass of -3 kg"),
    "newline_before_declaration": LOADS,
    "no_declaration": LOADS,
    "no_inertial_tip": LOADS,
    "no_links": malformed("the robot has no links"),
    "no_mass_at_all": physics("the robot has no mass"),
    "nul_at_end": LOADS,
    "numbers_with_many_digits": LOADS,
    "numbers_with_plus_and_exponent": LOADS,
    "onshape_exporter": LOADS,
    "origin_missing": LOADS,
    "origin_repeated": LOADS,
    "origin_without_attributes": LOADS,
    "planar_joint": warns("joint 'shoulder' is planar"),
    "planar_joint_with_taken_name": warns("joint 'slide' is planar"),
    "planar_joint_without_axis": warns("joint 'shoulder' is planar"),
    "plane_collision": LOADS,
    "plugin_nested_deep": LOADS,
    "point_mass_off_axis": LOADS,
    "point_mass_on_axis": physics("nothing resists the motion of joint 'shoulder'"),
    "prefixed_link": malformed("<drake:link> is ignored because URDF does not define its prefix"),
    "quaternion_beside_rpy": warns("quat_xyzw"),
    "quaternion_in_version_1_0": warns("quat_xyzw"),
    "quaternion_origin": LOADS,
    "repeated_inertial": LOADS,
    "revolute_without_limit": LOADS,
    "robot_name_empty": LOADS,
    "robot_without_name": LOADS,
    "ros2_control": LOADS,
    "rpy_many_turns": LOADS,
    "safety_controller": LOADS,
    "safety_controller_bare": LOADS,
    "screw_joint": malformed("use a prismatic and a revolute joint on one axis"),
    "sdf": malformed("looks like SDFormat"),
    "second_root_element": warns("<robot>"),
    "self_parent": malformed("link 'arm' is the child of two joints"),
    "sensor": LOADS,
    "sibling_order": LOADS,
    "single_quotes": LOADS,
    "spaces_around_numbers": LOADS,
    "sphere_of_zero": warns("radius of <sphere> is 0"),
    "stylesheet": LOADS,
    "tabs_and_newlines_in_vector": LOADS,
    "tag_mismatch": malformed("not XML"),
    "text_before_root": LOADS,
    "text_between": LOADS,
    "tiny_mass": LOADS,
    "transmission": LOADS,
    "two_fixed_children_of_massless_root": LOADS,
    "two_joints_between_two_links": physics("is the child of two joints, 'shoulder' and 'spare'"),
    "two_parents": physics("is the child of two joints, 'wrist' and 'strut'"),
    "two_roots": malformed("2 links are not the child of any joint: 'base', 'tip'"),
    "two_visuals": LOADS,
    "undeclared_prefix": warns("<sensor:camera>"),
    "unknown_elements": warns("<author> is not an element of URDF"),
    "unknown_link": malformed("there is no link 'armm'; did you mean 'arm'?"),
    "utf16": malformed("not UTF-8 text"),
    "utf8_bom": LOADS,
    "vector_of_two": malformed('xyz="0 0.1" of <origin>'),
    "version_attribute": LOADS,
    "version_unknown": LOADS,
    "xacro_arithmetic": LOADS,
    "xacro_conditional": LOADS,
    "xacro_leftover_in_expanded_file": warns("<xacro:property> is an xacro tag"),
    "xacro_leftover_in_names": warns("${prefix}base"),
    "xacro_leftover_in_plugin": warns("'$(find arm_description)/base.stl'"),
    "xacro_macro_with_block": LOADS,
    "xacro_not_expanded": physics("'${m * 2}' (link 'base') is xacro"),
    "xacro_old_namespace": LOADS,
    "xacro_simulator_include": warns("only simulators need it"),
    "zero_mass_tip": LOADS,
    "zero_outside_limits": LOADS,
}


def path(name: str) -> Path:
    (file,) = FOLDER.glob(f"{name}.*")
    return file
