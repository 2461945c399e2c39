//! From a description to the tree: fixed joints folded, axes aligned, bodies numbered.

use super::align::rotation_to_axis;
use super::builder::ModelBuilder;
use super::description::{Inertial, Joint, JointKind};
use super::error::ModelError;
use super::tree::{Axis, Frame, JointProperties, Model, Node};
use super::well_posed::check_well_posed;
use crate::spatial::{Mat3, Sym3, Vec3};
use nalgebra::{Isometry3, Matrix3, Vector3};

/// Where a link ended up: the body it is part of, and its pose in that body's axes.
#[derive(Clone)]
struct Placed {
    body: usize,
    rot: Matrix3<f64>,
    pos: Vector3<f64>,
}

pub(super) fn compile(mut builder: ModelBuilder) -> Result<Model, ModelError> {
    drop_massless_roots(&mut builder);
    let mut model = Model {
        name: builder.name.clone(),
        nodes: vec![empty_node()],
        joints: Vec::new(),
        frames: Vec::new(),
        body_frames: vec![0],
        visuals: Vec::new(),
        warnings: builder.warnings.clone(),
    };
    let mut placed: Vec<Option<Placed>> = vec![None; builder.links.len()];
    for link in depth_first(&builder) {
        let place = match link.checked_sub(1).map(|j| &builder.joints[j]) {
            None => Placed { body: 0, rot: Matrix3::identity(), pos: Vector3::zeros() },
            Some((parent, joint)) => {
                let parent = placed[*parent].clone().expect("parents come first in depth-first order");
                attach(&mut model, &parent, joint)
            }
        };
        let description = &builder.links[link];
        if let Some(inertial) = &description.inertial {
            merge(&mut model.nodes[place.body], inertial, &place);
        }
        let frame = model.frames.len();
        if place.body == model.body_frames.len() {
            model.body_frames.push(frame); // the first link of a new body names it
        }
        model.frames.push(named_frame(&description.name, &place, &Isometry3::identity()));
        model.visuals.extend(description.visuals.iter().map(|visual| (frame, visual.clone())));
        placed[link] = Some(place);
    }
    for (name, link, pose) in &builder.frames {
        let place = placed[*link].as_ref().expect("every link was placed above");
        model.frames.push(named_frame(name, place, pose));
    }
    check_well_posed(&model)?;
    Ok(model)
}

/// A root without mass that only carries another link by a fixed joint (`world`) is not a body.
fn drop_massless_roots(builder: &mut ModelBuilder) {
    let is_massless = |i: &Option<Inertial>| i.as_ref().is_none_or(|i| i.mass == 0.0);
    while is_massless(&builder.links[0].inertial) && builder.links[0].visuals.is_empty() {
        let mut children = builder.joints.iter().enumerate().filter(|(_, (parent, _))| *parent == 0);
        let (Some((child, (_, joint))), None) = (children.next(), children.next()) else { return };
        if joint.kind != JointKind::Fixed || builder.frames.iter().any(|(_, link, _)| *link == 0) {
            return;
        }
        // the child becomes link 0; link numbers between the two move up by one
        let new_root = child + 1;
        builder.joints.remove(child);
        builder.links.swap(0, new_root);
        builder.links.remove(new_root);
        let renumber = |link: usize| match link {
            l if l == new_root => 0,
            l if l > new_root => l - 1,
            l => l,
        };
        builder.joints.iter_mut().for_each(|(parent, _)| *parent = renumber(*parent));
        builder.frames.iter_mut().for_each(|(_, link, _)| *link = renumber(*link));
    }
}

/// Links, parents before children, branches in the order they were added.
fn depth_first(builder: &ModelBuilder) -> Vec<usize> {
    let mut children = vec![Vec::new(); builder.links.len()];
    for (j, (parent, _)) in builder.joints.iter().enumerate() {
        children[*parent].push(j + 1);
    }
    let (mut order, mut stack) = (Vec::new(), vec![0]);
    while let Some(link) = stack.pop() {
        order.push(link);
        stack.extend(children[link].iter().rev());
    }
    order
}

/// Hangs a link on `parent`: on the same body by a fixed joint, else as a new body.
fn attach(model: &mut Model, parent: &Placed, joint: &Joint) -> Placed {
    let origin = &joint.origin;
    let rot = parent.rot * origin.rotation.to_rotation_matrix().matrix();
    let pos = parent.rot * origin.translation.vector + parent.pos;
    let (kind, axis) = match &joint.kind {
        JointKind::Fixed => return Placed { body: parent.body, rot, pos },
        JointKind::Revolute(axis) => (Axis::Revolute, axis),
        JointKind::Prismatic(axis) => (Axis::Prismatic, axis),
    };
    let rot_link_body = rotation_to_axis(axis);
    model.nodes.push(Node {
        parent: parent.body,
        axis: kind,
        rot_pk: (rot * rot_link_body).into(),
        pos_pk: pos.into(),
        rotor_inertia: joint.rotor_inertia,
        ..empty_node()
    });
    model.joints.push(JointProperties {
        name: joint.name.clone(),
        damping: joint.damping,
        friction: joint.friction,
        limits: joint.limits,
        axis: axis.normalize().into(),
    });
    Placed { body: model.nodes.len() - 1, rot: rot_link_body.transpose(), pos: Vector3::zeros() }
}

fn empty_node() -> Node {
    Node {
        parent: 0,
        axis: Axis::Revolute,
        rot_pk: Mat3::identity(),
        pos_pk: Vec3::zero(),
        mass: 0.0,
        com: Vec3::zero(),
        about_com: Sym3::diagonal(0.0),
        rotor_inertia: 0.0,
    }
}

/// Adds a link's mass to its body: inertias add about the common centre of mass.
fn merge(node: &mut Node, inertial: &Inertial, place: &Placed) {
    let com: Vec3<f64> = (place.rot * inertial.com + place.pos).into();
    let about_com = Sym3::from(place.rot * inertial.inertia * place.rot.transpose());
    let mass = node.mass + inertial.mass;
    if inertial.mass == 0.0 {
        return;
    }
    let common = (node.com * node.mass + com * inertial.mass) * (1.0 / mass);
    let shifted = |about: Sym3<f64>, mass: f64, com: Vec3<f64>| {
        let d = com - common;
        about.shift(d * mass, d)
    };
    node.about_com = shifted(node.about_com, node.mass, node.com) + shifted(about_com, inertial.mass, com);
    node.com = common;
    node.mass = mass;
}

fn named_frame(name: &str, place: &Placed, pose: &Isometry3<f64>) -> Frame {
    Frame {
        name: name.to_owned(),
        body: place.body,
        rot_kf: (place.rot * pose.rotation.to_rotation_matrix().matrix()).into(),
        pos_kf: (place.rot * pose.translation.vector + place.pos).into(),
    }
}
