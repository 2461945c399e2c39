//! Checks that every URDF that cannot be loaded has a specific error, with line and name.

#![allow(clippy::unwrap_used)] // a failed unwrap is a failed test

use onorbit_core::model::ModelError;
use onorbit_core::model::urdf::{UrdfError, UrdfProblem, from_file, from_str};
use std::fs;
use std::path::{Path, PathBuf};

const INERTIAL: &str =
    r#"<inertial><mass value="1"/><inertia ixx="1" iyy="1" izz="1" ixy="0" ixz="0" iyz="0"/></inertial>"#;

fn error(xml: &str) -> UrdfError {
    from_str(xml, None, &Default::default()).expect_err("must be refused")
}

fn problem(xml: &str) -> UrdfProblem {
    *error(xml).problem
}

/// Returns links `a`, `b`, `c` with mass and the given joints.
fn robot(joints: &str) -> String {
    let link = |name| format!("<link name='{name}'>{INERTIAL}</link>\n");
    format!("<robot name='r'>\n{}{}{}{joints}\n</robot>", link("a"), link("b"), link("c"))
}

fn joint(name: &str, kind: &str, parent: &str, child: &str, inside: &str) -> String {
    format!(
        "<joint name='{name}' type='{kind}'><parent link='{parent}'/><child link='{child}'/>{inside}</joint>\n"
    )
}

/// Returns two links; the second has this inertial.
fn with_inertial(inertial: &str) -> String {
    let j = joint("j", "revolute", "a", "b", "");
    format!("<robot name='r'><link name='a'>{INERTIAL}</link><link name='b'>{inertial}</link>{j}</robot>")
}

#[test]
fn text_that_is_not_xml_is_refused() {
    assert_eq!(problem(""), UrdfProblem::Empty);
    assert_eq!(problem(" \n\t"), UrdfProblem::Empty);
    for text in [
        "monkeys, not XML",
        "<robot",
        "<robot><link></robot>",
        "<robot><link></robot></link>",
        "<a b='1' b='2'/>",
        "\0\u{1}",
    ] {
        assert!(matches!(problem(text), UrdfProblem::NotXml { .. }), "{text}: {}", error(text));
    }
    let entity = "<!DOCTYPE robot [<!ENTITY a 'b'>]>\n<robot name='&a;'/>";
    assert_eq!(problem(entity), UrdfProblem::Entity { name: "a".into() });
    assert_eq!(error(entity).line, Some(2));
    let text = error("<sdf version='1.7'/>").to_string();
    assert!(text.contains("<sdf>") && text.contains("SDFormat"), "{text}");
    assert_eq!(problem("<robot name='r'/>"), UrdfProblem::NoLinks);
}

#[test]
fn deep_and_huge_xml_is_refused_before_any_recursion() {
    let deep = format!("<robot>{}{}</robot>", "<gazebo>".repeat(100_000), "</gazebo>".repeat(100_000));
    assert!(matches!(problem(&deep), UrdfProblem::TooDeep { .. }));
    assert!(matches!(problem(&"<a>".repeat(1_000_000)), UrdfProblem::TooDeep { .. }));
    let huge = format!("<robot><!--{}--></robot>", " ".repeat(64 << 20));
    assert!(matches!(problem(&huge), UrdfProblem::TooLarge { .. }));
    let crowded = format!("<robot name='r'>{}</robot>", "<a/>".repeat(2_000_000));
    assert!(matches!(problem(&crowded), UrdfProblem::NotXml { .. }), "{}", error(&crowded));
    let attributes: String = (0..20_000).map(|i| format!(" a{i}=''")).collect();
    assert!(matches!(problem(&format!("<robot{attributes}/>")), UrdfProblem::TooManyAttributes { .. }));
}

#[test]
fn many_links_are_read_in_linear_time() {
    let mut xml = format!("<robot name='rope'><link name='l0'>{INERTIAL}</link>");
    for i in 1..=2000 {
        let j = joint(&format!("j{i}"), "revolute", &format!("l{}", i - 1), &format!("l{i}"), "");
        xml += &format!("<link name='l{i}'>{INERTIAL}</link>{j}");
    }
    let start = std::time::Instant::now();
    assert_eq!(from_str(&(xml + "</robot>"), None, &Default::default()).unwrap().joint_count(), 2000); // the largest number of joints
    assert!(start.elapsed().as_secs() < 8, "a dense elimination would take minutes");
}

