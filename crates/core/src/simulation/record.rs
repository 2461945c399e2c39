//! Recording of rows: at the start of steps, within steps, at impacts and at the end of the run.

use super::contacts::{Contacts, Touched, at_time};
use super::environment_loads::EnvironmentLoads;
use super::equations::EquationsOfMotion;
use super::error::SimulationError;
use super::members::Place;
use super::mover::Mover;
use super::run_state::RunState;
use super::run_system::RunSystem;
use super::schedule::Interval;
use super::state::State;
use super::tree::Tree;
use super::tree_state::TreeState;
use crate::spatial::Scalar;

impl<S: Scalar> RunState<'_, S> {
    /// Returns true if a row is due at the start of `interval`. If every step is recorded, this includes
    /// steps that start at an event, so that discontinuities coincide with rows. The state after an event
    /// that has an effect is always recorded.
    pub(super) fn is_row_due(&self, interval: &Interval) -> bool {
        let is_due = |step: usize| step.is_multiple_of(self.record_every);
        interval.start < self.records_before
            && (self.has_every_step || self.has_event || interval.grid_step.is_some_and(is_due))
    }

    /// Adds a row of every system at `t`, s, for the current state, whose kinematics are in the equations of
    /// motion.
    pub(super) fn record(&mut self, t: f64) -> Result<(), SimulationError> {
        self.add_rows(t, false)
    }

    /// Adds the rows that are due within the last step, before the current cut.
    pub(super) fn record_within_step(&mut self) -> Result<(), SimulationError> {
        while let Some((step, t)) = self.schedule.next_grid_step_passed() {
            if t >= self.records_before {
                break;
            }
            if step.is_multiple_of(self.record_every) {
                self.record_within(t)?;
            }
        }
        Ok(())
    }

    /// Adds a row at `t`, s, within the last step, from the dense output of the adaptive integrator.
    pub(super) fn record_within(&mut self, t: f64) -> Result<(), SimulationError> {
        let Self { equations, mover, row_buffers: (state, _), .. } = self;
        if let Some(integration) = mover.integration() {
            integration.interpolate(t, state);
            equations.end_step(&integration.stages.start, state);
        }
        equations.project_momentum(state);
        equations.apply_loads(t, (t, t), state)?;
        self.add_rows(t, true)?;
        self.add_accelerations(true);
        Ok(())
    }

    /// Applies the impacts between bodies with an impact law, and those of joints that move into their stops,
    /// at `t`, s, the start of a step over `interval`, s. If every step is recorded, adds a row before the
    /// impacts; the row at the start of the step, which follows at the same time, contains the state after
    /// them.
    pub(super) fn impacts(&mut self, t: f64, interval: (f64, f64)) -> Result<(), SimulationError> {
        let Touched { has_impact, is_new } = self.equations.touched(t, &self.state)?;
        let mut pairs = self.equations.trees.iter().zip(&self.state.trees);
        let has_impact = has_impact
            || pairs.any(|(tree, state)| tree.modes.is_active() && tree.first_impact(state).is_some());
        if !has_impact && !is_new {
            return Ok(());
        }
        if has_impact && self.has_every_step && t < self.records_before {
            self.record_before_jump(t, interval)?;
        }
        self.mover.resolve_impacts(&mut self.equations, &mut self.state, Some(t))
    }

    /// Adds a row before a jump of the velocities at `t`, s, the start of a step over `interval`, s.
    pub(super) fn record_before_jump(&mut self, t: f64, interval: (f64, f64)) -> Result<(), SimulationError> {
        self.equations.apply_loads(t, interval, &self.state)?;
        if self.mover.is_external() {
            return self.with_held_commands(|run| run.record_before_event(t));
        }
        self.with_held_commands(|run| {
            run.record(t)?;
            run.add_accelerations(false);
            Ok(())
        })?;
        self.equations.project_momentum(&mut self.state);
        Ok(())
    }

    /// Adds the last row: the state at the current cut, with the torques that would be held in another step.
    pub(super) fn record_end(&mut self) -> Result<(), SimulationError> {
        let t = self.schedule.now();
        let following = self.schedule.following().map(|(interval, _)| interval.end);
        let interval = Interval { start: t, end: following.unwrap_or(t), grid_step: None, is_event: false };
        let begun = self.begin(&interval, t);
        begun.map_err(|error| self.name_divergence(error, t))?;
        self.has_event = false;
        self.record(t)?;
        if self.mover.is_external() {
            let Self { state, equations, mover, systems, row_states, .. } = self;
            let asked = mover.advance(equations, state, (t, t)); // requests only the acceleration
            complete_rows(systems, mover, equations, row_states);
            return asked.map(|_| ());
        }
        self.add_accelerations(false);
        Ok(())
    }

    /// Adds a row of every system at `t`, s, without the acceleration, for the current state or, if
    /// `is_within_step`, for the state in the row buffer. Requires the kinematics of that state in the
    /// equations of motion.
    fn add_rows(&mut self, t: f64, is_within_step: bool) -> Result<(), SimulationError> {
        self.update_moving_frames(is_within_step);
        let Self { systems, equations, state, row_buffers, row_states, .. } = self;
        let state = if is_within_step { &row_buffers.0 } else { &*state };
        let EquationsOfMotion { trees, members, loads, contacts, .. } = equations;
        let orbit = loads.reference_state(t)?;
        if !members.parts.is_empty() {
            members.prepare_rows(trees, &state.trees);
            row_states.clone_from(&state.trees);
        }
        for (number, run) in systems.iter_mut().enumerate() {
            let (state, system) = members.system(number, trees, &state.trees);
            run.add_row(t, state, system, loads, orbit)?;
        }
        if contacts.count() > 0 {
            record_contacts(t, systems, contacts, trees, state)?;
        }
        if self.systems.iter().any(|run| !run.recorder.trace.loops.is_empty()) {
            self.record_loops(is_within_step);
        }
        if self.systems.len() > 1 {
            self.add_group_row(is_within_step);
        }
        Ok(())
    }

    /// Completes the last rows with the accelerations at the current state or, if `is_within_step`, at the
    /// state in the row buffer. Requires the kinematics and loads of that state in the equations of motion.
    fn add_accelerations(&mut self, is_within_step: bool) {
        let Self { systems, equations, state, row_buffers: (buffer, stages), row_states, .. } = self;
        stages.evaluate_first(equations, if is_within_step { buffer } else { state });
        let EquationsOfMotion { trees, members, .. } = equations;
        for (number, run) in systems.iter_mut().enumerate() {
            let tree = members.tree_at(members.places[number]);
            let first = &stages.first[tree].acceleration;
            match members.places[number] {
                Place::Tree(_) => run.recorder.record_acceleration(&trees[tree].model, first),
                Place::Part(part) => {
                    let part = &members.parts[part];
                    let own = part.acceleration(&trees[tree], &row_states[tree], first);
                    run.recorder.record_acceleration(&part.own.model, &own);
                }
            }
        }
    }
}

