//! One step of a run. The numbers in the comments are those of the order of execution in `docs/design.md`.

use super::equations::EquationsOfMotion;
use super::error::SimulationError;
use super::members::{Members, Part, Place};
use super::mover::Mover;
use super::record::complete_rows;
use super::run_state::RunState;
use super::schedule::Interval;
use crate::control::ControlError;
use crate::spatial::{Scalar, Vec3};

impl<S: Scalar> RunState<'_, S> {
    /// Computes a step that starts at the current cut, which is the start of `interval`. The step ends at
    /// `end`, s, unless an event that became known during the run, or a change of the mode of a joint, latch
    /// or contact, ends it earlier. It may also be shorter while bodies touch or approach each other, and if
    /// the tolerance of an adaptive integrator requires a shorter step.
    pub(super) fn step_to(&mut self, end: f64, interval: &Interval) -> Result<(), SimulationError> {
        let start = interval.start;
        self.order_of_execution(end, interval).map_err(|error| self.name_divergence(error, start))?;
        if self.state.is_finite() { Ok(()) } else { Err(self.diverged(start)) }
    }

    /// Computes a step over the interval, or over its first part as in [`step_to`](Self::step_to).
    pub(super) fn step(&mut self, interval: &Interval) -> Result<(), SimulationError> {
        self.step_to(interval.end, interval)
    }

    fn order_of_execution(&mut self, end: f64, interval: &Interval) -> Result<(), SimulationError> {
        let end = self.begin(interval, end)?;
        // 7 row at the start of the step
        let is_row = self.is_row_due(interval);
        self.has_event = false;
        if is_row {
            self.record(interval.start)?;
        }
        // 8 integration, 9 location of the first change of a mode: of a joint or of a latch
        let reached = self.integrate(interval, end, is_row)?;
        self.schedule.cut_at(reached);
        (self.steps, self.controllers_updated) = (self.steps + 1, false);
        self.record_within_step()
    }

    /// Computes kinematics, events, impacts, loads, controllers and modes at the start of a step in
    /// `interval` whose planned end is `end`, s. The function also prepares the last row, which no step
    /// follows. Returns the end of the step, s, which is earlier than `end` if an event has become due within
    /// the interval, and may be earlier while bodies touch or approach each other.
    pub(super) fn begin(&mut self, interval: &Interval, end: f64) -> Result<f64, SimulationError> {
        let t = interval.start;
        // 1 kinematics, and the base twist projected onto the momentum
        self.state.set_clocks(t);
        self.mover.kinematics(&mut self.equations, &mut self.state);
        if !self.state.is_finite() {
            return Err(self.diverged(t));
        }
        if self.equations.trees.iter().any(|tree| !tree.loops.is_empty()) {
            self.find_singular_loops(t);
        }
        self.accuracy.end_step(t, &self.state, &self.equations);
        // 2 events: captures and releases
        if !self.events.list.is_empty() {
            self.happen(t, (t, end))?;
        }
        let end = self.schedule.first_due(t, end);
        // 3 impacts of rigid bodies, and of joints at their stops
        self.impacts(t, (t, end))?;
        let end = self.equations.begin_contacts(t, end, &mut self.state)?;
        self.take_touches();
        if self.has_controls() {
            self.equations.members.follow(&self.equations.trees, &self.state.trees);
            self.pass_normal_forces();
        }
        // 4 loads of the environment, 5 controllers that are due
        self.loads_and_controllers(interval, end)?;
        // 6 which joints stick, slip or rest at a stop during the step, and the forces between rigid bodies
        // at rest
        self.mover.solve_modes(&mut self.equations, &self.state);
        if self.mover.hold_contacts(&mut self.equations, &mut self.state, (t, end))? {
            self.take_touches();
        }
        let EquationsOfMotion { trees, members, .. } = &mut self.equations;
        if !members.parts.is_empty() {
            members.take_modes(trees);
        }
        Ok(end)
    }

    /// Computes the loads for the step from the start of `interval` to `end`, s, and updates the controllers
    /// that are due. Controllers that compensate the environment are updated after the loads have been
    /// computed, and all others before. The compensated loads are those of the whole interval, even if the
    /// step ends earlier.
    fn loads_and_controllers(&mut self, interval: &Interval, end: f64) -> Result<(), SimulationError> {
        let t = interval.start;
        let is_due = self.has_controls() && self.find_due(t);
        let uses_loads =
            is_due && self.systems.iter().any(|run| run.controllers.set.compensates_environment());
        if is_due {
            self.keep_commands();
            self.update_moving_frames(false);
            self.update_controllers(t, false)?;
        }
        if uses_loads {
            self.equations.apply_environment(t, (t, interval.end), &self.state)?;
            self.update_controllers(t, true)?;
        }
        if is_due {
            self.find_attached();
        }
        self.controllers_updated |= is_due;
        if !uses_loads || end != interval.end || !self.equations.contacts.is_empty() {
            self.equations.apply_loads(t, (t, end), &self.state)?;
        }
        Ok(())
    }

    /// Returns true if any system has controls, which require the state in the coordinates of their system.
    fn has_controls(&self) -> bool {
        self.systems.iter().any(|run| !run.controllers.set.controls().is_empty())
    }

    /// Passes the normal forces of the contacts to the controllers of each system that uses them.
    #[inline(never)]
    fn pass_normal_forces(&mut self) {
        let Self { equations: EquationsOfMotion { trees, members, contacts, .. }, systems, .. } = self;
        for (number, run) in systems.iter_mut().enumerate() {
            if run.controllers.set.uses_normal_forces() {
                let model = match members.places[number] {
                    Place::Tree(tree) => &trees[tree].model,
                    Place::Part(part) => &members.parts[part].own.model,
                };
                let body = |frame: usize| model.frames()[frame].body;
                contacts.normal_forces(number, body, run.controllers.set.normal_forces_mut());
            }
        }
    }

    /// Marks the systems whose controllers are due at `t`, s, and returns true if there are any. Controllers
    /// are due at their ticks and when an event starts a control. If a trial step has already updated
    /// controllers at this cut, they are due again only at a tick and after a new command.
    #[inline(never)]
    fn find_due(&mut self, t: f64) -> bool {
        let is_repeated = self.controllers_updated;
        for number in 0..self.systems.len() {
            let set = &self.systems[number].controllers.set;
            if set.controls().is_empty() {
                continue; // never due
            }
            let starts_at_event = self.has_event && set.is_started_by_event();
            let is_due = match is_repeated {
                false => starts_at_event || self.schedule.is_tick(number, t),
                true => self.has_new_command(number, t) && self.schedule.is_tick(number, t),
            };
            let run = &mut self.systems[number];
            run.is_due = is_due;
            run.controllers.set.set_repeated(is_repeated);
        }
        self.systems.iter().any(|run| run.is_due)
    }

    /// Updates the controllers that are due at `t`, s: those that compensate loads of the environment if
    /// `compensates_environment` is true, otherwise the others.
    fn update_controllers(&mut self, t: f64, compensates_environment: bool) -> Result<(), SimulationError> {
        for number in 0..self.systems.len() {
            let run = &self.systems[number];
            if !run.is_due || run.controllers.set.compensates_environment() != compensates_environment {
                continue;
            }
            self.update_known(number);
            let EquationsOfMotion { trees, members, .. } = &mut self.equations;
            let controllers = &mut self.systems[number].controllers;
            let (state, system) = match members.places[number] {
                Place::Tree(tree) => (&self.state.trees[tree], &mut trees[tree]),
                Place::Part(part) => {
                    let Part { state, own, .. } = &mut members.parts[part];
                    (&*state, own)
                }
            };
            if !compensates_environment {
                system.data.clear_external();
            }
            controllers.update(t, state, system)?;
            if let Place::Part(part) = members.places[number] {
                let part = &members.parts[part];
                part.drive(&mut trees[part.tree]);
            }
        }
        Ok(())
    }

    /// Integrates from the start of `interval` towards `end`, measures the accuracy of the step, and returns
    /// the time reached, s.
    fn integrate(&mut self, interval: &Interval, end: f64, is_row: bool) -> Result<f64, SimulationError> {
        let span = (interval.start, end);
        let Self { state, equations, mover, accuracy, systems, ledger, .. } = self;
        accuracy.start_step(self.steps, span, state, equations, mover)?;
        let result = mover.advance(equations, state, span);
        if is_row {
            complete_rows(systems, mover, equations, &self.row_states);
        }
        let reached = result?;
        if let Mover::External(engine) = mover {
            engine.remove_exchanged(ledger);
        }
        for (run, &place) in systems.iter_mut().zip(&equations.members.places) {
            let tree = equations.members.tree_at(place);
            run.recorder.trace.work_done += mover.work_of_step(tree, &state.trees[tree]).abs();
        }
        let has_jump = equations.loads.commands.changed_at() == Some(interval.start);
        let is_smooth = !interval.is_event && !has_jump && !equations.has_modes();
        accuracy.measure_step(
            (span.0, reached),
            is_smooth,
            state,
            equations,
            mover,
            &mut self.row_buffers,
        )?;
        Ok(reached)
    }

    /// Changes to a new local reference orbit at `t`, s, if a system has drifted too far from its current
    /// reference orbit.
    pub(super) fn rereference_if_far(&mut self, t: f64) -> Result<(), SimulationError> {
        let EquationsOfMotion { trees, loads, .. } = &mut self.equations;
        if !loads.has_orbit() {
            return Ok(());
        }
        for (number, (tree, state)) in trees.iter_mut().zip(&mut self.state.trees).enumerate() {
            if Vec3::from_slice(&state.q).norm().value() > self.rereference_beyond {
                tree.rereference(loads, t, state)?;
                self.accuracy.skip_step(number);
            }
        }
        Ok(())
    }

    /// Returns the error with which a step from `t`, s, ends, after replacing errors that are consequences of
    /// divergence. The overflow of a torque, and any error while the state is not finite, such as that of an
    /// orbit or effect at a non-finite position, becomes [`SimulationError::Diverged`].
    #[cold]
    pub(super) fn name_divergence(&self, error: SimulationError, t: f64) -> SimulationError {
        let is_overflow = matches!(&error, SimulationError::Control(ControlError::Overflow { .. }));
        if is_overflow || self.mover.first_diverged(&self.state).is_some() { self.diverged(t) } else { error }
    }

    /// Returns [`SimulationError::Diverged`] at `time`, s, with the last finite state.
    #[cold]
    fn diverged(&self, time: f64) -> SimulationError {
        let number = self.mover.first_diverged(&self.state).unwrap_or(0); // if all are finite, a torque overflowed
        let [q, v] = self.mover.last_finite(number, &self.state);
        let Members { places, parts } = &self.equations.members;
        let is_in_tree = |place: &Place| match *place {
            Place::Tree(tree) => tree == number,
            Place::Part(part) => parts[part].tree == number,
        };
        let systems = self.layout.systems().iter().zip(places).filter(|(_, place)| is_in_tree(place));
        let systems: Vec<_> = systems.map(|(system, _)| format!("'{}'", system.name)).collect();
        SimulationError::Diverged { time, systems: systems.join(" and "), q, v }
    }
}
