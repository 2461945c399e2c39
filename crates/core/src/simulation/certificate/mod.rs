//! What a trace proves about the run that left it.

mod attitude;
mod balance;
mod base_rows;
mod center_of_mass;
mod instant;
mod numbers;
mod step_doubling;
mod stream;

use super::trace::Trace;
use crate::model::Model;
use attitude::Attitude;
use balance::Balance;
use base_rows::BaseRows;
use center_of_mass::CenterOfMass;
use instant::{Instant, Reader};
use step_doubling::Doubling;

pub(super) use instant::{BaseMotion, MassMotion};
pub(super) use numbers::Restore;
pub(super) use stream::Stream;

/// Largest momentum that may go missing: rounding, summed over millions of steps.
const MOMENTUM: f64 = 1e-11;
/// Largest energy that may go missing: what a fourth-order step leaves where it resolves the motion.
const ENERGY: f64 = 1e-6;
/// Largest excursion of the centre of mass from the path its momentum gives.
const CENTER: f64 = 1e-7;
/// Largest error of the attitude, rad, that steps compared with halved ones may add up to.
const STEP_DOUBLING: f64 = 1e-6;
/// Largest error that steps compared with halved ones may add up to: of a joint's angle in rad, of a slide over the
/// robot's size, of a joint's rate over its largest rate.
///
/// What counts as wrong is 1e-3 of a joint's travel. A motion that is not chaotic may make the errors of its steps ten times
/// as large by its end, and the probes may have missed half of them.
const JOINT_STEP_DOUBLING: f64 = 5e-5;
/// The same of the base's origin, over the path of the centre of mass and the robot's size.
const ORIGIN_STEP_DOUBLING: f64 = 1e-4;
/// Largest share of the commutator that the attitude may miss; without group integration it is 1.
const ATTITUDE: f64 = 0.1;

/// How well a trace keeps the laws of mechanics; every number is relative to a scale that does not
/// vanish.
///
/// The two momenta are kept by construction by an integrator that carries them; the other numbers
/// are not. Those that compare neighbouring steps are evaluated during the run where not every step is a row, and
/// `None` with an adaptive integrator, whose rows are interpolated, and with sparse rows of another engine.
#[derive(Clone, Debug, PartialEq)]
pub struct Certificate {
    /// `max |P − P₀ − ∫F dt|` over the peak of `Σ mₖ |vₖ − v_com|` (or of `|P|`, or of the spin
    /// where a single body moves).
    pub linear_momentum_drift_rel: f64,
    /// `max |L − L₀ − ∫T dt|` over the peak of `Σ |Lₖ|`, all about the system's centre of mass.
    pub angular_momentum_drift_rel: f64,
    /// `max |E − E₀ − W|` over `Σ |ΔW|` and the peak of the energy in the centre-of-mass frame; what would move the robot
    /// by less than a millionth of its size in the whole run is rest.
    pub energy_balance_error_rel: f64,
    /// Distance of the centre of mass from the integral of `P/m`, over its path and the robot's size.
    pub center_of_mass_error_rel: Option<f64>,
    /// Base rows of inverse dynamics on differenced velocities less the mean wrench, over the
    /// inertial forces of the bodies.
    pub base_rows_residual_rel: Option<f64>,
    /// What `base_rows_residual_rel` may be: the truncation of a central difference, `O(dt²)`.
    pub base_rows_gate: f64,
    /// Recorded turns less those that the recorded rates imply, over the accumulated commutator:
    /// 1 where attitudes were composed without it, far below where they were integrated on the group.
    pub attitude_consistency: Option<f64>,
    /// What the attitudes of steps and of halved steps differ by, summed over the run, rad.
    pub attitude_step_doubling_rad: Option<f64>,
    /// What positions and rates of a joint in steps and in halved steps differ by, summed over the run, of the joint
    /// that is worst: positions in rad (of sliding joints over the robot's size), rates over the joint's largest rate.
    pub joint_step_doubling_rel: Option<f64>,
    /// Step-doubling error of the base origin's position, over the path of the centre of mass plus the robot's size.
    pub position_step_doubling_rel: Option<f64>,
}

/// The checks that compare neighbouring steps, of a run that evaluated them itself: see [`Certificate`].
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PairChecks {
    /// As [`Certificate::center_of_mass_error_rel`].
    pub center_of_mass_error_rel: f64,
    /// As [`Certificate::base_rows_residual_rel`].
    pub base_rows_residual_rel: f64,
    /// As [`Certificate::base_rows_gate`].
    pub base_rows_gate: f64,
    /// As [`Certificate::attitude_consistency`].
    pub attitude_consistency: f64,
}

