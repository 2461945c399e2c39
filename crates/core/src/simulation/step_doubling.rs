//! Step doubling, which estimates the errors of the attitude, the base's origin and the joints from the
//! differences between a step and two half steps.

use super::acceleration_jumps::AccelerationJumps;
use super::equations::EquationsOfMotion;
use super::error::SimulationError;
use super::external_loads::ExternalLoads;
use super::integrator::Integration;
use super::rounding_errors::RoundingErrors;
use super::state::State;
use super::trace::CoordinateDrift;
use super::tree::Tree;
use super::tree_state::TreeState;
use crate::dynamics::Data;
use crate::model::{BASE_NQ, BASE_NV, QUATERNION};
use crate::spatial::{Quat, Scalar, Vec3, log_so3};
use serde::{Deserialize, Serialize};

/// Largest number of steps from one probe to the next. A probe computes three steps, so probes increase the
/// cost of a run by about one percent.
const EVERY: usize = 256;
/// Smallest number of probes of a run, unless the run has fewer steps.
const LEAST: usize = 5;
/// Indices of additional steps that are probed early in a long run, when transients occur.
const EARLY: [usize; 3] = [4, 16, 64];
/// Largest difference of two values that is treated as a rounding error, in units of the machine epsilon
/// times their magnitude.
const ROUNDING: f64 = 16.0;
/// Largest difference that is treated as a rounding error of the contact forces, in units of their measured
/// standard deviation.
const DEVIATIONS: f64 = 4.0;

/// Step doubling of a run: some steps are repeated as two half steps, and the differences between the
/// resulting states are summed.
///
/// A local error of order `p + 1` is smaller by a factor of `2^p` after two half steps. For the fourth-order
/// Runge-Kutta method, the difference therefore equals the local error up to a sixteenth of that error. The
/// sum bounds the error of a run unless the motion amplifies errors, as chaotic motion does.
///
/// The sum contains no rounding errors. Those of contact forces are not negligible ([`RoundingErrors`]), and
/// no shorter step reduces their sum of magnitudes. Their signs are random, so that the rates change by the
/// root of the sum of their squares.
pub(super) struct StepDoubling<S> {
    whole: State<S>,
    halved: State<S>,
    /// Kinematics and loads of each tree at the start of the step.
    start: Vec<Data<S>>,
    /// Number of steps from one probe to the next.
    every: usize,
    /// Sum of the magnitudes of all accelerations of each tree at the start of the step, rad/s² or m/s².
    changes: Vec<f64>,
    rounding: RoundingErrors<S>,
    /// Errors of each tree.
    pub(super) errors: Vec<Errors>,
}

/// Errors of one tree, measured by the probes.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub(super) struct Errors {
    /// Index of the step of the last probe.
    pub(super) step: usize,
    /// Attitude difference at the last probe, and the sum of such differences over the steps before the
    /// probe, rad.
    turn: [f64; 2],
    /// Differences for the base's origin, then for every joint.
    pub(super) drifts: Vec<Drift>,
    /// Jumps of the joint accelerations, measured at every step.
    pub(super) jumps: AccelerationJumps,
}

/// Differences of a coordinate between a step and two half steps; each pair consists of the position and the
/// rate.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub(super) struct Drift {
    /// Differences at the last probe, m and m/s or rad and rad/s.
    last: [f64; 2],
    /// Sums of the differences over the steps before the last probe, m and m/s or rad and rad/s.
    sum: [f64; 2],
    /// Standard deviation of the rounding error of the rate in a step at the last probe, m/s or rad/s, and
    /// the sum of its squares over the steps before the last probe.
    #[serde(default)]
    rounding: [f64; 2],
    /// Largest magnitude of the rate at any probe, m/s or rad/s.
    fastest: f64,
}

impl Drift {
    /// Returns the sums `sum` after `steps` more steps.
    fn until(&self, steps: f64) -> [f64; 2] {
        [0, 1].map(|i| self.sum[i] + self.last[i] * steps)
    }

