//! Steps of Dormand and Prince on the group, as long as the tolerance lets them be.

use super::error::SimulationError;
use super::integrator::Stages;
use super::plant::{Plant, World};
use super::state::{Rate, State};
use super::stepping::Stepping;
use super::tableau::{A, C, dense};
use crate::dynamics::{base_rotation, composite_momentum};
use crate::spatial::{Real, Vec3, dexp_inv_exact};
use serde::{Deserialize, Serialize};

/// Largest turn of the base in a step, rad: its rotation vector must stay short of a whole turn.
pub(super) const LARGEST_TURN: f64 = 2.0;
/// What the step may change by at once.
const CHANGE: (f64, f64) = (0.2, 5.0);

/// What the step control remembers, all of it: a run goes on from here with the same bits.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub(crate) struct Memory {
    /// Step to try next, s; zero before the first.
    pub(super) step: f64,
    /// Error of the last step that was taken, as a share of what is allowed.
    pub(super) error: f64,
    /// Fastest rate so far, rad/s, and speed, m/s.
    pub(super) fastest: [f64; 2],
    /// Sum of the estimated errors of the attitude, rad.
    pub(super) turn: f64,
    /// Radius of gyration of the robot at the start of the run, m: the scale of lengths.
    pub(super) size: f64,
}

/// The later stages of a step, and its control.
#[derive(Clone, Debug)]
pub(super) struct Pair<S> {
    pub(super) k: Vec<Rate<S>>,
    pub(super) tolerance: f64,
    /// Duration of the run, s.
    pub(super) horizon: f64,
    pub(super) memory: Memory,
    /// The interval of the last step.
    span: (f64, f64),
    /// Weight of the attitude in the error; tests take it away.
    pub(super) attitude: f64,
}

impl<S: Real> Pair<S> {
    pub(super) fn new(rate: &Rate<S>, how: &Stepping) -> Self {
        let Stepping { tolerance, duration: horizon, .. } = *how;
        let (k, memory) = (vec![rate.clone(); 7], Memory::default());
        Self { k, tolerance, horizon, memory, span: (0.0, 0.0), attitude: 1.0 }
    }
}

impl<S: Real> Stages<S> {
    /// `y' = y ⊕ h Σ b_i k_i` with the attitude as the rotation vector since the start of the step,
    /// whose rate is `dexp⁻¹(θ) ω`. Expects the first stage in `rate`.
    pub(super) fn dormand_prince(
        &mut self,
        plant: &mut Plant<'_, S, impl World<S>>,
        state: &mut State<S>,
        interval: (f64, f64),
    ) -> Result<(), SimulationError> {
        let Self { start, trial, rate, sum, pair, .. } = self;
        let Some(pair) = pair else { return Ok(()) };
        let (t, h) = (interval.0, interval.1 - interval.0);
        pair.span = interval;
        pair.k[0].copy_from(rate);
        for (i, (weights, c)) in A.iter().zip(C).enumerate() {
            let (known, next) = pair.k.split_at_mut(i + 1);
            combine(sum, known, weights);
            let turned = sum.turn * S::of(h);
            S::enter(
                #[inline(always)]
                || trial.move_from(start, sum, S::of(h)),
            );
            let instant = if c == 1.0 { interval.1 } else { t + c * h };
            plant.evaluate(instant, interval, trial, &mut next[0])?;
            next[0].turn = S::enter(
                #[inline(always)]
                || dexp_inv_exact(turned, Vec3::from_slice(&trial.v[3..])),
            );
        }
        state.copy_from(trial); // the seventh stage stands at the end
        Ok(())
    }

    /// A step from the start of `interval`, at most to its end, that keeps the tolerance; returns where
    /// it ended. Expects what [`Stages::step`] expects.
    ///
    /// Proportional-integral control: `h' = 0.9 h ε^−0.17 ε₋₁^0.04` (Hairer and Wanner, IV.2).
    pub(super) fn adapt(
        &mut self,
        plant: &mut Plant<'_, S, impl World<S>>,
        state: &mut State<S>,
        interval: (f64, f64),
    ) -> Result<f64, SimulationError> {
        let (start, whole) = (interval.0, interval.1 - interval.0);
        self.accelerate(plant, state);
        let mut h = self.first_try(plant).min(self.longest()).min(whole);
        let mut was_rejected = false;
        loop {
            // no sliver at the end: two halves rather
            let end = match whole - h {
                rest if rest <= 1e-9 * whole => interval.1,
                rest if rest < h => start + 0.5 * whole,
                _ => start + h,
            };
            h = end - start;
            let taken = self.dormand_prince(plant, state, (start, end));
            Self::leave(plant, state);
            let (error, turn) = if taken.is_ok() { self.error(plant, h) } else { (f64::NAN, 0.0) };
            let Some(pair) = &mut self.pair else { return Ok(end) };
            if error <= 1.0 {
                let memory = &mut pair.memory;
                let last = memory.error.max(1e-4);
                let factor = 0.9 * error.max(1e-10).powf(-0.17) * last.powf(0.04);
                let most = if was_rejected { 1.0 } else { CHANGE.1 };
                memory.step = h * factor.clamp(CHANGE.0, most);
                memory.error = error;
                memory.turn += turn;
                return Ok(end);
            }
            was_rejected = true;
            h *= if error.is_finite() { (0.9 * error.powf(-0.2)).max(CHANGE.0) } else { CHANGE.0 };
            if h <= 64.0 * f64::EPSILON * interval.1.abs() {
                // what refused the state says so; else nothing is short enough
                return Err(taken.err().unwrap_or(SimulationError::StepTooSmall { time: start, step: h }));
            }
        }
    }

