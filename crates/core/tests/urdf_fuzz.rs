//! Checks that loading any file results in a robot or an error.

use onorbit_core::model::urdf::from_str;
use proptest::prelude::*;

const SMALL: &str = r#"<?xml version="1.0"?>
<robot name="r" xmlns:xacro="http://www.ros.org/wiki/xacro">
  <material name="m"><color rgba="1 0 0 1"/></material>
  <link name="world"/>
  <link name="a">
    <inertial><origin xyz="0 0 1" rpy="0 0 1"/><mass value="1"/>
      <inertia ixx="1" iyy="1" izz="1" ixy="0" ixz="0" iyz="0"/></inertial>
    <visual><geometry><mesh filename="package://p/x.stl"/></geometry><material name="m"/></visual>
  </link>
  <link name="b"><inertial><mass value="1"/><inertia ixx="1" iyy="1" izz="1"/></inertial></link>
  <joint name="w" type="fixed"><parent link="world"/><child link="a"/></joint>
  <joint name="j" type="revolute"><parent link="a"/><child link="b"/><axis xyz="0 0 1"/>
    <limit lower="-1" upper="1"/><dynamics damping="1"/></joint>
</robot>"#;

/// Fragments with a meaning in URDF.
const PIECES: [&str; 22] = [
    "",
    "<",
    ">",
    "/>",
    "\"",
    "'",
    "&",
    "&lt;",
    "<!--",
    "<![CDATA[",
    "]]>",
    "nan",
    "-1",
    "0",
    "1e308",
    "a",
    "world",
    "${x}",
    "<link name=\"c\"/>",
    "xacro:",
    "\u{0}",
    "é",
];

proptest! {
    #![proptest_config(ProptestConfig { cases: 2000, failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn a_mutated_robot_never_panics(
        cuts in prop::collection::vec((0..SMALL.len(), 0..12_usize, 0..PIECES.len()), 1..6)
    ) {
        let mut text = SMALL.to_owned();
        for (at, length, piece) in cuts {
            let start = (0..=at.min(text.len())).rev().find(|&i| text.is_char_boundary(i)).unwrap_or(0);
            let end = (start + length..=text.len()).find(|&i| text.is_char_boundary(i)).unwrap_or(text.len());
            text.replace_range(start..end, PIECES[piece]);
        }
        if let Err(error) = from_str(&text, None, &Default::default()) {
            prop_assert!(!error.to_string().is_empty());
        }
    }

    #[test]
    fn noise_never_panics(text in "(<|>|/|[a-z]|=|\"| |!|-|\\?|&|;|\\PC){0,200}") {
        let _ = from_str(&text, None, &Default::default());
    }
}