#[test]
fn unreadable_files_are_refused() {
    let folder = std::env::temp_dir().join(format!("onorbit_urdf_{}", std::process::id()));
    fs::create_dir_all(&folder).unwrap();
    let load = |path: &Path| from_file(path, &Default::default()).expect_err("must be refused");
    let write = |name: &str, bytes: &[u8]| -> PathBuf {
        fs::write(folder.join(name), bytes).unwrap();
        folder.join(name)
    };
    assert_eq!(*load(&folder.join("none.urdf")).problem, UrdfProblem::NotFound);
    assert_eq!(*load(&folder).problem, UrdfProblem::IsFolder);
    assert_eq!(*load(&write("empty.urdf", b"")).problem, UrdfProblem::Empty);
    assert_eq!(*load(&write("latin.urdf", b"<robot name='\xe9'/>")).problem, UrdfProblem::NoLinks);
    let wide = b"\xff\xfe<\0r\0o\0b\0o\0t\0/\0>\0";
    assert_eq!(*load(&write("wide.urdf", wide)).problem, UrdfProblem::NotUtf8 { at: 0 });
    assert!(matches!(*load(&write("zeros.urdf", &[0; 64])).problem, UrdfProblem::NotXml { .. }));
    let path = write("broken.urdf", b"<robot>\n<link></robot>");
    let broken = load(&path);
    assert_eq!((broken.file.as_deref(), broken.line), (Some(path.as_path()), Some(2)));
    assert!(
        broken.to_string().starts_with(&format!("{}:2: the text is not XML", path.display())),
        "{broken}"
    );
    fs::remove_dir_all(folder).unwrap();
}

#[test]
fn robots_that_are_not_a_tree_are_refused() {
    let (ab, bc) = (joint("ab", "fixed", "a", "b", ""), joint("bc", "fixed", "b", "c", ""));
    let is_loop = |joints: &str, links: &[&str]| {
        let links = links.iter().map(|l| (*l).to_owned()).collect();
        assert_eq!(problem(&robot(joints)), UrdfProblem::Loop { links }, "{joints}");
    };
    is_loop(&format!("{ab}{bc}{}", joint("ca", "fixed", "c", "a", "")), &["a", "b", "c"]);
    is_loop(&format!("{bc}{}", joint("cb", "fixed", "c", "b", "")), &["b", "c"]);
    is_loop(&format!("{ab}{}", joint("cc", "fixed", "c", "c", "")), &["c"]);
    let two = problem(&robot(&format!("{ab}{bc}{}", joint("ac", "fixed", "a", "c", ""))));
    assert_eq!(two, UrdfProblem::TwoParents { link: "c".into(), joints: ["bc".into(), "ac".into()] });
    assert_eq!(problem(&robot(&ab)), UrdfProblem::ManyRoots { roots: vec!["a".into(), "c".into()] });
    let unknown = error(&robot(&format!("{ab}{}", joint("bx", "fixed", "bb", "c", ""))));
    assert!(
        unknown.to_string().starts_with("line 6: joint 'bx': there is no link 'bb'; did you mean"),
        "{unknown}"
    );
}

#[test]
fn missing_and_duplicate_names_are_refused() {
    let twice = format!("<robot><link name='a'>{INERTIAL}</link><link name='a'/></robot>");
    assert_eq!(
        problem(&twice),
        UrdfProblem::Model(ModelError::DuplicateName { what: "link", name: "a".into() })
    );
    let joints = joint("j", "fixed", "a", "b", "") + &joint("j", "fixed", "a", "c", "");
    assert_eq!(
        problem(&robot(&joints)),
        UrdfProblem::Model(ModelError::DuplicateName { what: "joint", name: "j".into() })
    );
    assert!(matches!(
        problem("<robot><link/></robot>"),
        UrdfProblem::MissingAttribute { attribute: "name", .. }
    ));
    let no_child = robot("<joint name='j' type='fixed'><parent link='a'/></joint>");
    assert_eq!(
        problem(&no_child),
        UrdfProblem::MissingElement { owner: "joint 'j'".into(), element: "child" }
    );
    let no_type = robot("<joint name='j'><parent link='a'/><child link='b'/></joint>");
    assert!(matches!(problem(&no_type), UrdfProblem::MissingAttribute { attribute: "type", .. }));
}

#[test]
fn unsupported_joints_are_refused() {
    for kind in ["Planar", "universal", "Floating", "screw", "Revolute", "hinge"] {
        let joints = joint("j", kind, "a", "b", "") + &joint("bc", "fixed", "b", "c", "");
        assert_eq!(
            problem(&robot(&joints)),
            UrdfProblem::JointType { joint: "j".into(), kind: kind.into() },
            "{kind}"
        );
    }
    let typo = joint("j", "revolut", "a", "b", "") + &joint("bc", "fixed", "b", "c", "");
    assert!(error(&robot(&typo)).to_string().ends_with("did you mean 'revolute'?"));
    let zero = joint("j", "revolute", "a", "b", "<axis xyz='0 0 0'/>") + &joint("bc", "fixed", "b", "c", "");
    assert_eq!(problem(&robot(&zero)), UrdfProblem::Model(ModelError::ZeroAxis { joint: "j".into() }));
    let damping =
        joint("j", "revolute", "a", "b", "<dynamics damping='-1'/>") + &joint("bc", "fixed", "b", "c", "");
    assert!(matches!(
        problem(&robot(&damping)),
        UrdfProblem::Model(ModelError::Negative { what: "the damping", .. })
    ));
}