    /// The step to try: what the last one left, or `ε^⅕ / (ω + √ω̇)`.
    fn first_try(&mut self, plant: &Plant<'_, S, impl World<S>>) -> f64 {
        let (rate, start) = (&self.rate, &self.start);
        let Some(pair) = &mut self.pair else { return f64::INFINITY };
        if pair.memory.size == 0.0 {
            let inertia = composite_momentum(&plant.data).0;
            let about = inertia.about_com();
            let trace = (about.xx + about.yy + about.zz).lane(0);
            pair.memory.size = (trace / (2.0 * inertia.mass.lane(0))).sqrt();
        }
        if pair.memory.step > 0.0 {
            return pair.memory.step;
        }
        let fastest = |v: &[S]| {
            let linear = Vec3::from_slice(v).norm().lane(0) / pair.memory.size;
            let angular = Vec3::from_slice(&v[3..]).norm().lane(0);
            v[6..].iter().map(|x| x.lane(0).abs()).fold(linear.max(angular), f64::max)
        };
        pair.tolerance.powf(0.2) / (fastest(&start.v) + fastest(&rate.a).sqrt())
    }

    /// The longest step that the attitude's chart takes.
    fn longest(&self) -> f64 {
        LARGEST_TURN / Vec3::from_slice(&self.start.v[3..]).norm().lane(0)
    }

    /// The state at `t` within the last step, momentum not yet put right.
    pub(super) fn interpolate(&mut self, t: f64, state: &mut State<S>) {
        let Self { start, sum, pair, passing, .. } = self;
        let Some(pair) = pair else { return };
        let h = pair.span.1 - pair.span.0;
        combine(sum, &pair.k, &dense((t - pair.span.0) / h));
        state.move_from(start, sum, S::of(h));
        // back to W: v = v' + Rᵀ u
        let carried = base_rotation(&start.q) * *passing;
        (Vec3::from_slice(&state.v) + base_rotation(&state.q).transpose_mul(carried)).write(&mut state.v);
    }
}

/// `Σ w_i k_i`.
pub(super) fn combine<S: Real>(sum: &mut Rate<S>, stages: &[Rate<S>], weights: &[f64]) {
    sum.clear();
    for (k, &weight) in stages.iter().zip(weights).filter(|(_, weight)| **weight != 0.0) {
        S::enter(
            #[inline(always)]
            || sum.accumulate(k, S::of(weight)),
        );
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)] // a test that cannot set up should stop

    use super::super::integrator::{Integrator, Stages};
    use super::super::plant::{Nothing, Plant};
    use super::super::state::State;
    use super::super::stepping::Stepping;
    use crate::model::{Model, difference, neutral};
    use nalgebra::{Matrix3, Vector3};

    /// Attitude of a tumbling spacecraft after 8 s, the attitude and its rate weighed in the error or not.
    fn tumble(tolerance: f64, weight: f64) -> Vec<f64> {
        let inertia = Matrix3::from_diagonal(&Vector3::new(1.0, 2.0, 2.5));
        let model = Model::rigid_body(10.0, inertia).unwrap();
        let mut plant = Plant::<f64, _>::new(&model, Nothing, None);
        let v = vec![0.1, 0.0, -0.2, 0.7, 0.9, -0.4];
        let mut state = State::at(&model, &mut plant.data, neutral(&model), v);
        let integrator = Integrator::DormandPrince;
        let how = Stepping { integrator, tolerance, time_step: 1.0, duration: 8.0 };
        let mut stages = Stages::new(&model, &state, &how);
        stages.pair.as_mut().unwrap().attitude = weight;
        let mut t = 0.0;
        while t < 8.0 {
            plant.settle(&mut state);
            t = stages.advance(&mut plant, &mut state, (t, 8.0)).unwrap();
        }
        state.q
    }

    /// Negative control: positions and joints alone do not see a spacecraft turn.
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
