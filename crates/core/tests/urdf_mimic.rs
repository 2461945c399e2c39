//! Mimic joints of URDF files.

#![allow(clippy::unwrap_used)] // a failed unwrap is a failed test

use onorbit_core::model::urdf::from_str;
use onorbit_core::model::{Closure, Constraint};

const INERTIAL: &str =
    r#"<inertial><mass value="1"/><inertia ixx="1" iyy="1" izz="1" ixy="0" ixz="0" iyz="0"/></inertial>"#;

#[test]
fn a_mimic_joint_becomes_a_constraint() {
    let joint = |name: &str, inside: &str| {
        format!(
            "<link name='{name}_link'>{INERTIAL}</link><joint name='{name}' type='continuous'>\
             <parent link='a'/><child link='{name}_link'/>{inside}</joint>"
        )
    };
    let chain = |mimic: &str| {
        let inside = format!("<link name='a'>{INERTIAL}</link>{}{}", joint("leader", ""), joint("j", mimic));
        from_str(&format!("<robot name='r'>{inside}</robot>"), None, &Default::default())
    };
    let mimic = |text: &str| {
        let model = chain(text).unwrap();
        assert!(model.warnings().is_empty());
        match model.closures() {
            [Closure { constraint: Constraint::Mimic { joint: 1, leader: 0, ratio, offset }, .. }] => {
                (*ratio, *offset)
            }
            other => panic!("{other:?}"),
        }
    };
    assert_eq!(mimic("<mimic joint='leader' multiplier='-2' offset='0.1'/>"), (-2.0, 0.1));
    assert_eq!(mimic("<mimic joint='leader'/>"), (1.0, 0.0));
    let wrong = |mimic: &str| chain(mimic).unwrap_err().to_string();
    let unknown = wrong("<mimic joint='leadr'/>");
    assert!(
        unknown.contains("joint 'j' mimics joint 'leadr', which does not exist; did you mean"),
        "{unknown}"
    );
    let circle = wrong("<mimic joint='j'/>");
    assert!(circle.contains("joint 'j' mimics itself"), "{circle}");
}