#[test]
fn invalid_numbers_name_the_link() {
    for text in ["nan", "inf", "1,0", "", "one", "1 2", "0x10", "--1", "1e999"] {
        let xml = with_inertial(&INERTIAL.replace("mass value=\"1\"", &format!("mass value=\"{text}\"")));
        let UrdfProblem::BadNumber { owner, attribute, .. } = problem(&xml) else {
            panic!("{text}: {}", error(&xml))
        };
        assert_eq!((owner.as_str(), attribute), ("link 'b'", "value"), "{text}");
    }
    for text in ["1,0 0 0", "1,0 0 0 0", "0 0", "0 0 0 0", "nan 0 0", "a b c"] {
        let origin = format!("<origin xyz='{text}'/>");
        let joints = joint("j", "revolute", "a", "b", &origin) + &joint("bc", "fixed", "b", "c", "");
        let UrdfProblem::BadNumber { owner, expected, .. } = problem(&robot(&joints)) else {
            panic!("{text}")
        };
        assert_eq!((owner.as_str(), expected), ("joint 'j'", 3), "{text}");
    }
}

#[test]
fn non_physical_inertials_are_refused() {
    let model = |inertial: &str| match problem(&with_inertial(inertial)) {
        UrdfProblem::Model(error) => error,
        other => panic!("{other}"),
    };
    let negative = INERTIAL.replace("value=\"1\"", "value=\"-2\"");
    assert_eq!(model(&negative), ModelError::MassNotPositive { link: "b".into(), mass: -2.0 });
    // an inertia without a mass does not resist sliding
    let flywheel = INERTIAL.replace("value=\"1\"", "value=\"0\"");
    let sliding = with_inertial(&flywheel).replace("revolute", "prismatic");
    let massless = ModelError::MasslessSubtree { joint: "j".into(), link: "b".into() };
    assert_eq!(problem(&sliding), UrdfProblem::Model(massless));
    let indefinite = INERTIAL.replace("ixx=\"1\"", "ixx=\"-1\"");
    assert!(matches!(model(&indefinite), ModelError::IndefiniteInertia { link, .. } if link == "b"));
    assert!(matches!(model(""), ModelError::MasslessSubtree { joint, link } if joint == "j" && link == "b"));
    let no_value = INERTIAL.replace("<mass value=\"1\"/>", "<mass/>");
    assert!(matches!(
        problem(&with_inertial(&no_value)),
        UrdfProblem::MissingAttribute { attribute: "value", .. }
    ));
}

#[test]
fn xacro_is_refused_with_a_suggested_fix() {
    let xmlns = "xmlns:xacro='http://www.ros.org/wiki/xacro'";
    let files = [
        format!("<robot {xmlns}><xacro:property name='p' value='1'/></robot>"),
        "<robot><xacro:property name='p' value='1'/></robot>".to_owned(),
        with_inertial(&INERTIAL.replace("value=\"1\"", "value=\"${mass}\"")),
        with_inertial("<inertial><origin xyz='$(arg xyz)'/><mass value='1'/></inertial>"),
        // parts of the robot that only xacro can generate
        format!(
            "<robot {xmlns}><link name='a'>{INERTIAL}</link><xacro:arm/>{}</robot>",
            joint("j", "fixed", "a", "b", "")
        ),
        format!(
            "<robot><link name='a'>{INERTIAL}</link><link name='b'>{INERTIAL}</link><xacro:arm/></robot>"
        ),
    ];
    for xml in files {
        let text = error(&xml).to_string();
        assert!(text.contains("must be expanded to URDF: xacro"), "{xml}: {text}");
        assert!(matches!(problem(&xml), UrdfProblem::Xacro { .. }), "{xml}");
    }
    let macros = format!(
        "<robot {xmlns}><xacro:property name='p' value='1'/><xacro:macro name='m'><link name='a'/></xacro:macro></robot>"
    );
    assert_eq!(problem(&macros), UrdfProblem::OnlyMacros);
    // every expanded file still declares the prefix
    assert!(
        from_str(
            &format!("<robot {xmlns}><link name='a'>{INERTIAL}</link></robot>"),
            None,
            &Default::default()
        )
        .is_ok()
    );
}

#[test]
fn a_robot_made_incomplete_by_a_prefix_is_refused() {
    let ab = joint("ab", "fixed", "a", "b", "");
    let drake = joint("bc", "fixed", "b", "c", "")
        .replace("<joint", "<drake:joint")
        .replace("</joint", "</drake:joint");
    let found = error(&robot(&format!("{ab}{drake}")));
    assert_eq!(*found.problem, UrdfProblem::ForeignElement { element: "drake:joint".to_owned() });
    assert_eq!(found.line, Some(6));
}

#[test]
fn line_numbers_hold_with_undeclared_prefixes() {
    let xml = "<?xml version='1.0'?>\n<!-- <robot> -- -->\n<robot\n name='r'>\n<a:b/>\n<c:d e:f='1'/>\n<link name='l'><inertial><mass/></inertial></link></robot>";
    let found = error(xml);
    assert_eq!(
        (found.line, found.to_string().contains("<mass> of link 'l' has no attribute")),
        (Some(7), true),
        "{found}"
    );
    let many: String = (0..200).map(|i| format!("<p{i}:x/>")).collect();
    assert_eq!(problem(&format!("<robot>{many}</robot>")), UrdfProblem::NoLinks);
}
