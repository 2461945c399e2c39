//! The rows of a run: at the starts of steps, within them, at impacts and at the end.

use super::error::SimulationError;
use super::run::Run;
use crate::spatial::Scalar;

impl<S: Scalar> Run<'_, S> {
    /// A row for the state whose kinematics are in the plant.
    pub(super) fn record(&mut self, t: f64) -> Result<(), SimulationError> {
        let Self { state, plant, driver, recorder, tracked, .. } = self;
        let orbit = plant.surroundings.orbit_state(t)?;
        recorder.row(t, state, plant, orbit, driver.desired(t, state, plant, *tracked)?);
        driver.stack().into_iter().for_each(|stack| recorder.tracked(stack));
        recorder.felt(plant, t)
    }

    /// A row within the last step.
    pub(super) fn record_between(&mut self, t: f64) -> Result<(), SimulationError> {
        let Self { plant, stepper, driver, tracked, between: (state, stages), recorder, .. } = self;
        stepper.stages.interpolate(t, state);
        plant.settle(state);
        plant.surround(t, (t, t), &state.q)?;
        let orbit = plant.surroundings.orbit_state(t)?;
        recorder.row(t, state, plant, orbit, driver.desired(t, state, plant, *tracked)?);
        driver.stack().into_iter().for_each(|stack| recorder.tracked(stack));
        recorder.felt(plant, t)?;
        stages.accelerate(plant, state);
        recorder.accelerated(plant.model, stages.first_acceleration());
        Ok(())
    }

    /// Joints that run into their stops bounce; with every step a row, the instant has one before and
    /// one after.
    pub(super) fn bounce(&mut self, t: f64, interval: (f64, f64)) -> Result<(), SimulationError> {
        if !self.plant.contacts.is_active() || self.plant.hits(&self.state).is_none() {
            return Ok(());
        }
        if self.recorder.trace.has_every_step {
            self.plant.surround(t, interval, &self.state.q)?;
            self.record(t)?;
            let Self { state, plant, between: (_, stages), recorder, .. } = self;
            stages.accelerate(plant, state);
            recorder.accelerated(plant.model, stages.first_acceleration());
            plant.settle(state);
        }
        self.stepper.bounce(&mut self.plant, &mut self.state);
        Ok(())
    }

    /// The last row: the state at the end, with the torque that would be held from there.
    pub(super) fn end(&mut self, t: f64) -> Result<(), SimulationError> {
        let begun = self.begin(t, (t, t), self.schedule.is_control_tick());
        begun.map_err(|error| self.name_divergence(error, t))?;
        self.record(t)?;
        if self.foreign.is_some() {
            return self.step_foreign((t, t), true);
        }
        let (_, stages) = &mut self.between;
        stages.accelerate(&mut self.plant, &self.state);
        self.recorder.accelerated(self.plant.model, stages.first_acceleration());
        Ok(())
    }
}