    /// Returns the sum of the squares of the rounding errors after `steps` more steps.
    fn rounding_until(&self, steps: f64) -> f64 {
        self.rounding[1] + self.rounding[0] * self.rounding[0] * steps
    }
}

impl Errors {
    /// Returns the sum of the attitude differences over the first `steps` steps, rad.
    pub(super) fn turn(&self, steps: usize) -> f64 {
        self.turn[1] + self.turn[0] * (steps - self.step) as f64
    }

    /// Returns the summed differences of a coordinate over the first `steps` steps. Coordinate 0 is the
    /// base's origin; coordinate `j + 1` is joint `j`.
    pub(super) fn drift(&self, coordinate: usize, steps: usize) -> CoordinateDrift {
        let drift = &self.drifts[coordinate];
        let more = (steps - self.step) as f64;
        let [position, rate] = drift.until(more);
        let rate = rate + drift.rounding_until(more).sqrt();
        let joint = coordinate.checked_sub(1);
        let of_joint = |x: &[f64]| joint.and_then(|j| x.get(j)).copied().unwrap_or(0.0);
        let fastest = drift.fastest.max(of_joint(&self.jumps.fastest));
        CoordinateDrift { position, rate, fastest, jumps: of_joint(&self.jumps.jumps) }
    }

    /// Creates the errors, all zero, of a tree with `joints` joints before the first probe.
    fn new(joints: usize) -> Self {
        let drifts = vec![Drift::default(); joints + 1];
        Self { drifts, jumps: AccelerationJumps::new(joints), ..Self::default() }
    }

    fn advance(&mut self, step: usize) {
        let steps = (step - self.step) as f64;
        self.turn[1] = self.turn(step);
        for drift in &mut self.drifts {
            (drift.sum, drift.rounding[1]) = (drift.until(steps), drift.rounding_until(steps));
        }
        self.step = step;
    }
}

