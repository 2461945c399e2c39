//! Computation of the error of a step of the embedded pair relative to the tolerance.

use super::stages::{Stages, combine};
use super::tableau::E;
use crate::dynamics::composite_momentum;
use crate::model::{Axis, BASE_NV};
use crate::simulation::equations::EquationsOfMotion;
use crate::simulation::external_loads::ExternalLoads;
use crate::simulation::state::Rate;
use crate::simulation::tree::Tree;
use crate::simulation::tree_state::{TreeRate, TreeState};
use crate::spatial::{Real, Vec3};
use serde::{Deserialize, Serialize};

/// Largest rotation of a base in a step, rad; the rotation vector must remain well below a full turn.
pub(super) const LARGEST_ROTATION: f64 = 2.0;

/// Fraction of the largest rate of the run that is added to the scale of rate errors.
const SLOW: f64 = 1e-3;

/// State of the step-size control, from which a run can resume with bit-identical results.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub(crate) struct StepControl {
    /// Size of the next step to try, s; zero before the first step.
    pub(crate) step: f64,
    /// Error of the last accepted step, relative to the tolerance.
    pub(crate) error: f64,
    /// Number of consecutive steps that the tolerance made much shorter than the control period.
    pub(crate) short_steps: usize,
    /// Scales and errors of each tree.
    pub(crate) trees: Vec<TreeControl>,
}

/// Scales relative to which the errors of a tree are measured, and the errors of its attitude.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub(crate) struct TreeControl {
    /// Largest rate, rad/s, and largest speed, m/s, in the run so far.
    pub(crate) fastest: [f64; 2],
    /// Sum of the estimated attitude errors of all steps, rad.
    pub(crate) rotation_error: f64,
    /// Radius of gyration of the tree at the start of its first step, m, used as the scale of lengths.
    pub(crate) size: f64,
}

impl StepControl {
    /// Creates the step-size control of `trees` trees before the first step.
    pub(super) fn new(trees: usize) -> Self {
        Self { step: 0.0, error: 0.0, short_steps: 0, trees: vec![TreeControl::default(); trees] }
    }

    /// Computes the sizes of those trees whose size is still zero. Requires the kinematics of the current
    /// state in `equations`.
    pub(super) fn measure_sizes<S: Real>(
        &mut self,
        equations: &EquationsOfMotion<'_, S, impl ExternalLoads<S>>,
    ) {
        for (control, tree) in self.trees.iter_mut().zip(&equations.trees) {
            if control.size == 0.0 {
                let inertia = composite_momentum(&tree.data).0;
                let about = inertia.about_com();
                let trace = (about.xx + about.yy + about.zz).lane(0);
                control.size = (trace / (2.0 * inertia.mass.lane(0))).sqrt();
            }
        }
    }

    /// Adds the attitude errors of a step of length `h`, s; `errors` holds the differences between the rates
    /// of the fifth-order and of the fourth-order solution.
    pub(super) fn add_rotation_errors<S: Real>(&mut self, errors: &Rate<S>, h: f64) {
        for (control, error) in self.trees.iter_mut().zip(&errors.trees) {
            control.rotation_error += h * norm(error.rotation_rate);
        }
    }
}

/// Tolerance of a run, with which the error of a step is compared.
#[derive(Clone, Debug)]
pub(super) struct Tolerance {
    /// Relative tolerance `ε`.
    pub(super) epsilon: f64,
    /// Duration of the run, or the longest interval of an open-ended run, s.
    horizon: f64,
    /// Weight of the errors of attitude and angular velocity: 1, except in a test, which sets it to 0.
    pub(super) attitude_weight: f64,
}

impl Tolerance {
    pub(super) fn new(epsilon: f64, horizon: f64) -> Self {
        Self { epsilon, horizon, attitude_weight: 1.0 }
    }

    /// Returns the largest error of any tree in the last step of length `h`, s, relative to the tolerance;
    /// NaN if the step must be rejected because it is not finite or rotates a base too far.
    ///
    /// The tolerance is `ε` times a scale. For the attitude and revolute joints, the scale is 1 rad; for
    /// prismatic joints, the radius of gyration of the tree; for the position of the base, that radius or, if
    /// larger, the distance from the origin of W; for rates, the magnitude of the rates plus a thousandth of
    /// the largest rate so far.
    pub(super) fn error<S: Real>(
        &self,
        stages: &mut Stages<S>,
        k: &[Rate<S>],
        control: &mut StepControl,
        equations: &EquationsOfMotion<'_, S, impl ExternalLoads<S>>,
        h: f64,
    ) -> f64 {
        combine(&mut stages.sum, k, &E);
        let (mut largest, mut is_folded) = (0.0, false);
        for (number, (tree, control)) in equations.trees.iter().zip(&control.trees).enumerate() {
            let step = SystemStep::new(stages, number, tree, control, h);
            largest = larger(largest, self.system_error(&step));
            let last = &k[6].trees[number];
            is_folded |=
                vector(&step.trial.q[3..]).is_nan() || h * norm(last.rotation_rate) > 2.0 * LARGEST_ROTATION;
        }
        if largest <= 1.0 {
            for (number, (tree, control)) in equations.trees.iter().zip(&mut control.trees).enumerate() {
                // rejected steps do not change the scales
                control.fastest = SystemStep::new(stages, number, tree, control, h).fastest;
            }
        }
        if is_folded { f64::NAN } else { largest }
    }

