//! One step: Runge-Kutta on the group, or semi-implicit Euler.

use super::error::SimulationError;
use super::pair::Pair;
use super::plant::{Plant, World};
use super::state::{Rate, State};
use super::stepping::Stepping;
use crate::dynamics::base_rotation;
use crate::model::{Model, integrate};
use crate::spatial::{Real, Vec3, dexp_inv};

/// How a run steps.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Integrator {
    /// Classical fourth-order Runge-Kutta, the attitude on its group (Runge-Kutta-Munthe-Kaas).
    #[default]
    Rk4,
    /// Semi-implicit Euler, first order: velocities first, then positions with the new ones.
    SemiImplicitEuler,
    /// Dormand and Prince's embedded pair 5(4), the attitude on its group: steps as long as the tolerance
    /// lets them be, rows between them by dense output of fourth order.
    DormandPrince,
}

/// Reach and weight of the second to fourth stage.
const STAGES: [(f64, f64); 3] = [(0.5, 1.0 / 3.0), (0.5, 1.0 / 3.0), (1.0, 1.0 / 6.0)];

/// Where the stages see the origin: `p₀ + c h ṗ₀ + h² Σ ā_ij b_j`.
///
/// Nyström's conditions up to order four: `Σ_j ā_ij = c_i²/2`, `Σ b_i ā_ij c_j = 1/24`; and the
/// last stage exact in `b` and its rate.
const BEND: [[f64; 3]; 3] = [[0.125, 0.0, 0.0], [1.0 / 24.0, 1.0 / 12.0, 0.0], [1.0 / 6.0, 0.0, 1.0 / 3.0]];

/// Stages of a step, allocated once.
pub(crate) struct Stages<S> {
    pub(super) start: State<S>,
    pub(super) trial: State<S>,
    pub(super) rate: Rate<S>,
    pub(super) sum: Rate<S>,
    first: Vec<S>,
    /// Sum of the external forces at the start of the last step, W axes, N.
    first_force: Vec3<S>,
    /// Velocity of the base's origin at the start of the step, base axes: `start` is relative to it.
    pub(super) passing: Vec3<S>,
    integrator: Integrator,
    /// What the adaptive method has besides.
    pub(super) pair: Option<Box<Pair<S>>>,
}

impl<S: Real> Stages<S> {
    pub(crate) fn new(model: &Model, state: &State<S>, how: &Stepping) -> Self {
        let integrator = how.integrator;
        let (rate, first) = (Rate::new(model), vec![S::of(0.0); model.nv()]);
        let (start, trial, sum) = (state.clone(), state.clone(), rate.clone());
        let is_adaptive = integrator == Integrator::DormandPrince;
        let pair = is_adaptive.then(|| Box::new(Pair::new(&rate, how)));
        let (first_force, passing) = (Vec3::zero(), Vec3::zero());
        Self { start, trial, sum, rate, first, first_force, passing, integrator, pair }
    }

    /// Moves `state` from the start of `interval` to its end, or as far as the tolerance allows; returns
    /// where it got. Expects kinematics and wrenches at the start in the plant.
    pub(crate) fn advance(
        &mut self,
        plant: &mut Plant<'_, S, impl World<S>>,
        state: &mut State<S>,
        interval: (f64, f64),
    ) -> Result<f64, SimulationError> {
        match self.integrator {
            Integrator::DormandPrince => self.adapt(plant, state, interval),
            _ => self.step(plant, state, interval).map(|()| interval.1),
        }
    }

    /// Acceleration at the start of the last step, `(nv,)`.
    pub(crate) fn first_acceleration(&self) -> &[S] {
        &self.first
    }

    /// Sum of the external forces at the start of the last step, W axes, N.
    pub(super) fn first_force(&self) -> Vec3<S> {
        self.first_force
    }

    /// `q` and `v` at the start of the last step (of the first lane).
    pub(crate) fn start(&self) -> [Vec<f64>; 2] {
        let mut v = self.start.v.clone();
        (Vec3::from_slice(&v) + self.passing).write(&mut v);
        [&self.start.q, &v].map(|x| x.iter().map(|x| x.lane(0)).collect())
    }

    /// Work done before the last step, J.
    pub(crate) fn start_work(&self) -> S {
        self.start.work
    }

    /// Whether the last stage began at a state of numbers.
    pub(crate) fn is_finite(&self) -> bool {
        self.trial.is_finite()
    }

    /// The first stage alone. Expects kinematics and wrenches of `state` in the plant, which it takes
    /// to the frame of the step.
    pub(crate) fn accelerate(&mut self, plant: &mut Plant<'_, S, impl World<S>>, state: &State<S>) {
        self.start.copy_from(state);
        self.passing = Vec3::from_slice(&state.v);
        plant.ride(&state.q, &mut self.start.v);
        plant.accelerate(&state.q, &self.start.v, &mut self.rate);
        self.first_force = self.rate.wrench.linear;
        // seen from W the velocity of that frame turns in base axes: a = a' − (ω × u, 0)
        self.first.copy_from_slice(&self.rate.a);
        S::enter(
            #[inline(always)]
            || {
                let turning = Vec3::from_slice(&state.v[3..]).cross(self.passing);
                (Vec3::from_slice(&self.first) - turning).write(&mut self.first);
            },
        );
    }

