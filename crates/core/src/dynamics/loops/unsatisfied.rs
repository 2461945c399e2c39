//! Texts of messages about loops that are open and mimic joints that do not follow their leaders.

use super::ClosedLoops;
use crate::model::{Axis, Constraint, Model};
use crate::number_text::short;

/// Largest opening of a loop that counts as closed, or error of a mimic joint that counts as satisfied, m or
/// rad.
const CLOSED: f64 = 1e-11;

/// Error for loops that cannot be closed, or mimic joints that cannot follow their leaders, near a given
/// configuration.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[error(
    "no configuration near the given one satisfies all constraints of loops and mimic joints: {faults}; check \
     {check}, or start closer to a configuration that satisfies them"
)]
pub struct UnsatisfiedConstraints {
    /// Text that lists the open loops and the mimic joints that do not follow, with their errors.
    pub faults: String,
    /// Text that states which properties of the robot to check.
    pub check: String,
}

impl ClosedLoops<f64> {
    /// Checks that the constraint errors computed last, such as those that
    /// [`close_loops`](super::close_loops) leaves, are at most 1e-11 m or rad.
    ///
    /// # Errors
    /// [`UnsatisfiedConstraints`] with all loops and mimic joints that have larger errors.
    pub fn check_closed(&self, model: &Model) -> Result<(), UnsatisfiedConstraints> {
        let is_open = |i: &usize| !self.magnitudes(*i, self.errors()).iter().all(|error| *error <= CLOSED);
        let open: Vec<usize> = (0..self.closures().len()).filter(is_open).collect();
        if open.is_empty() {
            return Ok(());
        }
        let is_mimic = |i: &usize| matches!(self.closures()[*i].constraint, Constraint::Mimic { .. });
        let describe = |i: &usize| {
            let by = self.opening(model, *i, self.errors(), ["m", "rad"]);
            let name = &self.closures()[*i].name;
            match is_mimic(i) {
                true => format!(
                    "the mimic joint '{name}' still differs by {by} from the position that its leader \
                     prescribes"
                ),
                false => format!("the loop '{name}' stays open by {by}"),
            }
        };
        let faults: Vec<String> = open.iter().map(describe).collect();
        let poses = open.iter().any(|i| !is_mimic(i)).then_some("the poses and lengths of the loops");
        let ratios = open.iter().any(is_mimic).then_some("the ratios and offsets of the mimic joints");
        let check: Vec<&str> = poses.into_iter().chain(ratios).collect();
        Err(UnsatisfiedConstraints { faults: faults.join(", "), check: check.join(" and ") })
    }

    /// Formats the distance and the angle by which a closure (index) is open, or their rates; zeros are
    /// omitted. `x`, `(m,)`, contains the errors of all constraints, or the rates of these errors, and
    /// `units` the units of distances and of angles in `x`.
    pub(crate) fn opening(&self, model: &Model, closure: usize, x: &[f64], units: [&str; 2]) -> String {
        let units = match self.closures()[closure].constraint {
            Constraint::Mimic { joint, .. } if model.nodes()[joint + 1].axis == Axis::Prismatic => {
                [units[0]; 2]
            }
            _ => units,
        };
        let parts = self.magnitudes(closure, x).into_iter().zip(units).filter(|(size, _)| *size != 0.0);
        let parts: Vec<String> = parts.map(|(size, unit)| format!("{} {unit}", short(size))).collect();
        parts.join(" and ")
    }
}
