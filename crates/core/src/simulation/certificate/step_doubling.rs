//! Step-doubling errors of the joints and of the base's origin, relative to the scales of the motion.

use super::error_measures::{relative, worst};
use crate::model::{Axis, Model};
use crate::simulation::trace::Trace;

/// Displacement during the whole run below which a joint is treated as at rest, in rad or as a fraction of
/// the robot's size.
const REST: f64 = 1e-6;

/// Model, trace and scales from which the step-doubling errors of a run are computed.
pub(super) struct StepDoubling<'a> {
    pub(super) model: &'a Model,
    pub(super) trace: &'a Trace,
    /// Radius of gyration of the robot, m.
    pub(super) size: f64,
    /// Largest relative error of a joint that passes the check.
    pub(super) gate: f64,
}

impl StepDoubling<'_> {
    /// Returns the largest relative error of any joint. The error of a position is in rad or relative to the
    /// robot's size; the error of a rate is relative to the largest rate of the joint. Both are estimated by
    /// step doubling, and the latter also from the jumps of the joint accelerations. Returns `None` without
    /// step doubling or without joints.
    ///
    /// The balances of the whole robot do not reveal errors of light links; here, the error of each joint is
    /// relative to the motion of that joint.
    pub(super) fn joints(&self) -> Option<f64> {
        let joints = self.trace.step_doubling.get(1..).filter(|joints| !joints.is_empty())?;
        let duration = self.duration();
        let off = joints.iter().zip(&self.model.nodes()[1..]).map(|(drift, node)| {
            let unit = if node.axis == Axis::Prismatic { self.size } else { 1.0 };
            // the rate error of a joint at rest passes the gate if it moves the joint by less than REST
            let creep = REST * unit / (self.gate * duration.max(f64::MIN_POSITIVE));
            let fastest = drift.fastest + creep;
            // error of a step estimated from the jump after the step, see `acceleration_jumps.rs`
            let jumps = 1.75 * relative(drift.jumps, fastest.powf(1.25));
            worst(worst(relative(drift.position, unit), relative(drift.rate, fastest)), jumps)
        });
        Some(off.fold(0.0, worst))
    }

    /// Returns the position error of the base's origin relative to the `path` of the centre of mass, m, plus
    /// the robot's size. The error of the velocity, multiplied by the duration of the run, is included.
    /// Returns `None` without step doubling.
    pub(super) fn origin(&self, path: f64) -> Option<f64> {
        let origin = self.trace.step_doubling.first()?;
        Some(relative(origin.position + origin.rate * self.duration(), path + self.size))
    }

    /// Returns the duration of the run, s.
    fn duration(&self) -> f64 {
        let time = &self.trace.time;
        time.last().zip(time.first()).map_or(0.0, |(last, first)| last - first)
    }
}