    /// Moves `state` over `interval`. Expects kinematics and wrenches at its start in the plant.
    pub(crate) fn step(
        &mut self,
        plant: &mut Plant<'_, S, impl World<S>>,
        state: &mut State<S>,
        interval: (f64, f64),
    ) -> Result<(), SimulationError> {
        self.accelerate(plant, state);
        match self.integrator {
            Integrator::Rk4 => self.rk4(plant, state, interval)?,
            Integrator::SemiImplicitEuler => self.euler(plant.carried(), state, interval),
            Integrator::DormandPrince => self.dormand_prince(plant, state, interval)?,
        }
        Self::leave(plant, state);
        Ok(())
    }

    /// Back from the frame of the step to W: `v = v' + Rᵀ u`.
    pub(super) fn leave(plant: &Plant<'_, S, impl World<S>>, state: &mut State<S>) {
        S::enter(
            #[inline(always)]
            || {
                let passing = base_rotation(&state.q).transpose_mul(plant.carried());
                (Vec3::from_slice(&state.v) + passing).write(&mut state.v);
            },
        );
    }

    /// `y' = y ⊕ h (k₁ + 2 k₂ + 2 k₃ + k₄)/6`, attitude rates pulled back by the inverse
    /// differential of the exponential.
    ///
    /// The base's origin goes by its acceleration `b` in W instead (Nyström): stages see it off the
    /// straight line ([`BEND`]), and it ends at `p₀ + h ṗ₀ + h² (b₁ + b₂ + b₃)/6`. Far from the
    /// reference the tide is as strong as gravity, and this leaves a seventh of the error.
    fn rk4(
        &mut self,
        plant: &mut Plant<'_, S, impl World<S>>,
        state: &mut State<S>,
        interval: (f64, f64),
    ) -> Result<(), SimulationError> {
        let Self { start, trial, rate, sum, .. } = self;
        let (t, h) = (interval.0, interval.1 - interval.0);
        sum.clear();
        S::enter(
            #[inline(always)]
            || sum.accumulate(rate, S::of(1.0 / 6.0)),
        );
        let (straight, mut bends) = (rate.origin, [rate.bend; 3]);
        for (stage, (reach, weight)) in STAGES.into_iter().enumerate() {
            bends[stage] = rate.bend;
            let turned = S::enter(
                #[inline(always)]
                || {
                    trial.move_from(start, rate, S::of(reach * h));
                    bend(straight, &bends, BEND[stage], S::of(reach * h), S::of(h * h), start, trial);
                    rate.turn * S::of(reach * h)
                },
            );
            let instant = if reach == 1.0 { interval.1 } else { t + reach * h };
            plant.evaluate(instant, interval, trial, rate)?;
            S::enter(
                #[inline(always)]
                || {
                    rate.turn = dexp_inv(turned, Vec3::from_slice(&trial.v[3..]));
                    sum.accumulate(rate, S::of(weight));
                },
            );
        }
        S::enter(
            #[inline(always)]
            || {
                state.move_from(start, sum, S::of(h));
                bend(straight, &bends, [1.0 / 6.0; 3], S::of(h), S::of(h * h), start, state);
            },
        );
        Ok(())
    }

    /// `v' = v + h a(q, v)`, `q' = q ⊕ h v'`, in a frame that moves at `carried`.
    fn euler(&mut self, carried: Vec3<S>, state: &mut State<S>, interval: (f64, f64)) {
        let Self { start, rate, sum, .. } = self;
        let h = S::of(interval.1 - interval.0);
        S::enter(
            #[inline(always)]
            || {
                state.move_from(start, rate, h);
                for (delta, v) in sum.v.iter_mut().zip(&state.v) {
                    *delta = *v * h;
                }
                integrate(&start.q, &sum.v, &mut state.q);
                carried.scale_add(h, Vec3::from_slice(&state.q)).write(&mut state.q);
            },
        );
    }
}

/// Puts the origin of `to` where its acceleration takes it: `p₀ + h ṗ₀ + h² Σ w b`.
#[inline(always)]
fn bend<S: Real>(
    straight: Vec3<S>,
    bends: &[Vec3<S>; 3],
    weights: [f64; 3],
    h: S,
    h_squared: S,
    start: &State<S>,
    to: &mut State<S>,
) {
    let mut sum = Vec3::zero();
    for (bend, weight) in bends.iter().zip(weights) {
        sum = bend.scale_add(S::of(weight), sum);
    }
    let from = straight.scale_add(h, Vec3::from_slice(&start.q));
    sum.scale_add(h_squared, from).write(&mut to.q);
}
