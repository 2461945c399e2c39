//! Checks the values that are read from a URDF, and the defaults of values that are omitted.

#![allow(clippy::unwrap_used)] // a failed unwrap is a failed test

use onorbit_core::dynamics::{Data, frame_pose, positions};
use onorbit_core::model::urdf::from_str;
use onorbit_core::model::{Geometry, Limits, Model, neutral};
use std::f64::consts::{FRAC_1_SQRT_2, FRAC_PI_2};

const INERTIAL: &str =
    r#"<inertial><mass value="1"/><inertia ixx="1" iyy="1" izz="1" ixy="0" ixz="0" iyz="0"/></inertial>"#;

fn load(inside: &str) -> Model {
    from_str(&format!("<robot name='r' version='1.1'>{inside}</robot>"), None, &Default::default()).unwrap()
}

fn pair(kind: &str, inside: &str) -> Model {
    load(&format!(
        "<link name='a'>{INERTIAL}</link><link name='b'>{INERTIAL}</link>\
         <joint name='j' type='{kind}'><child link='b'/><parent link='a'/>{inside}</joint>"
    ))
}

fn position(model: &Model, frame: &str) -> [f64; 3] {
    let (mut data, q) = (Data::new(model), neutral(model));
    positions(model, &mut data, &q);
    let p = frame_pose(model, &data, &q, model.frame(frame).unwrap()).pos_w;
    [p.x, p.y, p.z]
}

#[test]
fn a_joint_without_details_has_the_defaults_of_urdf() {
    let model = pair("revolute", "");
    let joint = &model.joints()[0];
    assert_eq!([joint.axis.x, joint.axis.y, joint.axis.z], [1.0, 0.0, 0.0]);
    assert_eq!((joint.damping, joint.friction, joint.limits), (0.0, 0.0, Limits::default()));
    assert_eq!(position(&model, "b"), [0.0; 3]);
}

#[test]
fn friction_rotor_and_limits_are_kept() {
    let dynamics = "<dynamics damping='0.5' friction='0.2' armature='0.03'/>";
    let model =
        pair("prismatic", &format!("{dynamics}<limit lower='-1' upper='2' velocity='3' effort='4'/>"));
    let joint = &model.joints()[0];
    assert_eq!((joint.damping, joint.friction, model.nodes()[1].rotor_inertia), (0.5, 0.2, 0.03));
    let limits = Limits { position: Some((-1.0, 2.0)), velocity: Some(3.0), effort: Some(4.0) };
    assert_eq!(joint.limits, limits);
    let same = pair("revolute", "<dynamics rotor_inertia='0.03'/>");
    assert_eq!(same.nodes()[1].rotor_inertia, 0.03);
}

#[test]
fn omitted_limits_are_unlimited() {
    let position = |kind, limit: &str| pair(kind, limit).joints()[0].limits.position;
    assert_eq!(position("continuous", "<limit lower='-1' upper='1' effort='1'/>"), None);
    assert_eq!(position("revolute", "<limit effort='1' velocity='1'/>"), None);
    assert_eq!(position("revolute", "<limit upper='1'/>"), Some((0.0, 1.0)));
    assert_eq!(position("revolute", "<limit lower='-inf' upper='inf'/>"), None);
    assert_eq!(pair("revolute", "<limit effort='inf'/>").joints()[0].limits.effort, None);
    let gazebo = pair("revolute", "<limit effort='-1' velocity='-1.0'/>");
    assert_eq!(gazebo.joints()[0].limits, Limits::default());
    assert!(gazebo.warnings()[0].to_string().contains("velocity limit is negative"));
}

#[test]
fn poses_by_angles_and_by_quaternion_agree() {
    let angles = pair("revolute", "<origin xyz='1 2 3' rpy='0 0 1.5707963267948966'/><axis xyz='1 0 0'/>");
    let quaternion = format!("<origin xyz='1 2 3' quat_xyzw='0 0 {FRAC_1_SQRT_2} {FRAC_1_SQRT_2}'/>");
    let quaternion = pair("revolute", &format!("{quaternion}<axis xyz='1 0 0'/>"));
    let (a, b) = (angles.nodes()[1].rot_pk.to_nalgebra(), quaternion.nodes()[1].rot_pk.to_nalgebra());
    assert!((a - b).norm() < 1e-15);
    assert!((a.column(2) - nalgebra::Vector3::y()).norm() < 1e-15); // x rotated by 90 degrees about z
    assert_eq!(position(&angles, "b"), [1.0, 2.0, 3.0]);
}

