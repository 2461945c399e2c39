//! Builder that assembles the model of a robot link by link.

use super::closed_loop::Mimic;
use super::compile::{check_parts, compile};
use super::description::{Description, Inertial, Joint, JointKind, Link};
use super::error::{ModelError, ModelWarning};
use super::inertia_check::{LONGEST, Sense, check_inertial};
use super::tree::Model;
use super::well_posed::check_well_posed;
use nalgebra::{Isometry3, Matrix3, Vector3};
use std::collections::{HashMap, HashSet};

/// Largest number of moving joints. With this number, the mass matrix occupies 32 MB, and the derivatives of
/// the dynamics three times as much.
const MOST_JOINTS: usize = 2000;

/// Builder of a model from links and joints.
///
/// The first link is the floating base. A joint connects each further link to a link that was added before.
/// [`close`](ModelBuilder::close) adds closed loops as constraints, and [`build`](ModelBuilder::build)
/// returns the model.
#[derive(Clone, Debug)]
pub struct ModelBuilder {
    pub(super) description: Description,
    warnings: Vec<ModelWarning>,
    /// Index of each link by name.
    link_index: HashMap<String, usize>,
    joint_names: HashSet<String>,
    moving_joints: usize,
    frame_names: HashSet<String>,
}

impl ModelBuilder {
    /// Creates a builder for a robot whose floating base is the link `base`.
    ///
    /// # Errors
    /// [`ModelError`] if the name of the base is empty, or if its mass, centre of mass or inertia is invalid.
    pub fn new(name: &str, base: Link) -> Result<Self, ModelError> {
        let mut builder = Self {
            description: Description { name: name.to_owned(), ..Description::default() },
            warnings: Vec::new(),
            link_index: HashMap::new(),
            joint_names: HashSet::new(),
            moving_joints: 0,
            frame_names: HashSet::new(),
        };
        builder.add_link(base, false)?;
        Ok(builder)
    }

    /// Adds the link `child`, connected to the link `parent` by `joint`.
    ///
    /// # Errors
    /// [`ModelError`] for an unknown parent, a name that is empty or used twice, too many moving joints, an
    /// axis of length zero, another invalid parameter of the joint (such as negative damping, reversed limits
    /// or a spring at a fixed joint), or an invalid inertia of the child.
    pub fn add(&mut self, parent: &str, joint: Joint, child: Link) -> Result<&mut Self, ModelError> {
        let parent = self.link(parent)?;
        if self.has_joint(&joint.name) {
            return Err(ModelError::DuplicateName { what: "joint", name: joint.name });
        }
        check_joint(&joint)?;
        self.warnings.extend(spring_warning(&joint));
        let count = self.moving_joints + usize::from(joint.kind != JointKind::Fixed);
        if count > MOST_JOINTS {
            return Err(ModelError::TooManyJoints { most: MOST_JOINTS });
        }
        self.add_link(child, joint.kind == JointKind::Fixed)?;
        self.moving_joints = count;
        self.joint_names.insert(joint.name.clone());
        self.description.joints.push((parent, joint));
        Ok(self)
    }

    /// Returns a builder with the links, joints, frames and loops of an existing robot.
    ///
    /// # Errors
    /// [`ModelError::NoMass`] for a robot without links, and the errors of [`ModelBuilder::new`],
    /// [`ModelBuilder::add`], [`ModelBuilder::add_frame`] and [`ModelBuilder::close`].
    pub fn from_description(description: Description) -> Result<Self, ModelError> {
        let base = description.links.first().cloned().ok_or(ModelError::NoMass)?;
        let mut builder = Self::new(&description.name, base)?;
        builder.add_below_root(description)?;
        Ok(builder)
    }

    /// Attaches a whole robot to the link `parent`; the robot's root link becomes the child link of `joint`.
    ///
    /// # Errors
    /// [`ModelError::NoMass`] for a robot without links, and the errors of [`ModelBuilder::add`],
    /// [`ModelBuilder::add_frame`] and [`ModelBuilder::close`].
    pub fn add_robot(
        &mut self,
        parent: &str,
        joint: Joint,
        robot: Description,
    ) -> Result<&mut Self, ModelError> {
        let root = robot.links.first().cloned().ok_or(ModelError::NoMass)?;
        self.add(parent, joint, root)?;
        self.add_below_root(robot)
    }

    /// Adds all links, joints, frames and loops of a robot except its root link, which must have been added
    /// before.
    fn add_below_root(&mut self, robot: Description) -> Result<&mut Self, ModelError> {
        let names: Vec<String> = robot.links.iter().map(|link| link.name.clone()).collect();
        for ((parent, joint), link) in robot.joints.into_iter().zip(robot.links.into_iter().skip(1)) {
            self.add(&names[parent], joint, link)?;
        }
        for (name, link, pose) in robot.frames {
            self.add_frame(&name, &names[link], pose)?;
        }
        for closing in robot.loops {
            self.close(closing)?;
        }
        Ok(self)
    }