/// Adds the values of every contact at `t`, s, to the last rows of the systems that own the contacts.
#[inline(never)]
fn record_contacts<S: Scalar>(
    t: f64,
    systems: &mut [RunSystem<'_, S>],
    contacts: &mut Contacts,
    trees: &[Tree<'_, S>],
    state: &State<S>,
) -> Result<(), SimulationError> {
    for contact in 0..contacts.count() {
        let row = contacts.row(contact, trees, state).map_err(at_time(t))?;
        systems[contacts.owner(contact)].recorder.record_contact(&contacts.names[contact], &row);
    }
    Ok(())
}

/// Adds the accelerations, and the contact forces that an external engine computes, to the rows at the start
/// of the last step. If systems share trees, `row_states` are the states of the trees in these rows.
pub(super) fn complete_rows<S: Scalar>(
    systems: &mut [RunSystem<'_, S>],
    mover: &Mover<'_, S>,
    equations: &EquationsOfMotion<'_, S, EnvironmentLoads>,
    row_states: &[TreeState<S>],
) {
    let EquationsOfMotion { trees, members, contacts, .. } = equations;
    if mover.is_external() {
        for contact in 0..contacts.count() {
            let recorder = &mut systems[contacts.owner(contact)].recorder;
            mover.complete_contact(contact, &contacts.names[contact], recorder);
        }
    }
    for (number, run) in systems.iter_mut().enumerate() {
        match members.places[number] {
            Place::Tree(tree) => mover.complete_row(tree, &mut run.recorder, &trees[tree].model),
            Place::Part(part) => {
                let part = &members.parts[part];
                let tree = part.tree;
                let Some(first) = mover.first_acceleration(tree) else { continue };
                let own = part.acceleration(&trees[tree], &row_states[tree], first);
                run.recorder.record_acceleration(&part.own.model, &own);
            }
        }
    }
}
