//! Replacement of the damping, friction, rotor inertia or spring of a joint by new values.

use super::builder::ModelBuilder;
use super::description::{Joint, JointKind};
use super::error::ModelError;
use super::joint_spring::JointSpring;
use super::lookup::find;
use super::tree::Model;

/// New values of the properties of a joint; `None` keeps the current value.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct JointChange {
    /// Name of the joint.
    pub joint: String,
    /// Coefficient of viscous friction, N m s/rad (N s/m).
    pub damping: Option<f64>,
    /// Kinetic Coulomb friction, which acts while the joint moves, N m (N).
    pub friction: Option<f64>,
    /// Largest torque (force) that static friction can hold, N m (N).
    pub static_friction: Option<f64>,
    /// Rotor inertia reflected to the joint, kg m² (kg).
    pub rotor_inertia: Option<f64>,
    /// Stiffness of the spring at its rest position, N m/rad (N/m).
    pub stiffness: Option<f64>,
    /// Cubic stiffness of the spring, N m/rad³ (N/m³).
    pub cubic_stiffness: Option<f64>,
    /// Rest position of the spring, rad (m).
    pub rest_position: Option<f64>,
}

impl JointChange {
    fn apply(&self, joint: &mut Joint) {
        joint.damping = self.damping.unwrap_or(joint.damping);
        joint.friction = self.friction.unwrap_or(joint.friction);
        joint.static_friction = self.static_friction.or(joint.static_friction);
        joint.rotor_inertia = self.rotor_inertia.unwrap_or(joint.rotor_inertia);
        joint.spring = self.spring(joint.spring);
    }

    /// Returns the spring `old` with the new values; `None` if both stiffnesses are then zero. If only a rest
    /// position is given to a joint without a spring, the returned spring has no stiffness, which the model
    /// builder rejects.
    fn spring(&self, old: Option<JointSpring>) -> Option<JointSpring> {
        let old = old.unwrap_or(JointSpring { stiffness: 0.0, cubic_stiffness: 0.0, rest_position: 0.0 });
        let stiffness = self.stiffness.unwrap_or(old.stiffness);
        let cubic_stiffness = self.cubic_stiffness.unwrap_or(old.cubic_stiffness);
        let is_given = self.stiffness.or(self.cubic_stiffness).is_some() || self.rest_position.is_none();
        let is_removed = stiffness == 0.0 && cubic_stiffness == 0.0 && is_given;
        let rest_position = if is_removed { 0.0 } else { self.rest_position.unwrap_or(old.rest_position) };
        JointSpring::new(stiffness, cubic_stiffness, rest_position)
    }
}

impl Model {
    /// Returns a copy of this robot in which one joint has the given damping, friction, rotor inertia and
    /// spring. Values that are not given do not change.
    ///
    /// # Errors
    /// [`ModelError`] for an unknown or fixed joint, and for invalid values.
    pub fn with_joint(&self, change: &JointChange) -> Result<Self, ModelError> {
        let mut description = self.description().clone();
        let names = description.joints.iter().map(|(_, joint)| joint.name.as_str());
        let place = find("joint", &change.joint, names)?;
        let (_, joint) = &mut description.joints[place];
        if joint.kind == JointKind::Fixed {
            let what = "damping, friction, a rotor or a spring";
            return Err(ModelError::FixedJoint { joint: change.joint.clone(), what });
        }
        change.apply(joint);
        let mut builder = ModelBuilder::from_description(description)?;
        builder.keep_notes(self);
        builder.build()
    }
}
