//! Brakes of joints.

use super::error::WorldError;
use super::system::System;
use crate::model::BASE_NV;

/// Brake of a joint.
///
/// While it is engaged, a brake with a finite slip torque adds Coulomb friction of that torque to the joint, at
/// rest and in motion. A brake with an infinite slip torque holds the joint rigidly and stops a moving joint by an
/// impulse.
#[derive(Clone, Debug, PartialEq)]
pub struct Brake {
    /// Name, which is unique among the brakes of the system.
    pub name: String,
    /// Index of the joint.
    pub joint: usize,
    /// Largest torque that the brake can hold, N m (N for a prismatic joint); may be infinite.
    pub slip_torque: f64,
    /// True if the brake is engaged at the start.
    pub is_engaged: bool,
}

/// Checks the brakes of a system.
///
/// # Errors
/// [`WorldError`] for a name given twice, a joint that does not exist or has two brakes, a slip torque that is not
/// positive, and a joint that moves at the start although a brake holds it rigidly.
pub fn check_brakes(system: &System) -> Result<(), WorldError> {
    let (brakes, joints) = (&system.brakes, system.model.joints());
    for (i, Brake { name, joint, slip_torque, is_engaged }) in brakes.iter().enumerate() {
        let name = || name.clone();
        if brakes[..i].iter().any(|before| before.name == brakes[i].name) {
            return Err(WorldError::BrakeTwice { name: name() });
        }
        let Some(held) = joints.get(*joint).map(|joint| joint.name.clone()) else {
            return Err(WorldError::BrakeJoint { name: name(), joint: *joint, count: joints.len() });
        };
        if let Some(before) = brakes[..i].iter().find(|before| before.joint == *joint) {
            return Err(WorldError::JointWithTwoBrakes {
                name: name(),
                other: before.name.clone(),
                joint: held,
            });
        }
        if slip_torque.is_nan() || *slip_torque <= 0.0 {
            return Err(WorldError::SlipTorque { name: name(), value: *slip_torque });
        }
        let rate = system.v.get(BASE_NV + joint).copied().unwrap_or(0.0);
        if *is_engaged && slip_torque.is_infinite() && rate != 0.0 {
            return Err(WorldError::HeldJointMoves { name: name(), joint: held, rate });
        }
    }
    Ok(())
}
