//! Embedded Runge-Kutta pair 5(4) of Dormand and Prince on SO(3) × ℝⁿ, with step-size control.

use super::settings::StepSettings;
use super::stages::{Stages, combine};
use super::tableau::{A, C, dense};
use super::tolerance::{LARGEST_ROTATION, StepControl, Tolerance};
use crate::dynamics::base_rotation;
use crate::model::BASE_NV;
use crate::simulation::equations::EquationsOfMotion;
use crate::simulation::error::SimulationError;
use crate::simulation::external_loads::ExternalLoads;
use crate::simulation::state::{Rate, State};
use crate::simulation::tree_state::TreeState;
use crate::spatial::{Real, Vec3, dexp_inv_exact};

/// Smallest and largest factor by which the step size may change between successive steps.
const CHANGE: (f64, f64) = (0.2, 5.0);

/// Fraction of the control period below which a step is short, and number of consecutive short steps after
/// which the run ends with an error. Without this limit, a run with unstable controllers, which accelerate
/// joints without bound, could take hours for each control period.
const SHORT: (f64, usize) = (1e-5, 1000);

/// Error of a step, relative to the tolerance, above which a short step counts as one that the tolerance
/// requires.
const LIMITING: f64 = 1e-2;

/// Method of Dormand and Prince: the stages of a step and the step-size control.
#[derive(Clone, Debug)]
pub(super) struct DormandPrince<S> {
    k: Vec<Rate<S>>,
    tolerance: Tolerance,
    pub(super) control: StepControl,
    /// Start and end of the last step, s.
    span: (f64, f64),
    /// Time between two updates of the controllers, s; zero without controllers.
    control_period: f64,
}

impl<S: Real> DormandPrince<S> {
    /// Creates the method for the settings of a run; `rate` has the dimensions of the rates of the run.
    pub(super) fn new(rate: &Rate<S>, settings: &StepSettings) -> Self {
        let StepSettings { tolerance, duration, control_period, .. } = *settings;
        let tolerance = Tolerance::new(tolerance, duration);
        let control = StepControl::new(rate.trees.len());
        Self { k: vec![rate.clone(); 7], tolerance, control, span: (0.0, 0.0), control_period }
    }

    /// Computes a step: `y' = y ⊕ h Σ b_i k_i` with the length `h`, the rates `k_i` at the stages and the
    /// weights `b_i`. The attitude is represented by the rotation vector `θ` since the start of the step,
    /// `θ̇ = dexp⁻¹(θ) ω`, with the angular velocity `ω` of the base. Requires the first stage in `stages`.
    pub(super) fn step(
        &mut self,
        stages: &mut Stages<S>,
        equations: &mut EquationsOfMotion<'_, S, impl ExternalLoads<S>>,
        state: &mut State<S>,
        interval: (f64, f64),
    ) -> Result<(), SimulationError> {
        let Stages { start, trial, rate, sum, .. } = stages;
        let (t, h) = (interval.0, interval.1 - interval.0);
        self.span = interval;
        self.k[0].copy_from(rate);
        for (i, (weights, c)) in A.iter().zip(C).enumerate() {
            let (known, next) = self.k.split_at_mut(i + 1);
            combine(sum, known, weights);
            S::enter(
                #[inline(always)]
                || trial.move_from(start, sum, S::of(h)),
            );
            let instant = if c == 1.0 { interval.1 } else { t + c * h };
            equations.evaluate(instant, interval, trial, &mut next[0])?;
            let parts = next[0].trees.iter_mut().zip(&sum.trees).zip(&trial.trees);
            for ((next, sum), trial) in parts {
                next.rotation_rate = S::enter(
                    #[inline(always)]
                    || dexp_inv_exact(sum.rotation_rate * S::of(h), Vec3::from_slice(&trial.v[3..])),
                );
            }
        }
        state.copy_from(trial); // the seventh stage was evaluated at the end of the step
        Ok(())
    }

