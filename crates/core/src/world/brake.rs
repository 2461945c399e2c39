//! Brakes of joints.

/// Brake of a joint.
///
/// While it is engaged, a brake with a finite slip torque adds Coulomb friction of that torque to the joint,
/// at rest and in motion. A brake with an infinite slip torque holds the joint rigidly and stops a moving
/// joint by an impulse.
#[derive(Clone, Debug, PartialEq)]
pub struct Brake {
    /// Name, which is unique among the brakes of the system.
    pub name: String,
    /// Index of the joint among the joints of the system.
    pub joint: usize,
    /// Largest torque that the brake can exert, N m (N for a prismatic joint); may be infinite.
    pub slip_torque: f64,
    /// True if the brake is engaged at the start.
    pub is_engaged: bool,
}