#[test]
fn a_rotated_inertial_is_converted_to_link_axes() {
    let model = load(&format!(
        "<link name='a'><inertial><origin xyz='1 0 0' rpy='0 0 {FRAC_PI_2}'/><mass value='2'/>\
         <inertia ixx='2' iyy='3' izz='4' ixy='0.5' ixz='0' iyz='0'/></inertial></link>"
    ));
    let base = &model.nodes()[0];
    let i = base.about_com;
    assert_eq!((base.mass, base.com.x), (2.0, 1.0));
    for (got, want) in [(i.xx, 3.0), (i.yy, 2.0), (i.zz, 4.0), (i.xy, -0.5)] {
        assert!((got - want).abs() < 1e-15);
    }
}

#[test]
fn a_mass_without_inertia_is_a_point_mass_with_a_warning() {
    let point = "<inertial><origin xyz='0 0 1'/><mass value='1'/></inertial>";
    let model = load(&format!(
        "<link name='a'>{INERTIAL}</link><link name='p'>{point}</link>\
         <joint name='j' type='revolute'><parent link='a'/><child link='p'/></joint>"
    ));
    assert!(model.warnings()[0].to_string().contains("link 'p' has a mass but no <inertia>"));
}

#[test]
fn a_massless_root_is_the_base_frame_of_what_is_fixed_to_it() {
    let model = |kind: &str| {
        load(&format!(
            "<link name='world'/><link name='base'>{INERTIAL}</link><link name='tool'/>\
             <joint name='w' type='{kind}'><parent link='world'/><child link='base'/><origin xyz='0 0 1'/></joint>\
             <joint name='t' type='fixed'><parent link='base'/><child link='tool'/><origin xyz='1 0 0'/></joint>"
        ))
    };
    let fixed = model("fixed");
    assert_eq!(fixed.body_names().collect::<Vec<_>>(), ["world"]);
    assert_eq!(fixed.frame_names().collect::<Vec<_>>(), ["world", "base", "tool"]);
    assert_eq!(position(&fixed, "tool"), [1.0, 0.0, 1.0]);
    // the base is floating: the child of a floating joint becomes the base
    let floating = model("floating");
    assert_eq!(floating.body_names().collect::<Vec<_>>(), ["base"]);
    assert_eq!(floating.frame_names().collect::<Vec<_>>(), ["base", "tool"]);
    assert_eq!(position(&floating, "tool"), [1.0, 0.0, 0.0]);
}

#[test]
fn colours_are_found_by_name_and_unreadable_shapes_give_a_warning() {
    let visual = |geometry: &str, material: &str| {
        format!("<visual><geometry>{geometry}</geometry><material {material}</visual>")
    };
    let model = load(&format!(
        "<material name='red'><color rgba='1 0 0 1'/></material><link name='a'>{INERTIAL}{}{}{}{}{}{}{}\
         <collision><geometry><cylinder radius='${{r}}'/></geometry></collision>\
         <collision><geometry><mesh filename='package://x/b.stl'/></geometry></collision>\
         <collision><origin xyz='1 2 3'/><geometry><sphere radius='2'/></geometry><material name='red'/></collision></link>",
        visual("<box size='1 2 3'/>", "name='red'/>"),
        visual("<capsule radius='1' length='2'/>", "name='red'><color rgba='0 1 0 0.5'/></material>"),
        visual("<mesh filename='package://x/a.stl' scale='1 1 2'/>", "name='unknown'/>"),
        visual("<sphere radius='${r}'/>", "name='red'/>"),
        visual("<cylinder radius='1'/>", "name='red'/>"),
        visual("<sphere radius='-1'/>", "name='red'/>"),
        visual("<box size='1 0 1'/>", "name='red'/>"),
    ));
    let shapes: Vec<_> = model.visuals().iter().map(|(_, visual)| visual.clone()).collect();
    assert_eq!(shapes.len(), 3);
    assert_eq!(
        (&shapes[0].geometry, shapes[0].rgba),
        (&Geometry::Box([1.0, 2.0, 3.0]), Some([1.0, 0.0, 0.0, 1.0]))
    );
    assert_eq!(shapes[1].geometry, Geometry::Capsule { radius: 1.0, length: 2.0 });
    assert_eq!(shapes[1].rgba, Some([0.0, 1.0, 0.0, 0.5]));
    let mesh = Geometry::Mesh { filename: "package://x/a.stl".to_owned(), scale: [1.0, 1.0, 2.0] };
    assert_eq!((&shapes[2].geometry, shapes[2].rgba), (&mesh, None));
    let [(0, solid)] = model.collisions() else { panic!("one of the three is a shape that is no mesh") };
    assert_eq!((&solid.geometry, solid.pose.translation.z), (&Geometry::Sphere { radius: 2.0 }, 3.0));
    assert_eq!(solid.rgba, Some([1.0, 0.0, 0.0, 1.0]));
    let texts: Vec<String> = model.warnings().iter().map(ToString::to_string).collect();
    assert!(!texts.iter().any(|text| text.contains("b.stl")), "{texts:?}");
    assert_eq!(
        texts
            .iter()
            .filter(|t| t.starts_with("a visual shape is skipped: ") && t.contains("link 'a'"))
            .count(),
        4,
        "{texts:?}"
    );
}