    /// Adds a frame fixed to the link `link`; `pose` is the pose of the frame in link axes.
    ///
    /// # Errors
    /// [`ModelError`] for an unknown link, a name that is empty or that a link or frame already has, or a
    /// pose that is not finite.
    pub fn add_frame(
        &mut self,
        name: &str,
        link: &str,
        pose: Isometry3<f64>,
    ) -> Result<&mut Self, ModelError> {
        let link = self.link(link)?;
        self.check_new_frame_name(name)?;
        if !pose.to_homogeneous().iter().all(|x| x.is_finite()) {
            return Err(ModelError::NotFinite { what: "the pose", name: name.to_owned() });
        }
        self.frame_names.insert(name.to_owned());
        self.description.frames.push((name.to_owned(), link, pose));
        Ok(self)
    }

    /// Adds a warning to those that the built model returns.
    pub fn warn(&mut self, warning: ModelWarning) -> &mut Self {
        self.warnings.push(warning);
        self
    }

    /// Copies the warnings of kind [`ModelWarning::Note`] of a robot. Warnings of other kinds are produced
    /// again when the robot's links and joints are added and compiled.
    pub(super) fn keep_notes(&mut self, model: &Model) -> &mut Self {
        let notes = model.warnings().iter().filter(|warning| matches!(warning, ModelWarning::Note(_)));
        self.warnings.extend(notes.cloned());
        self
    }

    /// Compiles the model: checks it, merges links on fixed joints into bodies, and aligns the z axis of each
    /// body with its joint.
    ///
    /// # Errors
    /// [`ModelError`] for a robot without mass, a body with an indefinite inertia, a motion that no inertia
    /// resists, or an invalid loop or mimic joint.
    pub fn build(self) -> Result<Model, ModelError> {
        let model = self.build_part()?;
        check_parts(&model)?;
        check_well_posed(&model)?;
        Ok(model)
    }

    /// Returns the model of a part that will be attached to another robot. The dynamics of a part may be
    /// singular and must not be evaluated.
    pub(super) fn build_part(self) -> Result<Model, ModelError> {
        compile(self.description, self.warnings)
    }

    /// Adds a link after checking its name and its inertia. A link that is merged into another
    /// body (`is_part`) may have an indefinite inertia, because the inertia of the whole body is checked
    /// later.
    fn add_link(&mut self, link: Link, is_part: bool) -> Result<(), ModelError> {
        self.check_new_frame_name(&link.name)?;
        if let Some(inertial) = &link.inertial {
            match check_inertial(&link.name, inertial)? {
                Sense::Physical => {}
                Sense::Rounded(moments) => {
                    self.warnings.push(ModelWarning::RoundedInertia { link: link.name.clone(), moments });
                }
                Sense::Massless => {
                    self.warnings.push(ModelWarning::InertiaWithoutMass { link: link.name.clone() });
                }
                Sense::BreaksTriangle(moments) => {
                    self.warnings.push(ModelWarning::TriangleInequality { link: link.name.clone(), moments });
                }
                Sense::Indefinite(moments) if is_part => {
                    self.warnings.push(ModelWarning::IndefinitePart { link: link.name.clone(), moments });
                }
                Sense::Indefinite(moments) => {
                    return Err(ModelError::IndefiniteInertia { link: link.name, moments });
                }
            }
        }
        self.link_index.insert(link.name.clone(), self.description.links.len());
        self.description.links.push(link);
        Ok(())
    }

    /// Returns true if a moving or fixed joint has this name.
    pub(super) fn has_joint(&self, name: &str) -> bool {
        self.joint_names.contains(name)
    }

    fn check_new_frame_name(&self, name: &str) -> Result<(), ModelError> {
        if name.is_empty() {
            return Err(ModelError::EmptyName { what: "link or frame" });
        }
        if self.link_index.contains_key(name) || self.frame_names.contains(name) {
            return Err(ModelError::DuplicateName { what: "link or frame", name: name.to_owned() });
        }
        Ok(())
    }

    fn link(&self, name: &str) -> Result<usize, ModelError> {
        self.link_index.get(name).copied().ok_or_else(|| ModelError::UnknownName {
            what: "link",
            name: name.to_owned(),
            candidates: self.description.links.iter().map(|link| link.name.clone()).collect(),
        })
    }
}