    /// Computes a step from the start of `interval` to its end, or to an earlier time if the error would
    /// otherwise exceed the tolerance or a base would rotate too far. Returns the time reached, s. Requires
    /// the kinematics and loads of `state` in `equations`.
    ///
    /// Proportional-integral control: `h' = 0.9 h ε^−0.17 ε₋₁^0.04`, where `ε` and `ε₋₁` are the errors of
    /// this step and of the last accepted step, relative to the tolerance.
    ///
    /// Source: Hairer and Wanner, Solving Ordinary Differential Equations II, 1996, IV.2.
    pub(super) fn adaptive_step(
        &mut self,
        stages: &mut Stages<S>,
        equations: &mut EquationsOfMotion<'_, S, impl ExternalLoads<S>>,
        state: &mut State<S>,
        interval: (f64, f64),
    ) -> Result<f64, SimulationError> {
        let (start, whole) = (interval.0, interval.1 - interval.0);
        stages.evaluate_first(equations, state);
        let mut h = self.initial_step(stages, equations).min(longest_step(stages)).min(whole);
        let mut was_rejected = false;
        loop {
            // two equal steps avoid a very short last step
            let end = match whole - h {
                rest if rest <= 1e-9 * whole => interval.1,
                rest if rest < h => start + 0.5 * whole,
                _ => start + h,
            };
            h = end - start;
            let taken = self.step(stages, equations, state, (start, end));
            stages.finish(equations, state);
            let Self { k, tolerance, control, control_period, .. } = self;
            let error = match taken {
                Ok(()) => tolerance.error(stages, k, control, equations, h),
                Err(_) => f64::NAN,
            };
            if error <= 1.0 {
                let last = control.error.max(1e-4);
                let factor = 0.9 * error.max(1e-10).powf(-0.17) * last.powf(0.04);
                let most = if was_rejected { 1.0 } else { CHANGE.1 };
                control.step = h * factor.clamp(CHANGE.0, most);
                control.error = error;
                control.add_rotation_errors(&stages.sum, h);
                let is_short = error > LIMITING && h < SHORT.0 * *control_period;
                control.short_steps = if is_short { control.short_steps + 1 } else { 0 };
                if control.short_steps > SHORT.1 {
                    let period = *control_period;
                    return Err(SimulationError::StepsTooShort { time: start, step: h, period });
                }
                return Ok(end);
            }
            was_rejected = true;
            h *= if error.is_finite() { (0.9 * error.powf(-0.2)).max(CHANGE.0) } else { CHANGE.0 };
            if h <= 64.0 * f64::EPSILON * interval.1.abs() {
                // an error raised in the step is more specific than StepTooSmall
                return Err(taken.err().unwrap_or(SimulationError::StepTooSmall { time: start, step: h }));
            }
        }
    }

    /// Returns the first step size to try, s. It is the size that the step control proposed after the
    /// previous step or, in the first step, `ε^⅕ / (ω + √ω̇)` with the tolerance `ε`, the largest rate `ω`,
    /// rad/s, and the largest acceleration `ω̇`, rad/s².
    fn initial_step(
        &mut self,
        stages: &Stages<S>,
        equations: &EquationsOfMotion<'_, S, impl ExternalLoads<S>>,
    ) -> f64 {
        let Self { control, tolerance, .. } = self;
        control.measure_sizes(equations);
        if control.step > 0.0 {
            return control.step;
        }
        let start = tolerance.epsilon.powf(0.2);
        let parts = control.trees.iter().zip(&stages.start.trees).zip(&stages.rate.trees);
        let steps = parts.map(|((control, state), rate)| {
            start / (fastest(&state.v, control.size) + fastest(&rate.a, control.size).sqrt())
        });
        steps.fold(f64::INFINITY, f64::min)
    }

