//! Commanded internal forces of closed loops.

use super::error::ControlError;
use super::gains::check_size;
use crate::model::{Closure, Model};

/// Commanded force that a closed loop transmits: the wrench on its second body, in the axes of the loop's joint on its
/// first frame, at the origin of this joint.
///
/// For two hands that hold a load, the loop is the capture that closes it, and the force is the wrench of this hand on
/// the load, in the axes of the captured frame at its origin. The other hand carries the rest of the load. The torques
/// that change it do not move the robot.
#[derive(Clone, Debug, PartialEq)]
pub struct InternalForce {
    /// Name of the loop, or of the capture that closes it.
    pub closure: String,
    /// Force, N; `None` leaves it to the torques of least norm.
    pub force: Option<[f64; 3]>,
    /// Moment, N m; `None` leaves it to the torques of least norm.
    pub moment: Option<[f64; 3]>,
}

impl InternalForce {
    /// Returns the commanded rows of a closure, with their values, N and N m.
    pub(super) fn rows(&self, closure: &Closure) -> Vec<(usize, f64)> {
        let directions = closure.directions().iter().enumerate();
        let value = |(row, &(axis, is_moment)): (usize, &(usize, bool))| {
            let part = if is_moment { self.moment } else { self.force };
            part.map(|part| (row, part[axis]))
        };
        directions.filter_map(value).collect()
    }

    /// Checks the force for the control of this name. `captures` are the names of the captures that may close a loop.
    pub(super) fn check(
        &self,
        control: &str,
        model: &Model,
        captures: &[String],
    ) -> Result<(), ControlError> {
        check_size("force", &self.force.unwrap_or_default())?;
        check_size("moment", &self.moment.unwrap_or_default())?;
        let (control, name) = (control.to_owned(), self.closure.clone());
        let closures = || model.closures().iter().filter(|closure| !closure.directions().is_empty());
        let Some(closure) = closures().find(|closure| closure.name == name) else {
            if captures.contains(&name) {
                return Ok(());
            }
            let known = closures().map(|closure| closure.name.clone()).chain(captures.iter().cloned());
            return Err(ControlError::NoSuchLoop { control, name, known: known.collect() });
        };
        let is_free = |(axis, is_moment): (usize, bool)| !closure.directions().contains(&(axis, is_moment));
        for (is_moment, part) in [(false, self.force), (true, self.moment)] {
            let part = part.unwrap_or_default();
            if let Some(axis) = (0..3).find(|&axis| part[axis] != 0.0 && is_free((axis, is_moment))) {
                let (direction, axis) =
                    (["force along", "moment about"][usize::from(is_moment)], ["x", "y", "z"][axis]);
                return Err(ControlError::FreeDirection { control, name, direction, axis });
            }
        }
        Ok(())
    }
}
