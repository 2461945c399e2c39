//! Classical fourth-order Runge-Kutta method on SO(3) × ℝⁿ.

use super::stages::Stages;
use crate::simulation::equations::EquationsOfMotion;
use crate::simulation::error::SimulationError;
use crate::simulation::external_loads::ExternalLoads;
use crate::simulation::state::{Rate, State};
use crate::simulation::tree_state::{TreeRate, TreeState};
use crate::spatial::{Real, Vec3, dexp_inv};

/// Weights `b` of the four stages.
const WEIGHTS: [f64; 4] = [1.0 / 6.0, 1.0 / 3.0, 1.0 / 3.0, 1.0 / 6.0];

/// Nodes `c` of the second to fourth stages, as fractions of the step.
const NODES: [f64; 3] = [0.5, 0.5, 1.0];

/// Nyström weights `ā` of the position `p` of the base's origin at the stages:
/// `p_i = p₀ + c_i h ṗ₀ + h² Σ ā_ij p̈_j`, with the node `c_i` of stage `i` and the step length `h`.
///
/// The order conditions are satisfied up to order four: `Σ_j ā_ij = c_i²/2`, `Σ b_i ā_ij c_j = 1/24`. The
/// last stage is exact for an acceleration that is linear in time.
const NYSTROM: [[f64; 3]; 3] =
    [[0.125, 0.0, 0.0], [1.0 / 24.0, 1.0 / 12.0, 0.0], [1.0 / 6.0, 0.0, 1.0 / 3.0]];

/// Nyström weights at the end of the step: `p₁ = p₀ + h ṗ₀ + h² (p̈₁ + p̈₂ + p̈₃)/6`.
const NYSTROM_END: [f64; 3] = [1.0 / 6.0; 3];

/// Motion of the base of one tree over the stages of a step.
pub(super) struct BaseStages<S> {
    /// Velocity of the origin at the start of the step, W axes, m/s.
    velocity: Vec3<S>,
    /// Accelerations of the origin in the first three stages, W axes, m/s².
    accelerations: [Vec3<S>; 3],
    /// Rotation vector since the start of the step, base axes, rad.
    theta: Vec3<S>,
}

impl<S: Real> BaseStages<S> {
    pub(super) fn new() -> Self {
        Self { velocity: Vec3::zero(), accelerations: [Vec3::zero(); 3], theta: Vec3::zero() }
    }

    /// Stores the acceleration at the stage with this index, unless it is the last stage, and the velocity at
    /// the first stage. The accelerations of later stages have zero weight until they are stored, but must be
    /// finite.
    #[inline(always)]
    fn add_stage(&mut self, stage: usize, rate: &TreeRate<S>) {
        if stage == 0 {
            self.velocity = rate.base_velocity;
            self.accelerations = [rate.base_acceleration; 3];
        } else if let Some(acceleration) = self.accelerations.get_mut(stage) {
            *acceleration = rate.base_acceleration;
        }
    }
}

/// Computes a step: `y' = y ⊕ h (k₁ + 2 k₂ + 2 k₃ + k₄)/6`, with `k = dexp⁻¹(θ) ω` for the attitude, where
/// `ω` is the angular velocity of the base and `θ` its rotation vector since the start of the step. Requires
/// the first stage in `stages`.
///
/// The position of the base's origin is instead integrated from its acceleration with Nyström weights. This
/// reduces the position error far from the reference orbit, where differential gravity is strong.
pub(super) fn rk4<S: Real>(
    stages: &mut Stages<S>,
    bases: &mut [BaseStages<S>],
    equations: &mut EquationsOfMotion<'_, S, impl ExternalLoads<S>>,
    state: &mut State<S>,
    interval: (f64, f64),
) -> Result<(), SimulationError> {
    stages.sum.clear();
    for stage in 0..NODES.len() {
        evaluate_next(stage, stages, bases, equations, interval)?;
    }
    let Stages { start, trial, rate, sum, .. } = stages;
    add_stage(NODES.len(), bases, trial, rate, sum);
    move_states(bases, NYSTROM_END, (1.0, interval.1 - interval.0), (start, sum), state);
    Ok(())
}