    /// Writes the state at `t`, s, within the last step to `state`, by dense output. The base twist is not
    /// projected onto the momentum.
    pub(super) fn interpolate(&self, stages: &mut Stages<S>, t: f64, state: &mut State<S>) {
        let Stages { start, sum, first, .. } = stages;
        let h = self.span.1 - self.span.0;
        combine(sum, &self.k, &dense((t - self.span.0) / h));
        state.move_from(start, sum, S::of(h));
        for ((state, start), first) in state.trees.iter_mut().zip(&start.trees).zip(first) {
            // velocity relative to W: v = v' + Rᵀ u
            let frame_velocity = base_rotation(&start.q) * first.frame_velocity_b;
            let velocity = Vec3::from_slice(&state.v) + base_rotation(&state.q).transpose_mul(frame_velocity);
            velocity.write(&mut state.v);
        }
    }
}

/// Returns the largest of the velocities `v` of base and joints in the first lane, rad/s, or, if `v` contains
/// accelerations, the largest acceleration, rad/s². The linear entries of the base are divided by the length
/// `size`, m; those of prismatic joints, in m/s or m/s², are treated as angular ones.
fn fastest<S: Real>(v: &[S], size: f64) -> f64 {
    let linear = Vec3::from_slice(v).norm().lane(0) / size;
    let angular = Vec3::from_slice(&v[3..]).norm().lane(0);
    v[BASE_NV..].iter().map(|x| x.lane(0).abs()).fold(linear.max(angular), f64::max)
}

/// Returns the longest step, s, during which no base rotates by more than [`LARGEST_ROTATION`] at its present
/// angular velocity.
fn longest_step<S: Real>(stages: &Stages<S>) -> f64 {
    let longest = |start: &TreeState<S>| LARGEST_ROTATION / Vec3::from_slice(&start.v[3..]).norm().lane(0);
    stages.start.trees.iter().map(longest).fold(f64::INFINITY, f64::min)
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)] // a test that cannot set up should stop

    use super::{DormandPrince, Stages, StepSettings};
    use crate::model::{Model, difference, neutral};
    use crate::simulation::equations::EquationsOfMotion;
    use crate::simulation::external_loads::NoLoads;
    use crate::simulation::integrator::Integrator;
    use crate::simulation::only::only;
    use crate::simulation::state::State;
    use crate::simulation::tree::Tree;
    use nalgebra::{Matrix3, Vector3};
    use std::borrow::Cow;

    /// Returns the configuration of a tumbling spacecraft after 8 s; `weight` is the weight of attitude and
    /// angular rate in the error norm.
    fn tumble(tolerance: f64, weight: f64) -> Vec<f64> {
        let inertia = Matrix3::from_diagonal(&Vector3::new(1.0, 2.0, 2.5));
        let model = Model::rigid_body(10.0, inertia).unwrap();
        let mut equations =
            EquationsOfMotion::<f64, _>::new(vec![Tree::new(Cow::Borrowed(&model), None)], NoLoads);
        let v = vec![0.1, 0.0, -0.2, 0.7, 0.9, -0.4];
        let mut state = State::at(&mut equations.trees, [(neutral(&model), v)]);
        let mut stages = Stages::new(&state);
        let settings = StepSettings {
            integrator: Integrator::DormandPrince,
            tolerance,
            time_step: 8.0,
            control_period: 0.0,
            duration: 8.0,
        };
        let mut method = DormandPrince::new(&stages.rate, &settings);
        method.tolerance.attitude_weight = weight;
        let mut t = 0.0;
        while t < 8.0 {
            equations.project_momentum(&mut state);
            t = method.adaptive_step(&mut stages, &mut equations, &mut state, (t, 8.0)).unwrap();
        }
        only(&state.trees).q.clone()
    }

    /// Negative control: the errors of positions and joints alone do not reveal the error of a rotation.
    #[test]
    fn without_the_attitude_in_its_error_the_tolerance_is_missed() {
        let exact = tumble(1e-12, 1.0);
        for tolerance in [1e-5, 1e-8] {
            let off = [1.0, 0.0].map(|weight| {
                let mut delta = vec![0.0; 6];
                difference(&exact, &tumble(tolerance, weight), &mut delta);
                Vector3::from_column_slice(&delta[3..]).norm()
            });
            assert!(off[0] < 10.0 * tolerance && off[1] > 100.0 * tolerance, "{off:?}");
        }
    }
}
