//! How far the steps are from halved ones: an estimate of the errors of the attitude and of each joint.

use super::error::SimulationError;
use super::integrator::Stages;
use super::plant::{Plant, World};
use super::state::State;
use super::trace::CoordinateDrift;
use super::watch::Watch;
use crate::spatial::{Quat, Scalar, Vec3, log_so3};
use serde::{Deserialize, Serialize};

/// Most steps between two probes; three steps each, so about a hundredth of a run.
const EVERY: usize = 256;
/// Least number of probes of a run that has as many steps.
const LEAST: usize = 5;
/// Further steps that a run of many steps probes early, where transients are.
const EARLY: [usize; 3] = [4, 16, 64];
/// Differences below this many ε of what they are taken from are rounding.
const ROUNDING: f64 = 16.0;

/// Repeats a step now and then as two of half its size, and adds up what their ends differ by.
///
/// A local error of order `p + 1` is smaller by `2^p` in two half steps, so the difference is the
/// local error itself but for a sixteenth (Runge-Kutta). The sum bounds the error of a run that does
/// not amplify it; a chaotic one does.
pub(super) struct Probe<S> {
    whole: State<S>,
    halved: State<S>,
    /// Steps between two probes.
    every: usize,
    pub(super) found: Found,
}

/// What the probes found.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub(super) struct Found {
    /// Step of the last probe.
    pub(super) step: usize,
    /// Difference of the attitude at the last probe, rad, and the sum over the steps before it.
    turn: [f64; 2],
    /// Of the base's origin, then of every joint.
    pub(super) drifts: Vec<Drift>,
    /// What every step shows of the joints.
    pub(super) watch: Watch,
}

/// What the steps and halved steps of a coordinate differ by: its position and its rate.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub(super) struct Drift {
    /// Differences at the last probe.
    last: [f64; 2],
    /// Sums over the steps before it.
    sum: [f64; 2],
    /// Largest rate that a probe saw.
    fastest: f64,
}

impl Drift {
    fn until(&self, steps: f64) -> [f64; 2] {
        [0, 1].map(|i| self.sum[i] + self.last[i] * steps)
    }
}

impl Found {
    /// Sum of the differences of attitude over `steps` steps so far, rad.
    pub(super) fn turn(&self, steps: usize) -> f64 {
        self.turn[1] + self.turn[0] * (steps - self.step) as f64
    }

    /// The same of a coordinate's position and rate, and its largest rate; index 0 is the base's origin, then come
    /// the joints.
    pub(super) fn drift(&self, coordinate: usize, steps: usize) -> CoordinateDrift {
        let drift = &self.drifts[coordinate];
        let [position, rate] = drift.until((steps - self.step) as f64);
        let joint = coordinate.checked_sub(1);
        let of_joint = |x: &[f64]| joint.and_then(|j| x.get(j)).copied().unwrap_or(0.0);
        let fastest = drift.fastest.max(of_joint(&self.watch.fastest));
        CoordinateDrift { position, rate, fastest, jumps: of_joint(&self.watch.jumps) }
    }

    fn advance(&mut self, step: usize) {
        let steps = (step - self.step) as f64;
        self.turn[1] = self.turn(step);
        for drift in &mut self.drifts {
            drift.sum = drift.until(steps);
        }
        self.step = step;
    }
}

impl<S: Scalar> Probe<S> {
    /// For a run of about `steps` steps.
    pub(super) fn new(state: &State<S>, steps: usize) -> Self {
        let drifts = vec![Drift::default(); state.v.len() - 5];
        let every = (steps / LEAST).clamp(1, EVERY);
        Self {
            whole: state.clone(),
            halved: state.clone(),
            every,
            found: Found { drifts, watch: Watch::new(state.v.len() - 6), ..Found::default() },
        }
    }

    /// Returns true if step `step` is probed.
    pub(super) fn is_due(&self, step: usize) -> bool {
        step.is_multiple_of(self.every) || self.every == EVERY && EARLY.contains(&step)
    }

    /// Probes the step number `step` over `interval`, if it is due; state and plant are left as they
    /// were, up to the rounding of the plant's velocities.
    pub(super) fn look(
        &mut self,
        step: usize,
        interval: (f64, f64),
        state: &State<S>,
        plant: &mut Plant<'_, S, impl World<S>>,
        stages: &mut Stages<S>,
    ) -> Result<(), SimulationError> {
        if !self.is_due(step) {
            return Ok(());
        }
        self.found.advance(step);
        let repeated = self.repeat(interval, state, plant, stages);
        if let Ok(changes) = repeated {
            self.compare(state, interval.1 - interval.0, changes, plant.model.mass());
        }
        self.halved.copy_from(state);
        plant.settle(&mut self.halved);
        plant.surround(interval.0, interval, &state.q)?;
        repeated.map(|_| ())
    }

    /// One step and two halved ones from `state`; returns the sum of all accelerations at its start.
    fn repeat(
        &mut self,
        interval: (f64, f64),
        state: &State<S>,
        plant: &mut Plant<'_, S, impl World<S>>,
        stages: &mut Stages<S>,
    ) -> Result<f64, SimulationError> {
        let middle = 0.5 * (interval.0 + interval.1);
        self.whole.copy_from(state);
        stages.step(plant, &mut self.whole, interval)?;
        let changes = stages.first_acceleration().iter().map(|x| x.value().abs()).sum();
        self.halved.copy_from(state);
        for half in [(interval.0, middle), (middle, interval.1)] {
            plant.settle(&mut self.halved);
            plant.surround(half.0, interval, &self.halved.q)?;
            stages.step(plant, &mut self.halved, half)?;
        }
        Ok(changes)
    }

    /// Takes down what the two ends differ by; `changes` is the sum of all accelerations.
    fn compare(&mut self, state: &State<S>, h: f64, changes: f64, mass: f64) {
        let Self { whole, halved, found, .. } = self;
        let [a, b] = [&*whole, &*halved].map(|state| Quat::from_xyzw(&state.q[3..7]));
        let rates: f64 = state.v[3..].iter().map(|x| x.value().abs()).sum();
        let forced = h * (changes + rates * rates);
        let beyond = |difference: f64, scale: f64| (difference - ROUNDING * f64::EPSILON * scale).max(0.0);
        found.turn[0] = beyond(log_so3(a.conjugate().product(b)).norm().value(), 1.0);
        let (origin, joints) = found.drifts.split_first_mut().expect("the base is there");
        let off = |a: Vec3<S>, b: Vec3<S>| (a - b).norm().value();
        let (p, p_halved) = (Vec3::from_slice(&whole.q), Vec3::from_slice(&halved.q));
        let speed = Vec3::from_slice(&state.v).norm().value();
        let (j, j_halved) = (whole.impulse.linear, halved.impulse.linear);
        origin.fastest = origin.fastest.max(speed);
        origin.last = [
            beyond(off(p, p_halved), p.norm().value() + h * (speed + forced)),
            beyond(off(j, j_halved), j.norm().value()) / mass,
        ];
        for (i, joint) in joints.iter_mut().enumerate() {
            let off = |a: S, b: S| (a - b).value().abs();
            let (q, v) = (whole.q[i + 7], whole.v[i + 6]);
            joint.fastest = joint.fastest.max(v.value().abs()).max(state.v[i + 6].value().abs());
            joint.last = [
                beyond(off(q, halved.q[i + 7]), q.value().abs() + h * (rates + forced)),
                beyond(off(v, halved.v[i + 6]), v.value().abs() + forced),
            ];
        }
    }
}