#[test]
fn joints_may_come_before_links_and_keep_their_order() {
    let link = |name| format!("<link name='{name}'>{INERTIAL}</link>");
    let joint = |name, parent, child| {
        format!(
            "<joint name='{name}' type='continuous'><parent link='{parent}'/><child link='{child}'/></joint>"
        )
    };
    let model = load(&format!(
        "{}{}{}{}{}{}{}",
        joint("wrist", "arm", "hand"),
        joint("left", "body", "arm"),
        joint("right", "body", "leg"),
        link("hand"),
        link("leg"),
        link("arm"),
        link("body"),
    ));
    assert_eq!(model.joint_names().collect::<Vec<_>>(), ["left", "wrist", "right"]);
    assert_eq!(model.body_names().collect::<Vec<_>>(), ["body", "arm", "hand", "leg"]);
}

/// Returns the pose of `b` for joint positions, by the engine.
fn pose(model: &Model, joints: &[f64]) -> nalgebra::Isometry3<f64> {
    let (mut data, mut q) = (Data::new(model), neutral(model));
    q[7..].copy_from_slice(joints);
    positions(model, &mut data, &q);
    let pose = frame_pose(model, &data, &q, model.frame("b").unwrap());
    let rotation = nalgebra::Rotation3::from_matrix_unchecked(pose.rot_wf.to_nalgebra());
    nalgebra::Isometry3::from_parts(pose.pos_w.to_nalgebra().into(), rotation.into())
}

#[test]
fn a_ball_joint_is_yaw_pitch_and_roll() {
    for kind in ["ball", "spherical"] {
        let model = pair(kind, "<origin xyz='1 2 3'/><limit effort='1'/>");
        assert_eq!(model.joint_names().collect::<Vec<_>>(), ["j_yaw", "j_pitch", "j_roll"]);
        assert_eq!(model.body_names().collect::<Vec<_>>(), ["a", "j_yaw", "j_pitch", "b"]);
        let (roll, pitch, yaw) = (0.3, -0.7, 1.1);
        let want = nalgebra::Isometry3::from_parts(
            nalgebra::Translation3::new(1.0, 2.0, 3.0),
            nalgebra::UnitQuaternion::from_euler_angles(roll, pitch, yaw),
        );
        let off = (pose(&model, &[yaw, pitch, roll]).inverse() * want).to_homogeneous()
            - nalgebra::Matrix4::identity();
        assert!(off.norm() < 1e-14, "{off}");
        let text = model.warnings()[0].to_string();
        assert!(text.contains("'j' is a ball joint") && text.contains("<limit> is ignored"), "{text}");
    }
}

#[test]
fn a_floating_joint_is_three_prismatic_joints_and_a_ball_joint() {
    let model = pair("floating", "<origin xyz='1 2 3'/>");
    let names = ["j_x", "j_y", "j_z", "j_yaw", "j_pitch", "j_roll"];
    assert_eq!(model.joint_names().collect::<Vec<_>>(), names);
    let (roll, pitch, yaw) = (0.3, -0.7, 1.1);
    let want = nalgebra::Isometry3::from_parts(
        nalgebra::Translation3::new(1.5, 1.0, 5.0),
        nalgebra::UnitQuaternion::from_euler_angles(roll, pitch, yaw),
    );
    let got = pose(&model, &[0.5, -1.0, 2.0, yaw, pitch, roll]);
    let off = (got.inverse() * want).to_homogeneous() - nalgebra::Matrix4::identity();
    assert!(off.norm() < 1e-14, "{off}");
    assert!(notes(&model)[0].contains("'j' is floating"), "{:?}", notes(&model));
}

