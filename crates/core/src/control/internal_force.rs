//! Commanded internal forces of closed loops.

use super::error::ControlError;
use super::gains::check_size;
use crate::model::{Closure, Model};

/// Commanded wrench that a closed loop transmits to its second body. Its axes and its reference point are
/// those of the loop's joint as seen from the first body.
///
/// If two hands hold a load, one of the captures closes the loop. The wrench is then that of the hand of this
/// capture on the load, about the origin of the captured frame and in its axes; the other hand exerts the
/// rest of the wrench that the motion of the load requires. Torques that change the wrench cause no motion.
#[derive(Clone, Debug, PartialEq)]
pub struct InternalForce {
    /// Name of the loop, or of the capture that closes it.
    pub closure: String,
    /// Force, N; if it is `None`, the force is that of the joint torques of least norm.
    pub force: Option<[f64; 3]>,
    /// Moment, N m; if it is `None`, the moment is that of the joint torques of least norm.
    pub moment: Option<[f64; 3]>,
}

impl InternalForce {
    /// Returns the constraint rows of `closure` with a commanded force or moment: the index of each within
    /// the closure and its value, N or N m.
    pub(super) fn rows<'a>(&'a self, closure: &'a Closure) -> impl Iterator<Item = (usize, f64)> + 'a {
        let directions = closure.directions().iter().enumerate();
        let value = move |(row, &(axis, is_moment)): (usize, &(usize, bool))| {
            let part = if is_moment { self.moment } else { self.force };
            part.map(|part| (row, part[axis]))
        };
        directions.filter_map(value)
    }

    /// Checks the force for the control with the name `control`. `captures` are the names of the captures
    /// that may close a loop.
    pub(super) fn check(
        &self,
        control: &str,
        model: &Model,
        captures: &[String],
    ) -> Result<(), ControlError> {
        for (name, part) in [("force", self.force), ("moment", self.moment)] {
            check_size(name, &part.unwrap_or_default()).map_err(|error| error.of_control(control))?;
        }
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
