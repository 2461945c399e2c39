//! Compilation of a description into a tree of numbered bodies, with fixed joints merged and axes aligned.

use super::align::rotation_to_axis;
use super::description::{Description, Inertial, Joint, JointKind};
use super::error::{ModelError, ModelWarning};
use super::frame::Frame;
use super::inertia_check::{is_definite, principal_moments, usable_inertia};
use super::load_ratio::is_heavy_on_light;
use super::tree::{Axis, JointProperties, Model, Node};
use crate::spatial::{Mat3, Sym3, Vec3};
use nalgebra::{Isometry3, Matrix3, Vector3};
use std::sync::Arc;

/// Body to which a link belongs, and the pose of the link in the axes of that body.
#[derive(Clone)]
struct Placed {
    body: usize,
    rot: Matrix3<f64>,
    pos: Vector3<f64>,
}

impl Placed {
    /// Returns the body and pose of a frame that has the given pose in link axes.
    fn moved(&self, pose: &Isometry3<f64>) -> Self {
        if *pose == Isometry3::identity() {
            return self.clone(); // without rounding errors
        }
        let rot = self.rot * pose.rotation.to_rotation_matrix().matrix();
        Self { body: self.body, rot, pos: self.rot * pose.translation.vector + self.pos }
    }
}

pub(super) fn compile(description: Description, warnings: Vec<ModelWarning>) -> Result<Model, ModelError> {
    let children = children(&description);
    let mut model = Model {
        name: description.name.clone(),
        nodes: vec![empty_node()],
        joints: Vec::new(),
        frames: Vec::new(),
        body_frames: vec![0],
        visuals: Vec::new(),
        collisions: Vec::new(),
        warnings,
        is_heavy_on_light: false,
        closures: Vec::new(),
        description: Arc::default(),
    };
    let mut placed: Vec<Option<Placed>> = vec![None; description.links.len()];
    for index in depth_first(&children) {
        let place = if index == 0 {
            Placed { body: 0, rot: Matrix3::identity(), pos: Vector3::zeros() }
        } else {
            let (parent, joint) = &description.joints[index - 1];
            let parent = placed[*parent].clone().expect("parents come first in depth-first order");
            place_link(&mut model, &parent, joint)
        };
        let link = &description.links[index];
        if let Some(inertial) = &link.inertial {
            merge(&mut model.nodes[place.body], inertial, &place);
        }
        let frame = model.frames.len();
        if place.body == model.body_frames.len() {
            model.body_frames.push(frame); // a new body has the name of its first link
        }
        model.frames.push(named_frame(&link.name, &place, &Isometry3::identity()));
        model.visuals.extend(link.visuals.iter().map(|visual| (frame, visual.clone())));
        model.collisions.extend(link.collisions.iter().map(|shape| (frame, shape.clone())));
        placed[index] = Some(place);
    }
    for (name, link, pose) in &description.frames {
        let place = placed[*link].as_ref().expect("every link was placed above");
        model.frames.push(named_frame(name, place, pose));
    }
    model.description = Arc::new(description);
    model.is_heavy_on_light = is_heavy_on_light(&model.nodes);
    model.closures = model.compile_closures()?;
    model.warnings.extend(model.loops_with_friction());
    Ok(model)
}

/// Checks the links whose inertia is indefinite, with or without mass. Such a link is accepted only if the
/// inertia of the whole body that contains it has no negative principal moment.
pub(super) fn check_parts(model: &Model) -> Result<(), ModelError> {
    for warning in &model.warnings {
        let (ModelWarning::IndefinitePart { link, .. } | ModelWarning::InertiaWithoutMass { link }) = warning
        else {
            continue;
        };
        let part = model.description.links.iter().find(|part| part.name == *link);
        let Some(Inertial { inertia, mass, .. }) = part.and_then(|part| part.inertial.as_ref()) else {
            continue;
        };
        let body = &model.nodes[model.frames[model.frame(link)?].body];
        // a definite link is not the one that makes its body indefinite
        if !is_definite(&Sym3::from(*inertia), *mass) && !is_definite(&body.about_com, body.mass) {
            let moments = principal_moments(inertia);
            return Err(ModelError::IndefiniteInertia { link: link.clone(), moments });
        }
    }
    Ok(())
}