impl Model {
    /// Returns a spacecraft without joints. Its only body, `base`, has the given mass, kg, its centre of mass
    /// at its origin, and the given inertia about the centre of mass, kg m².
    ///
    /// # Errors
    /// [`ModelError`] for a mass that is not positive, an inertia that is not symmetric and positive
    /// definite, or numbers that are not finite or out of range.
    pub fn rigid_body(mass: f64, inertia: Matrix3<f64>) -> Result<Self, ModelError> {
        if mass == 0.0 {
            return Err(ModelError::MassNotPositive { link: "base".to_owned(), mass });
        }
        let inertial = Inertial { mass, com: Vector3::zeros(), inertia };
        ModelBuilder::new("rigid_body", Link::new("base", Some(inertial)))?.build()
    }
}

fn check_joint(joint: &Joint) -> Result<(), ModelError> {
    let name = || joint.name.clone();
    if joint.name.is_empty() {
        return Err(ModelError::EmptyName { what: "joint" });
    }
    if !joint.origin.to_homogeneous().iter().all(|x| x.is_finite()) {
        return Err(ModelError::NotFinite { what: "the origin", name: name() });
    }
    let (shift, expected) = (joint.origin.translation.vector.amax(), "at most 1e12 m");
    if shift > LONGEST {
        return Err(ModelError::OutOfRange { what: "the origin", name: name(), value: shift, expected });
    }
    if let JointKind::Revolute(axis) | JointKind::Prismatic(axis) = &joint.kind {
        if !axis.iter().all(|x| x.is_finite()) {
            return Err(ModelError::NotFinite { what: "the axis", name: name() });
        }
        if axis.norm() == 0.0 {
            return Err(ModelError::ZeroAxis { joint: name() });
        }
        if !axis.norm().is_finite() {
            let (value, expected) = (axis.amax(), "components of at most 1e150");
            return Err(ModelError::OutOfRange { what: "the axis", name: name(), value, expected });
        }
    }
    if let Some(Mimic { ratio, offset, .. }) = &joint.mimic {
        for (what, value) in [("the ratio of the mimic", *ratio), ("the offset of the mimic", *offset)] {
            if !value.is_finite() {
                return Err(ModelError::NotFinite { what, name: name() });
            }
        }
    }
    let is_prismatic = matches!(joint.kind, JointKind::Prismatic(_));
    let unit_of = |angular: &'static str, linear: &'static str| if is_prismatic { linear } else { angular };
    let amounts = [
        ("the damping", joint.damping, unit_of("N m s/rad", "N s/m")),
        ("the friction", joint.friction, unit_of("N m", "N")),
        ("the static friction", joint.static_friction.unwrap_or(0.0), unit_of("N m", "N")),
        ("the rotor inertia", joint.rotor_inertia, unit_of("kg m2", "kg")),
        ("the velocity limit", joint.limits.velocity.unwrap_or(0.0), unit_of("rad/s", "m/s")),
        ("the effort limit", joint.limits.effort.unwrap_or(0.0), unit_of("N m", "N")),
    ];
    for (what, value, unit) in amounts {
        let is_limit = what.ends_with("limit");
        if value.is_nan() {
            return Err(match is_limit {
                true => ModelError::LimitIsNan { joint: name(), what },
                false => ModelError::NotFinite { what, name: name() },
            });
        }
        if value < 0.0 {
            return Err(ModelError::Negative { joint: name(), what, value, unit });
        }
        if value > 1e20 && !is_limit {
            let expected = "at most 1e20, in SI units";
            return Err(ModelError::OutOfRange { what, name: name(), value, expected });
        }
    }
    if let Some(at_rest) = joint.static_friction.filter(|at_rest| *at_rest < joint.friction) {
        let (moving, unit) = (joint.friction, unit_of("N m", "N"));
        return Err(ModelError::StaticBelowKinetic { joint: name(), at_rest, moving, unit });
    }
    check_spring(joint)?;
    match joint.limits.position {
        Some((lower, upper)) if lower.is_nan() || upper.is_nan() => {
            Err(ModelError::LimitIsNan { joint: name(), what: "a position limit" })
        }
        Some((lower, upper)) if lower > upper => {
            Err(ModelError::LimitsReversed { joint: name(), lower, upper, unit: unit_of("rad", "m") })
        }
        _ => Ok(()),
    }
}

fn check_spring(joint: &Joint) -> Result<(), ModelError> {
    match (&joint.spring, &joint.kind) {
        (Some(_), JointKind::Fixed) => {
            Err(ModelError::FixedJoint { joint: joint.name.clone(), what: "a spring" })
        }
        (Some(spring), kind) => spring.check(&joint.name, matches!(kind, JointKind::Prismatic(_))),
        (None, _) => Ok(()),
    }
}

fn spring_warning(joint: &Joint) -> Option<ModelWarning> {
    let is_prismatic = matches!(joint.kind, JointKind::Prismatic(_));
    joint.spring.as_ref()?.warning(&joint.name, is_prismatic, joint.limits.position)
}
