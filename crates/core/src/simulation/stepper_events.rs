//! Events, rigidly connected controls and singular loops of a run, which the caller of a stepper can query.

use super::attached::AttachedControl;
use super::error::SimulationError;
use super::recording::EventRecord;
use super::singularity_watch::SingularLoop;
use super::stepper::Stepper;
use crate::number_text::names;
use crate::world::WorldError;

impl Stepper<'_> {
    /// Triggers the event named `name`, which must happen on command, at the current time. The current step
    /// ends at this time.
    ///
    /// # Errors
    /// [`SimulationError::World`] for an event that does not exist, has already happened, or does not happen
    /// on command; the run does not change. [`SimulationError::Ended`] if the run has ended. Errors of a step
    /// end the run.
    pub fn trigger(&mut self, name: &str) -> Result<(), SimulationError> {
        self.check()?;
        for group in 0..self.groups.len() {
            let run = &mut self.groups[group].run;
            if let Some(event) = run.check_trigger(name)? {
                let result = run.trigger(event);
                return self.ended_by(result);
            }
        }
        let known: Vec<String> = self.groups.iter().flat_map(|group| group.run.events()).collect();
        let known = names(&known, "event");
        Err(WorldError::NoSuchEvent { name: name.to_owned(), known }.into())
    }

    /// Returns the records of the events that have happened during completed steps, in order of time.
    pub fn events(&self) -> Vec<&EventRecord> {
        let mut all: Vec<_> = self.groups.iter().flat_map(|group| group.run.records()).collect();
        all.sort_by(|a, b| a.time.total_cmp(&b.time));
        all
    }

    /// Returns the controls found so far whose frames a capture has rigidly connected to the frames that they
    /// follow, so that the controls cannot reduce their errors.
    pub fn attached_controls(&self) -> Vec<AttachedControl> {
        self.groups.iter().flat_map(|group| group.run.attached_controls()).collect()
    }

    /// Returns the closed loops and mimic joints that have been in, or near, a singular configuration since
    /// the run was started or resumed, each with the time at which this first happened, s.
    pub fn singular_loops(&self) -> Vec<SingularLoop> {
        self.groups.iter().flat_map(|group| group.run.singular_loops().iter().cloned()).collect()
    }
}
