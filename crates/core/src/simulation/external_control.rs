//! Description of a control that follows the commands of the caller of a stepper.

use crate::control::Interface;

/// Control that follows the commands of the caller of a stepper.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct ExternalControl {
    /// Name of the control.
    pub name: String,
    /// Names of the joints of the control.
    pub joints: Vec<String>,
    /// Quantity that commands to the control specify: joint positions if its gains `kp` are positive,
    /// otherwise joint rates if its gains `kd` are positive, otherwise joint efforts.
    pub interface: Interface,
}
