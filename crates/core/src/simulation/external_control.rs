//! Description of a control that follows commands from outside of the run.

use crate::control::Interface;

/// A control that follows commands from outside of the run.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct ExternalControl {
    /// Name of the control.
    pub name: String,
    /// Names of its joints.
    pub joints: Vec<String>,
    /// What its gains track: positions, or rates, or else efforts.
    pub interface: Interface,
}
