//! Records faults of the parser of `urdf-rs` with careless files, which are the reason why it is given a
//! checked tree.

#![allow(clippy::unwrap_used)] // a failed unwrap is a failed test

use onorbit_core::model::urdf::from_str;

#[test]
fn urdf_rs_accepts_or_refuses_careless_files_silently() {
    const MASS: &str =
        "<inertial><mass value='1'/><inertia ixx='1' iyy='1' izz='1' ixy='0' ixz='0' iyz='0'/></inertial>";
    let robot = |joint: &str| {
        format!(
            "<robot name='r' xmlns:drake='d'><link name='a'>{MASS}</link><link name='b'>{MASS}</link>{joint}</robot>"
        )
    };
    let ends = "<parent link='a'/><child link='b'/>";
    let ours = |xml: &str| from_str(xml, None, &Default::default());

    let comma = robot(&format!("<joint name='j' type='fixed'>{ends}<origin xyz='1,0 0 0 0'/></joint>"));
    assert_eq!(*urdf_rs::read_from_string(&comma).unwrap().joints[0].origin.xyz, [0.0; 3]);
    assert!(ours(&comma).is_err());

    let foreign = robot(&format!("<drake:joint name='j' type='fixed'>{ends}</drake:joint>"));
    assert_eq!(urdf_rs::read_from_string(&foreign).unwrap().joints.len(), 1);
    assert!(ours(&foreign).is_err());

    let no_velocity = robot(&format!("<joint name='j' type='revolute'>{ends}<limit effort='1'/></joint>"));
    assert!(urdf_rs::read_from_string(&no_velocity).is_err());
    assert!(ours(&no_velocity).is_ok());

    assert_eq!(
        urdf_rs::read_from_string("<robot name='r'><link name='a'/></robot>").unwrap().links[0]
            .inertial
            .mass
            .value,
        0.0
    );
}