#[test]
fn generated_names_are_unique() {
    let model = load(&format!(
        "<link name='j_x'>{INERTIAL}</link><link name='b'>{INERTIAL}</link><link name='j_x_2'/>\
         <joint name='j' type='planar'><parent link='j_x'/><child link='b'/></joint>\
         <joint name='j_yaw' type='fixed'><parent link='b'/><child link='j_x_2'/></joint>"
    ));
    assert_eq!(model.joint_names().collect::<Vec<_>>(), ["j_x_3", "j_y", "j_yaw_2"]);
}

#[test]
fn incomplete_inertials_give_a_warning() {
    let with = |inertial: &str| {
        load(&format!(
            "<link name='a'>{INERTIAL}</link><link name='b'>{inertial}</link>\
             <joint name='j' type='fixed'><parent link='a'/><child link='b'/></joint>"
        ))
    };
    let none = with("<inertial><origin xyz='1 0 0'/><inertia ixx='1' iyy='1' izz='1'/></inertial>");
    assert_eq!((none.mass(), moments(&none, 0)), (1.0, [1.0; 3]));
    assert!(notes(&none)[0].contains("link 'b' has no <mass>"), "{:?}", notes(&none));
    let no_products =
        with("<inertial><mass value='1'/><inertia ixx='1' iyy='1' izz='1' ixz='0'/></inertial>");
    let warnings =
        ["the <inertia> of link 'b' has no ixy, iyz, which are read as 0; add them unless 0 is meant"];
    assert_eq!(
        (notes(&no_products), moments(&no_products, 0)),
        (warnings.map(str::to_owned).to_vec(), [2.0; 3])
    );
}

#[test]
fn quaternions_need_version_1_1() {
    let robot = |version: &str| {
        let xml = format!(
            "<robot {version}>\n<link name='a'>{INERTIAL}</link><link name='b'/>\n<joint name='j' type='fixed'>\
             <parent link='a'/><child link='b'/><origin quat_xyzw='0 0 1 0'/></joint></robot>"
        );
        let model = from_str(&xml, None, &Default::default()).unwrap();
        (notes(&model), model.frames()[1].rot_kf.to_nalgebra()[(0, 0)])
    };
    for version in ["version='1.1'", "version='1.2'"] {
        assert_eq!(robot(version), (vec![], -1.0), "{version}");
    }
    for version in ["", "version='1.0'"] {
        let (warnings, cosine) = robot(version);
        assert!(warnings[0].starts_with("line 3: quat_xyzw is ignored in URDF version 1.0"), "{warnings:?}");
        assert_eq!(cosine, 1.0);
    }
}

#[test]
fn extensions_are_recognized_by_prefix_not_by_namespace() {
    let link = |name, more: &str| format!("<link {more} name='{name}'>{INERTIAL}</link>");
    let joint = "<joint name='j' type='fixed'><parent link='a'/><child link='b'/></joint>";
    let both = format!(
        "<p:x xmlns:p='u' xmlns:q='u' p:a='1' q:a='2'/>{}{}{joint}",
        link("a", ""),
        link("b", "xmlns='u'")
    );
    let model = load(&both);
    assert_eq!(model.mass(), 2.0);
    assert!(notes(&model)[0].contains(": <p:x> has a prefix that URDF"), "{:?}", notes(&model));
    assert_eq!(notes(&model).len(), 1);
}

#[test]
fn a_planar_joint_moves_in_its_plane_and_about_its_normal() {
    let model = pair("planar", "<origin xyz='0 0 1'/><axis xyz='0 0 2'/>");
    assert_eq!(model.joint_names().collect::<Vec<_>>(), ["j_x", "j_y", "j_yaw"]);
    let got = pose(&model, &[0.4, -0.2, FRAC_PI_2]);
    assert!((got.translation.vector - nalgebra::Vector3::new(0.4, -0.2, 1.0)).norm() < 1e-15);
    assert!((got * nalgebra::Vector3::x() - nalgebra::Vector3::y()).norm() < 1e-15);
    // for any normal the motion stays in the plane
    let skew = pair("planar", "<axis xyz='1 -2 0.5'/>");
    let normal = nalgebra::Vector3::new(1.0, -2.0, 0.5).normalize();
    assert!(pose(&skew, &[0.4, -0.2, 1.0]).translation.vector.dot(&normal).abs() < 1e-15);
    assert!(skew.warnings()[0].to_string().contains("'j' is planar"));
}

fn notes(model: &Model) -> Vec<String> {
    model.warnings().iter().map(ToString::to_string).collect()
}

