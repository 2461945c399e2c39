//! How far the steps are from halved ones: an estimate of the attitude's error.

use super::error::SimulationError;
use super::integrator::Stages;
use super::plant::{Plant, World};
use super::state::State;
use crate::spatial::{Quat, Scalar, log_so3};

/// How many steps pass between two probes; three steps each, so about a hundredth of a run.
const EVERY: usize = 256;

/// Repeats a step now and then as two of half its size, and adds up what their attitudes differ by.
///
/// A local error of order `p + 1` is smaller by `2^p` in two half steps, so the difference is the
/// local error itself but for a sixteenth (Runge-Kutta). The sum bounds the error of a run that does
/// not amplify it; a chaotic one does.
pub(super) struct Probe<S> {
    whole: State<S>,
    halved: State<S>,
    /// Difference found by the last probe, rad, and the step it was made at.
    last: (f64, usize),
    sum: f64,
}

impl<S: Scalar> Probe<S> {
    pub(super) fn new(state: &State<S>) -> Self {
        Self { whole: state.clone(), halved: state.clone(), last: (0.0, 0), sum: 0.0 }
    }

    /// What there is to keep of it.
    pub(super) fn numbers(&self) -> (f64, usize, f64) {
        (self.last.0, self.last.1, self.sum)
    }

    /// Goes on from what was kept.
    pub(super) fn go_on_from(&mut self, (difference, step, sum): (f64, usize, f64)) {
        (self.last, self.sum) = ((difference, step), sum);
    }

    /// Sum of the differences over `steps` steps so far, rad.
    pub(super) fn estimate(&self, steps: usize) -> f64 {
        self.sum + self.last.0 * (steps - self.last.1) as f64
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
        if !step.is_multiple_of(EVERY) {
            return Ok(());
        }
        let difference = self.difference(interval, state, plant, stages);
        self.halved.copy_from(state);
        plant.settle(&mut self.halved);
        plant.surround(interval.0, interval, &state.q)?;
        self.sum = self.estimate(step);
        self.last = (difference?, step);
        Ok(())
    }

    /// What one step and two halved ones differ by in attitude, rad.
    fn difference(
        &mut self,
        interval: (f64, f64),
        state: &State<S>,
        plant: &mut Plant<'_, S, impl World<S>>,
        stages: &mut Stages<S>,
    ) -> Result<f64, SimulationError> {
        let middle = 0.5 * (interval.0 + interval.1);
        self.whole.copy_from(state);
        stages.step(plant, &mut self.whole, interval)?;
        self.halved.copy_from(state);
        for half in [(interval.0, middle), (middle, interval.1)] {
            plant.settle(&mut self.halved);
            plant.surround(half.0, interval, &self.halved.q)?;
            stages.step(plant, &mut self.halved, half)?;
        }
        let [a, b] = [&self.whole, &self.halved].map(|state| Quat::from_xyzw(&state.q[3..7]));
        Ok(log_so3(a.conjugate().product(b)).norm().value())
    }
}