impl<S: Scalar> StepDoubling<S> {
    /// Creates the step doubling of a run before its first step. `steps` is the planned number of steps;
    /// `None` for an open-ended run.
    pub(super) fn new(trees: &[Tree<'_, S>], state: &State<S>, steps: Option<usize>) -> Self {
        let every = steps.map_or(EVERY, |steps| (steps / LEAST).clamp(1, EVERY));
        Self {
            whole: state.clone(),
            halved: state.clone(),
            start: trees.iter().map(|tree| Data::new(&tree.model)).collect(),
            every,
            changes: vec![0.0; trees.len()],
            rounding: RoundingErrors::new(state),
            errors: trees.iter().map(|tree| Errors::new(tree.model.joint_count())).collect(),
        }
    }

    /// Returns true if the step with index `step` is probed.
    pub(super) fn is_due(&self, step: usize) -> bool {
        step.is_multiple_of(self.every) || self.every == EVERY && EARLY.contains(&step)
    }

    /// Probes the step with index `step` over `interval`, s. The kinematics and loads in
    /// `equations` are restored bit by bit.
    #[inline(never)]
    pub(super) fn probe(
        &mut self,
        step: usize,
        interval: (f64, f64),
        state: &State<S>,
        equations: &mut EquationsOfMotion<'_, S, impl ExternalLoads<S>>,
        integration: &mut Integration<S>,
    ) -> Result<(), SimulationError> {
        self.errors.iter_mut().for_each(|errors| errors.advance(step));
        for (start, tree) in self.start.iter_mut().zip(&equations.trees) {
            start.copy_from(&tree.data);
        }
        let loadings = equations.contacts.loadings();
        let repeated = self.repeat(interval, state, equations, integration);
        equations.restore(&self.start);
        equations.contacts.set_loadings(loadings);
        repeated?;
        self.compare(state, interval.1 - interval.0, equations);
        Ok(())
    }

    /// Computes one whole step over `interval`, s, and two half steps from `state`, and stores the sums of
    /// the magnitudes of the accelerations at the start, and the rounding errors of the accelerations.
    fn repeat(
        &mut self,
        interval: (f64, f64),
        state: &State<S>,
        equations: &mut EquationsOfMotion<'_, S, impl ExternalLoads<S>>,
        integration: &mut Integration<S>,
    ) -> Result<(), SimulationError> {
        let middle = 0.5 * (interval.0 + interval.1);
        self.whole.copy_from(state);
        integration.step(equations, &mut self.whole, interval)?;
        for (changes, first) in self.changes.iter_mut().zip(&integration.stages.first) {
            *changes = first.acceleration.iter().map(|x| x.value().abs()).sum();
        }
        self.rounding.measure(interval, state, equations, integration)?;
        self.halved.copy_from(state);
        for half in [(interval.0, middle), (middle, interval.1)] {
            equations.project_momentum(&mut self.halved);
            equations.apply_loads(half.0, interval, &self.halved)?;
            integration.step(equations, &mut self.halved, half)?;
        }
        Ok(())
    }

    /// Stores the differences between the two results of a step of length `h`, s, from `state` for every
    /// tree.
    fn compare<W>(&mut self, state: &State<S>, h: f64, equations: &EquationsOfMotion<'_, S, W>) {
        for (number, (errors, tree)) in self.errors.iter_mut().zip(&equations.trees).enumerate() {
            let [start, whole, halved] = [state, &self.whole, &self.halved].map(|state| &state.trees[number]);
            let scales = (self.changes[number], self.rounding.of(number));
            errors.compare(start, [whole, halved], h, scales, tree.model.mass());
        }
    }
}

impl Errors {
    /// Stores the differences between the states after one step of length `h`, s, from `start` and after two
    /// half steps. `changes` is the sum of the magnitudes of all accelerations, rad/s² or m/s²; `rounding`
    /// has the rounding errors of the accelerations ([`RoundingErrors::of`]), and `mass` is the mass of the
    /// tree, kg.
    fn compare<S: Scalar>(
        &mut self,
        start: &TreeState<S>,
        [whole, halved]: [&TreeState<S>; 2],
        h: f64,
        (changes, rounding): (f64, &[f64]),
        mass: f64,
    ) {
        let [a, b] = [whole, halved].map(|state| Quat::from_xyzw(&state.q[QUATERNION]));
        let rates: f64 = start.v[3..].iter().map(|x| x.value().abs()).sum();
        let forced = h * (changes + rates * rates);
        let beyond = |difference: f64, scale: f64| (difference - ROUNDING * f64::EPSILON * scale).max(0.0);
        for (drift, acceleration) in self.drifts.iter_mut().zip(rounding) {
            drift.rounding[0] = h * acceleration;
        }
        self.turn[0] = beyond(log_so3(a.conjugate().product(b)).norm().value(), 1.0);
        let (origin, joints) = self.drifts.split_first_mut().expect("the base has an entry");
        let off = |a: Vec3<S>, b: Vec3<S>| (a - b).norm().value();
        let (p, p_halved) = (Vec3::from_slice(&whole.q), Vec3::from_slice(&halved.q));
        let speed = Vec3::from_slice(&start.v).norm().value();
        let (j, j_halved) = (whole.impulse.linear, halved.impulse.linear);
        origin.fastest = origin.fastest.max(speed);
        let random = DEVIATIONS * origin.rounding[0];
        origin.last = [
            beyond(off(p, p_halved), p.norm().value() + h * (speed + forced)),
            (beyond(off(j, j_halved), j.norm().value()) / mass - random).max(0.0),
        ];
        for (i, joint) in joints.iter_mut().enumerate() {
            let off = |a: S, b: S| (a - b).value().abs();
            let (q, v) = (whole.q[BASE_NQ + i], whole.v[BASE_NV + i]);
            joint.fastest = joint.fastest.max(v.value().abs()).max(start.v[BASE_NV + i].value().abs());
            let random = DEVIATIONS * joint.rounding[0];
            joint.last = [
                beyond(off(q, halved.q[BASE_NQ + i]), q.value().abs() + h * (rates + forced)),
                (beyond(off(v, halved.v[BASE_NV + i]), v.value().abs() + forced) - random).max(0.0),
            ];
        }
    }
}