    /// Returns the error of one tree in a step, relative to the tolerance.
    fn system_error<S: Real>(&self, step: &SystemStep<'_, '_, S>) -> f64 {
        let SystemStep { start, trial, sum, size, spin, speed, h, fastest: [fastest, highest], .. } = *step;
        // rounding errors of a robot at rest must not stop the run, so a drift of ε/1000 by the end of the
        // run is accepted
        let slow = SLOW * fastest.max(vector(&trial.v) / size).max(1.0 / self.horizon);
        let crawl = SLOW * highest.max(size / self.horizon);

        let relative =
            |error: f64, scale: f64| if error == 0.0 { 0.0 } else { error / (self.epsilon * scale) };
        let weight = self.attitude_weight;
        let mut largest = [
            weight * relative(h * norm(sum.rotation_rate), 1.0),
            relative(h * norm(sum.base_velocity), size.max(vector(&start.q))),
            weight * relative(h * vector(&sum.a[3..]), spin + slow),
            relative(h * vector(&sum.a), speed + size * spin + crawl),
        ]
        .into_iter()
        .fold(0.0, larger);
        for j in 0..start.v.len() - BASE_NV {
            let scale = if step.is_prismatic(j) { size } else { 1.0 };
            largest = larger(largest, relative(h * sum.joint_rates[j].lane(0).abs(), scale));
            let error = h * sum.a[BASE_NV + j].lane(0).abs();
            largest = larger(largest, relative(error, step.rate(j) + slow * scale));
        }
        largest
    }
}

/// Step of one tree for which the error is computed.
struct SystemStep<'a, 's, S> {
    tree: &'a Tree<'s, S>,
    start: &'a TreeState<S>,
    trial: &'a TreeState<S>,
    /// Error estimate per unit time: mean rates of the fifth-order solution less those of the fourth-order
    /// solution.
    sum: &'a TreeRate<S>,
    h: f64,
    size: f64,
    /// Angular velocity of the base, rad/s: the larger of the values at both ends of the step.
    spin: f64,
    /// Scale of the speed of the base, m/s: its speed at the start of the step or, if larger, the magnitude
    /// of its velocity at the end of the step relative to the moving frame of the step.
    speed: f64,
    /// Largest rate, rad/s, and largest speed, m/s, so far, including this step.
    fastest: [f64; 2],
}

impl<'a, 's, S: Real> SystemStep<'a, 's, S> {
    fn new(
        stages: &'a Stages<S>,
        number: usize,
        tree: &'a Tree<'s, S>,
        control: &TreeControl,
        h: f64,
    ) -> Self {
        let (start, trial) = (&stages.start.trees[number], &stages.trial.trees[number]);
        let (sum, size) = (&stages.sum.trees[number], control.size);
        let spin = vector(&start.v[3..]).max(vector(&trial.v[3..]));
        let speed = norm(tree.frame_velocity()).max(vector(&trial.v));
        let mut step = Self { tree, start, trial, sum, h, size, spin, speed, fastest: control.fastest };
        let [fastest, highest] = control.fastest;
        let angular = |j: usize| if step.is_prismatic(j) { step.rate(j) / size } else { step.rate(j) };
        let fastest = (0..start.v.len() - BASE_NV).map(angular).fold(fastest.max(spin), f64::max);
        step.fastest = [fastest, highest.max(speed).max(size * fastest)];
        step
    }

    fn is_prismatic(&self, j: usize) -> bool {
        self.tree.model.nodes()[j + 1].axis == Axis::Prismatic
    }

    /// Returns the magnitude of the rate of joint `j`, rad/s or m/s: the larger of the values at both ends of
    /// the step.
    fn rate(&self, j: usize) -> f64 {
        let rate = |state: &TreeState<S>| state.v[BASE_NV + j].lane(0).abs();
        rate(self.start).max(rate(self.trial))
    }
}

/// Returns the norm of a vector in the first lane.
fn norm<S: Real>(v: Vec3<S>) -> f64 {
    v.norm().lane(0)
}

/// Returns the norm of the first three entries, in the first lane.
fn vector<S: Real>(x: &[S]) -> f64 {
    norm(Vec3::from_slice(x))
}

/// Returns the larger of two numbers, or NaN if either is NaN.
fn larger(a: f64, b: f64) -> f64 {
    if b > a || b.is_nan() { b } else { a }
}