/// Returns the indices of the child links of each link, in the order in which they were added.
fn children(description: &Description) -> Vec<Vec<usize>> {
    let mut children = vec![Vec::new(); description.links.len()];
    for (j, (parent, _)) in description.joints.iter().enumerate() {
        children[*parent].push(j + 1);
    }
    children
}

/// Returns the indices of the links in depth-first order from the root: parents before children, branches in
/// the order in which they were added.
fn depth_first(children: &[Vec<usize>]) -> Vec<usize> {
    let (mut order, mut stack) = (Vec::new(), vec![0]);
    while let Some(link) = stack.pop() {
        order.push(link);
        stack.extend(children[link].iter().rev());
    }
    order
}

/// Places a link below `parent`: in the same body if the joint is fixed, otherwise in a new body.
fn place_link(model: &mut Model, parent: &Placed, joint: &Joint) -> Placed {
    let origin = &joint.origin;
    let rot = parent.rot * origin.rotation.to_rotation_matrix().matrix();
    let pos = parent.rot * origin.translation.vector + parent.pos;
    let (kind, axis) = match &joint.kind {
        JointKind::Fixed => return Placed { body: parent.body, rot, pos }.moved(&joint.child_pose),
        JointKind::Revolute(axis) => (Axis::Revolute, axis),
        JointKind::Prismatic(axis) => (Axis::Prismatic, axis),
    };
    let rot_link_body = rotation_to_axis(axis);
    let next = model.nodes.len();
    model.nodes[parent.body].is_fork |= parent.body + 1 != next;
    model.nodes.push(Node {
        parent: parent.body,
        end: next + 1,
        axis: kind,
        rot_pk: (rot * rot_link_body).into(),
        pos_pk: pos.into(),
        rotor_inertia: joint.rotor_inertia,
        ..empty_node()
    });
    let mut carrier = parent.body;
    model.nodes[carrier].end = next + 1;
    while carrier > 0 {
        carrier = model.nodes[carrier].parent;
        model.nodes[carrier].end = next + 1;
    }
    model.joints.push(JointProperties {
        name: joint.name.clone(),
        damping: joint.damping,
        friction: joint.friction,
        static_friction: joint.static_friction.unwrap_or(joint.friction),
        limits: joint.limits,
        spring: joint.spring,
        axis: (joint.child_pose.rotation.inverse() * axis.normalize()).into(),
        anchor: joint.child_pose.inverse().translation.vector.into(),
    });
    let joint_frame =
        Placed { body: model.nodes.len() - 1, rot: rot_link_body.transpose(), pos: Vector3::zeros() };
    joint_frame.moved(&joint.child_pose)
}

fn empty_node() -> Node {
    Node {
        parent: 0,
        is_fork: false,
        end: 1,
        axis: Axis::Revolute,
        rot_pk: Mat3::identity(),
        pos_pk: Vec3::zero(),
        mass: 0.0,
        com: Vec3::zero(),
        about_com: Sym3::diagonal(0.0),
        rotor_inertia: 0.0,
    }
}

/// Adds the mass and the inertia of a link to those of its body. The resulting inertia is about the new
/// common centre of mass.
fn merge(node: &mut Node, inertial: &Inertial, place: &Placed) {
    let com: Vec3<f64> = (place.rot * inertial.com + place.pos).into();
    let about_com = Sym3::from(place.rot * usable_inertia(inertial) * place.rot.transpose());
    let mass = node.mass + inertial.mass;
    if inertial.mass == 0.0 {
        node.about_com += about_com; // without mass, the inertia is the same about every point
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
