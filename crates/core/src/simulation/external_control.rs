//! Description of a control that follows external commands.

use crate::control::Interface;

/// Control that follows external commands.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct ExternalControl {
    /// Name of the control.
    pub name: String,
    /// Names of the joints of the control.
    pub joints: Vec<String>,
    /// Quantity that the control tracks: positions if its gains `kp` are positive, otherwise rates if its
    /// gains `kd` are positive, otherwise efforts.
    pub interface: Interface,
}
