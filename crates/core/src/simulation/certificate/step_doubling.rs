//! Step-doubling errors of each joint and of the base's origin, each over its own scale.

use super::{relative, worst};
use crate::model::{Axis, Model};
use crate::simulation::trace::Trace;

/// Displacement over the whole run below which a joint counts as at rest, rad or fractions of the robot's size.
const REST: f64 = 1e-6;

/// What the run's own probes found.
pub(super) struct Doubling<'a> {
    pub(super) model: &'a Model,
    pub(super) trace: &'a Trace,
    /// Radius of gyration of the robot, m.
    pub(super) size: f64,
    /// Largest value that passes, of joints.
    pub(super) gate: f64,
}

impl Doubling<'_> {
    /// The worst joint: the error of its position, and that of its rate over its largest rate, from the steps that were
    /// halved and from what every step shows. What light links do
    /// is invisible in balances of the whole robot; here each joint is measured by its own motion.
    pub(super) fn joints(&self) -> Option<f64> {
        let joints = self.trace.step_doubling.get(1..).filter(|joints| !joints.is_empty())?;
        let duration = self.duration();
        let off = joints.iter().zip(&self.model.nodes()[1..]).map(|(drift, node)| {
            let unit = if node.axis == Axis::Prismatic { self.size } else { 1.0 };
            // an error of the rate that passes the gate at rest moves the joint by less than REST
            let creep = REST * unit / (self.gate * duration.max(f64::MIN_POSITIVE));
            let fastest = drift.fastest + creep;
            // the error of a step from the jump after it, see `watch.rs`
            let jumps = 1.75 * relative(drift.jumps, fastest.powf(1.25));
            worst(worst(relative(drift.position, unit), relative(drift.rate, fastest)), jumps)
        });
        Some(off.fold(0.0, worst))
    }

    /// The base's origin, over `path`, m, of the centre of mass plus the robot's size; an error of its velocity counts with the time of
    /// the run.
    pub(super) fn origin(&self, path: f64) -> Option<f64> {
        let origin = self.trace.step_doubling.first()?;
        Some(relative(origin.position + origin.rate * self.duration(), path + self.size))
    }

    /// Of the run, s.
    fn duration(&self) -> f64 {
        let time = &self.trace.time;
        time.last().zip(time.first()).map_or(0.0, |(last, first)| last - first)
    }
}