/// Adds the time derivatives at the stage with this index to the weighted sum, and evaluates the next stage.
// Not inlined, like the functions below: the machine code of a step fits into the instruction cache only if
// the stages share it.
#[inline(never)]
fn evaluate_next<S: Real>(
    stage: usize,
    stages: &mut Stages<S>,
    bases: &mut [BaseStages<S>],
    equations: &mut EquationsOfMotion<'_, S, impl ExternalLoads<S>>,
    interval: (f64, f64),
) -> Result<(), SimulationError> {
    let Stages { start, trial, rate, sum, .. } = stages;
    let (c, t, h) = (NODES[stage], interval.0, interval.1 - interval.0);
    add_stage(stage, bases, trial, rate, sum);
    move_states(bases, NYSTROM[stage], (c, h), (start, rate), trial);
    let instant = if c == 1.0 { interval.1 } else { t + c * h };
    equations.evaluate(instant, interval, trial, rate)
}

/// Adds the time derivatives `rate` at the stage with this index, which was evaluated at `trial`, to the
/// weighted sum and to `bases`. The derivative of the rotation vector `θ` is `ω` at the first stage, where
/// `θ` is zero, and `dexp⁻¹(θ) ω` at the others.
#[inline(never)]
fn add_stage<S: Real>(
    stage: usize,
    bases: &mut [BaseStages<S>],
    trial: &State<S>,
    rate: &mut Rate<S>,
    sum: &mut Rate<S>,
) {
    S::enter(
        #[inline(always)]
        || {
            for (base, rate) in bases.iter_mut().zip(&rate.trees) {
                base.add_stage(stage, rate);
            }
            if stage > 0 {
                to_rotation_vector(bases, trial, rate);
            }
            sum.accumulate(rate, S::of(WEIGHTS[stage]));
        },
    );
}

/// Stores the states at the time `c h` after the start of the step of length `h`, s, for the constant time
/// derivatives `rate` in `to`. The position of each origin instead depends on its accelerations and on the
/// Nyström `weights`. Also stores the rotation vectors since the start of the step.
#[inline(never)]
fn move_states<S: Real>(
    bases: &mut [BaseStages<S>],
    weights: [f64; 3],
    (c, h): (f64, f64),
    (start, rate): (&State<S>, &Rate<S>),
    to: &mut State<S>,
) {
    let (h, h_squared) = (S::of(c * h), S::of(h * h));
    S::enter(
        #[inline(always)]
        || {
            to.move_from(start, rate, h);
            let trees = start.trees.iter().zip(&rate.trees).zip(&mut to.trees);
            for (base, ((start, rate), to)) in bases.iter_mut().zip(trees) {
                base.theta = rate.rotation_rate * h;
                move_origin(base, weights, h, h_squared, start, to);
            }
        },
    );
}

/// Writes the time derivatives of the rotation vectors `θ` at a stage, `dexp⁻¹(θ) ω`, to `rate`.
#[inline(always)]
fn to_rotation_vector<S: Real>(bases: &[BaseStages<S>], trial: &State<S>, rate: &mut Rate<S>) {
    for ((base, trial), rate) in bases.iter().zip(&trial.trees).zip(&mut rate.trees) {
        rate.rotation_rate = dexp_inv(base.theta, Vec3::from_slice(&trial.v[3..]));
    }
}

/// Writes the position of the base's origin, `p₀ + h ṗ₀ + h² Σ w p̈` with the `weights` `w`, to `to`. At a
/// stage, `h` is the time since the start of the step, but `h_squared` is the square of the whole step
/// length.
#[inline(always)]
fn move_origin<S: Real>(
    base: &BaseStages<S>,
    weights: [f64; 3],
    h: S,
    h_squared: S,
    start: &TreeState<S>,
    to: &mut TreeState<S>,
) {
    let mut sum = Vec3::zero();
    for (acceleration, weight) in base.accelerations.iter().zip(weights) {
        sum = acceleration.scale_add(S::of(weight), sum);
    }
    let straight = base.velocity.scale_add(h, Vec3::from_slice(&start.q));
    sum.scale_add(h_squared, straight).write(&mut to.q);
}