fn moments(model: &Model, body: usize) -> [f64; 3] {
    let inertia = model.nodes()[body].about_com.to_nalgebra();
    [inertia[(0, 0)], inertia[(1, 1)], inertia[(2, 2)]]
}

#[test]
fn an_inertia_negative_by_rounding_is_zero() {
    let tiny = r#"<inertial><mass value="0.5"/><inertia ixx="-5e-20" iyy="1e-20" izz="0"/></inertial>"#;
    let model = load(&format!(
        "<link name='a'>{INERTIAL}</link><link name='b'>{tiny}</link>\
         <joint name='j' type='revolute'><child link='b'/><parent link='a'/></joint>\
         <link name='c'>{INERTIAL}</link>\
         <joint name='k' type='fixed'><child link='c'/><parent link='b'/></joint>"
    ));
    assert_eq!(model.mass(), 2.5);
    assert!(
        notes(&model)[0].contains("principal moments of inertia of link 'b' are [-5e-20"),
        "{:?}",
        notes(&model)
    );
    assert_eq!(moments(&model, 1), [1.0, 1.0 + 1e-20, 1.0]);
    // 1e-6 of 0.5 kg m2 is not rounding: a radius of gyration of a millimetre
    let wrong = tiny.replace("-5e-20", "-5e-7");
    let refused =
        from_str(&format!("<robot><link name='a'>{wrong}</link></robot>"), None, &Default::default())
            .unwrap_err();
    assert!(refused.to_string().contains("indefinite"), "{refused}");
}

#[test]
fn an_inertia_without_mass_adds_to_the_body_it_is_fixed_to() {
    let rotor = r#"<inertial><origin xyz="5 0 0"/><mass value="0"/>
        <inertia ixx="2" iyy="3" izz="4" ixy="0" ixz="0" iyz="0"/></inertial>"#;
    let link = |name, inertial| format!("<link name='{name}'>{inertial}</link>");
    let fixed = |parent, child| {
        format!(
            "<joint name='{parent}_{child}' type='fixed'><origin xyz='0 1 0' rpy='0 0 {FRAC_PI_2}'/><parent link='{parent}'/><child link='{child}'/></joint>"
        )
    };
    let model = load(&[link("a", INERTIAL), link("b", rotor), fixed("a", "b")].concat());
    // rotated by 90° about z, in any position
    let found = moments(&model, 0);
    for (found, expected) in found.into_iter().zip([4.0, 3.0, 5.0]) {
        assert!((found - expected).abs() < 1e-14, "{found} {expected}");
    }
    assert_eq!(model.mass(), 1.0);
    assert!(notes(&model)[0].contains("link 'b' has no mass but a rotational inertia, which is added"));
    // below a root without mass, and before any body with mass
    let below =
        [link("world", ""), link("b", rotor), link("a", INERTIAL), fixed("world", "b"), fixed("b", "a")];
    let model = load(&below.concat());
    assert_eq!(model.body_frame(0).name, "world");
    assert!((moments(&model, 0)[0] - 4.0).abs() < 1e-14 && model.mass() == 1.0); // 'b' is rotated by 90°, 'a' by 180°
}

#[test]
fn leftover_xacro_is_ignored_with_a_warning() {
    let model = load(&format!(
        "\n<xacro:property name='p' value='1'/>\n<link name='a'>{INERTIAL}</link>\n\
         <xacro:macro name='m'><xacro:arm/><link name='${{x}}'/></xacro:macro>"
    ));
    assert_eq!(model.mass(), 1.0);
    let said = notes(&model);
    assert_eq!(said.len(), 1, "{said:?}");
    assert!(
        said[0].starts_with("line 2: <xacro:property> is an xacro tag and is ignored, as is one more"),
        "{said:?}"
    );
}

#[test]
fn elements_that_are_not_urdf_are_ignored_and_named() {
    let inside = "<gazebo:x/><drake:joint name='j'/><Link name='b'/><gazebo><b/></gazebo><transmission/><ros2_control/>";
    let model = load(&format!("<link name='a'>{INERTIAL}</link>\n{inside}"));
    let said = notes(&model);
    assert_eq!(said.len(), 2, "{said:?}");
    assert!(said[0].contains(": <gazebo:x> has a prefix that URDF"), "{said:?}");
    assert!(
        said[0].ends_with("ignored (also: '<drake:joint>'); remove the prefix if it describes the robot"),
        "{said:?}"
    );
    assert!(
        said[1].contains(": <Link> is not an element of URDF and is ignored; correct its name"),
        "{said:?}"
    );
}
