//! One step: Runge-Kutta on the group, or semi-implicit Euler.

use super::error::SimulationError;
use super::plant::{Plant, World};
use super::state::{Rate, State};
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
}

/// Stages of a step, allocated once.
pub(crate) struct Stages<S> {
    start: State<S>,
    trial: State<S>,
    rate: Rate<S>,
    sum: Rate<S>,
    first: Vec<S>,
    integrator: Integrator,
}

impl<S: Real> Stages<S> {
    pub(crate) fn new(model: &Model, state: &State<S>, integrator: Integrator) -> Self {
        let (rate, first) = (Rate::new(model), vec![S::of(0.0); model.nv()]);
        Self { start: state.clone(), trial: state.clone(), sum: rate.clone(), rate, first, integrator }
    }

    /// Acceleration at the start of the last step, `(nv,)`.
    pub(crate) fn first_acceleration(&self) -> &[S] {
        &self.first
    }

    /// State at the start of the last step.
    pub(crate) fn start(&self) -> &State<S> {
        &self.start
    }

    /// Whether the last stage began at a state of numbers.
    pub(crate) fn is_finite(&self) -> bool {
        self.trial.is_finite()
    }

    /// The first stage alone. Expects kinematics and wrenches of `state` in the plant.
    pub(crate) fn accelerate(&mut self, plant: &mut Plant<'_, S, impl World<S>>, state: &State<S>) {
        self.start.copy_from(state);
        plant.accelerate(&state.q, &state.v, &mut self.rate);
        self.first.copy_from_slice(&self.rate.a);
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
            Integrator::Rk4 => self.rk4(plant, state, interval),
            Integrator::SemiImplicitEuler => {
                self.euler(state, interval);
                Ok(())
            }
        }
    }

    /// `y' = y ⊕ h (k₁ + 2 k₂ + 2 k₃ + k₄)/6`, attitude rates pulled back by the inverse
    /// differential of the exponential.
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
        for (reach, weight) in [(0.5, 1.0 / 3.0), (0.5, 1.0 / 3.0), (1.0, 1.0 / 6.0)] {
            let turned = rate.turn * S::of(reach * h);
            S::enter(
                #[inline(always)]
                || trial.move_from(start, rate, S::of(reach * h)),
            );
            let stage = if reach == 1.0 { interval.1 } else { t + reach * h };
            plant.evaluate(stage, interval, trial, rate)?;
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
            || state.move_from(start, sum, S::of(h)),
        );
        Ok(())
    }

    /// `v' = v + h a(q, v)`, `q' = q ⊕ h v'`.
    fn euler(&mut self, state: &mut State<S>, interval: (f64, f64)) {
        let Self { start, rate, sum, .. } = self;
        let h = S::of(interval.1 - interval.0);
        state.move_from(start, rate, h);
        for (delta, v) in sum.v.iter_mut().zip(&state.v) {
            *delta = *v * h;
        }
        integrate(&start.q, &sum.v, &mut state.q);
    }
}
