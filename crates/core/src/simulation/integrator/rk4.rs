//! Classical fourth-order Runge-Kutta method on SO(3) × ℝⁿ.

use super::stages::Stages;
use crate::simulation::equations::EquationsOfMotion;
use crate::simulation::error::SimulationError;
use crate::simulation::external_loads::ExternalLoads;
use crate::simulation::state::{Rate, State};
use crate::simulation::tree_state::TreeState;
use crate::spatial::{Real, Vec3, dexp_inv};

/// Nodes `c`, as fractions of the step, and weights `b` of the second to fourth stages.
const STAGES: [(f64, f64); 3] = [(0.5, 1.0 / 3.0), (0.5, 1.0 / 3.0), (1.0, 1.0 / 6.0)];

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
    let Stages { start, trial, rate, sum, .. } = stages;
    let (t, h) = (interval.0, interval.1 - interval.0);
    sum.clear();
    S::enter(
        #[inline(always)]
        || sum.accumulate(rate, S::of(1.0 / 6.0)),
    );
    for (base, rate) in bases.iter_mut().zip(&rate.trees) {
        (base.velocity, base.accelerations) = (rate.base_velocity, [rate.base_acceleration; 3]);
    }
    for (stage, (c, b)) in STAGES.into_iter().enumerate() {
        S::enter(
            #[inline(always)]
            || {
                for (base, rate) in bases.iter_mut().zip(&rate.trees) {
                    base.accelerations[stage] = rate.base_acceleration;
                    base.theta = rate.rotation_rate * S::of(c * h);
                }
                trial.move_from(start, rate, S::of(c * h));
                move_origins(bases, NYSTROM[stage], S::of(c * h), S::of(h * h), start, trial);
            },
        );
        let instant = if c == 1.0 { interval.1 } else { t + c * h };
        equations.evaluate(instant, interval, trial, rate)?;
        S::enter(
            #[inline(always)]
            || {
                to_rotation_vector(bases, trial, rate);
                sum.accumulate(rate, S::of(b));
            },
        );
    }
    S::enter(
        #[inline(always)]
        || {
            state.move_from(start, sum, S::of(h));
            move_origins(bases, NYSTROM_END, S::of(h), S::of(h * h), start, state);
        },
    );
    Ok(())
}

/// Writes the time derivatives of the rotation vectors `θ` at a stage, `dexp⁻¹(θ) ω`, to `rate`.
#[inline(always)]
fn to_rotation_vector<S: Real>(bases: &[BaseStages<S>], trial: &State<S>, rate: &mut Rate<S>) {
    for ((base, trial), rate) in bases.iter().zip(&trial.trees).zip(&mut rate.trees) {
        rate.rotation_rate = dexp_inv(base.theta, Vec3::from_slice(&trial.v[3..]));
    }
}

/// Writes the positions of the origins of all bases to `to`; see [`move_origin`].
#[inline(always)]
fn move_origins<S: Real>(
    bases: &[BaseStages<S>],
    weights: [f64; 3],
    h: S,
    h_squared: S,
    start: &State<S>,
    to: &mut State<S>,
) {
    for ((base, start), to) in bases.iter().zip(&start.trees).zip(&mut to.trees) {
        move_origin(base, weights, h, h_squared, start, to);
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