/// One line of a certificate.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Check {
    /// Name of the field it comes from.
    pub name: &'static str,
    /// What was found.
    pub value: f64,
    /// Largest value that passes.
    pub gate: f64,
}

impl Check {
    /// Whether the value is within its gate; what is not a number is not.
    pub fn passed(&self) -> bool {
        self.value <= self.gate
    }
}

impl Certificate {
    /// The lines that apply to the run.
    pub fn checks(&self) -> Vec<Check> {
        let lines = [
            ("linear_momentum_drift_rel", Some(self.linear_momentum_drift_rel), MOMENTUM),
            ("angular_momentum_drift_rel", Some(self.angular_momentum_drift_rel), MOMENTUM),
            ("energy_balance_error_rel", Some(self.energy_balance_error_rel), ENERGY),
            ("center_of_mass_error_rel", self.center_of_mass_error_rel, CENTER),
            ("base_rows_residual_rel", self.base_rows_residual_rel, self.base_rows_gate),
            ("attitude_consistency", self.attitude_consistency, ATTITUDE),
            ("attitude_step_doubling_rad", self.attitude_step_doubling_rad, STEP_DOUBLING),
            ("joint_step_doubling_rel", self.joint_step_doubling_rel, JOINT_STEP_DOUBLING),
            ("position_step_doubling_rel", self.position_step_doubling_rel, ORIGIN_STEP_DOUBLING),
        ];
        lines
            .into_iter()
            .filter_map(|(name, value, gate)| value.map(|value| Check { name, value, gate }))
            .collect()
    }

    /// Whether every line passes.
    pub fn passed(&self) -> bool {
        self.checks().iter().all(Check::passed)
    }
}

/// Certifies a run of `model` from its trace alone; a trace without rows proves nothing and has zeros.
pub fn certify(model: &Model, trace: &Trace) -> Certificate {
    let mut reader = Reader::new(model, trace);
    let mut balance = Balance::default();
    let mut center = CenterOfMass::default();
    let mut base_rows = BaseRows::new(model);
    let mut attitude = Attitude::default();
    let mut last = None;
    for k in 0..reader.rows() {
        let now = reader.instant(k);
        balance.add(&now);
        // an impact is two rows at one instant: nothing lies between them
        if let Some(before) = last.as_ref().filter(|before: &&Instant<'_>| before.time < now.time) {
            center.add(&before.whole(), &now.whole());
            if trace.has_every_step {
                base_rows.add(model, before, &now);
                attitude.add(&before.base, &now.base);
            }
        }
        last = Some(now);
    }
    let is_free = trace.impulse.iter().all(|x| *x == 0.0); // then any spacing of rows will do
    let doubling = Doubling { model, trace, size: balance.size(), gate: JOINT_STEP_DOUBLING };
    let center_error = center.error(balance.size(), CENTER);
    let pairs = if trace.has_every_step {
        Some(PairChecks {
            center_of_mass_error_rel: center_error,
            base_rows_residual_rel: base_rows.residual(balance.size()),
            base_rows_gate: base_rows.gate(),
            attitude_consistency: attitude.consistency(ATTITUDE),
        })
    } else {
        trace.pair_checks
    };
    Certificate {
        linear_momentum_drift_rel: balance.linear(),
        angular_momentum_drift_rel: balance.angular(),
        energy_balance_error_rel: balance.energy(trace.work_done),
        center_of_mass_error_rel: pairs
            .map(|pairs| pairs.center_of_mass_error_rel)
            .or_else(|| is_free.then_some(center_error)),
        base_rows_residual_rel: pairs.map(|pairs| pairs.base_rows_residual_rel),
        base_rows_gate: pairs.map_or(0.0, |pairs| pairs.base_rows_gate),
        attitude_consistency: pairs.map(|pairs| pairs.attitude_consistency),
        attitude_step_doubling_rad: trace.attitude_step_doubling,
        joint_step_doubling_rel: doubling.joints(),
        position_step_doubling_rel: doubling.origin(center.path()),
    }
}

/// The larger of two, and not a number if either is: what is broken must not look small.
fn worst(a: f64, b: f64) -> f64 {
    if b > a || b.is_nan() { b } else { a }
}

/// `error / scale`, zero where there is no error at all.
fn relative(error: f64, scale: f64) -> f64 {
    if error == 0.0 { 0.0 } else { error / scale.max(f64::MIN_POSITIVE) }
}
