//! State of a run between two steps. A run that is restored to this state continues with bit-identical
//! results.

use super::accuracy::Accuracy;
use super::checkpoint::{
    GroupCheckpoint, Progress, SavedControllers, SystemProgress, TreeProgress, WorldProgress, check_each,
};
use super::checkpoint_error::CheckpointError;
use super::connections::Connections;
use super::contacts::SavedContacts;
use super::environment_loads::EnvironmentLoads;
use super::equations::EquationsOfMotion;
use super::error::SimulationError;
use super::estimates::Estimates;
use super::events::Events;
use super::group_balance::GroupBalance;
use super::integrator::{Stages, StepSettings};
use super::loop_row::LoopRow;
use super::members::Place;
use super::mover::Mover;
use super::recording::Ledger;
use super::run_system::RunSystem;
use super::schedule::Schedule;
use super::singularity_watch::SingularLoop;
use super::state::State;
use super::trace::Trace;
use super::tree::Tree;
use super::tree_state::TreeState;
use crate::earth::Earth;
use crate::reference::MovingFrame;
use crate::spatial::Scalar;
use crate::world::{FrameIndex, Layout};
use std::sync::Arc;

/// State of a run in progress. Steps are in `step.rs`, the recording of rows in `record.rs`, and the
/// evaluation at times within a step in `look_ahead.rs`.
pub(super) struct RunState<'a, S> {
    /// Names of the systems and of their joints. All lists with one entry per system are in this order.
    pub(super) layout: Layout,
    /// Index of each system in the world.
    pub(super) numbers: Vec<usize>,
    /// State at the current cut, the instant at which the current step begins.
    pub(super) state: State<S>,
    pub(super) equations: EquationsOfMotion<'a, S, EnvironmentLoads>,
    /// Controllers, recorder and brakes of each system.
    pub(super) systems: Vec<RunSystem<'a, S>>,
    pub(super) connections: Connections,
    /// Frames that are fixed in one system and in which references of another system are given. The first
    /// entry of a pair identifies the frame by the index of its system in the group. The second entry shares
    /// its data with the reference; the simulation writes the motion of the frame to it.
    pub(super) moving_frames: Vec<(FrameIndex, MovingFrame)>,
    pub(super) events: Events,
    pub(super) ledger: Ledger,
    /// Balance of momentum and energy of the group; empty if the group consists of a single system.
    pub(super) balance: GroupBalance,
    pub(super) mover: Mover<'a, S>,
    pub(super) step_settings: StepSettings,
    pub(super) schedule: Schedule,
    pub(super) record_every: usize,
    /// True if every step is recorded as a row of the trace.
    pub(super) has_every_step: bool,
    pub(super) accuracy: Accuracy<S>,
    /// Number of steps computed so far.
    pub(super) steps: usize,
    /// Current time, s: the current cut, or a time within the step that begins at the cut.
    pub(super) time: f64,
    /// True if the controllers have been updated at the current cut.
    pub(super) controllers_updated: bool,
    /// True while [`RunState::peek`] computes a trial step that has not yet updated the controllers.
    pub(super) keeps_commands: bool,
    /// True if an event has happened at the current cut, for which a row is then due.
    pub(super) has_event: bool,
    /// Time before which rows are recorded, s; infinity, except while [`RunState::peek`] computes trial
    /// steps.
    pub(super) records_before: f64,
    /// Buffers for a state and its stages that are not those of the step: for rows within a step or before a
    /// jump, and for the measurement of the accuracy.
    pub(super) row_buffers: (State<S>, Stages<S>),
    /// States of the trees in the last row, if systems share trees.
    pub(super) row_states: Vec<TreeState<S>>,
    /// Buffer for the values of the closed loops in a row.
    pub(super) loop_rows: Vec<LoopRow>,
    /// Distance of the base from the origin of W beyond which a system changes to a local reference orbit, m;
    /// infinity if the reference orbit is kept.
    pub(super) rereference_beyond: f64,
    pub(super) earth: Option<Arc<Earth>>,
    /// Closed loops and mimic joints that have been in a singular configuration since the run was started or
    /// resumed.
    pub(super) singular_loops: Vec<SingularLoop>,
}

impl<S: Scalar> RunState<'_, S> {
    /// Returns everything that a step changes, except the state of the controllers and the records of events,
    /// to which a step only adds.
    pub(super) fn progress(&self) -> Progress {
        let (step_control, idle_steps, has_jumped) = self.mover.save();
        let SavedContacts { modes: contacts, touches, resting } = self.equations.contacts.save();
        let tree = |(number, tree): (usize, &Tree<'_, S>)| {
            let (errors, checks) = self.accuracy.save(number);
            TreeProgress { modes: tree.modes.save(), errors, checks }
        };
        let system = |run: &RunSystem<'_, S>| {
            let (rows, work_done) = (run.recorder.rows_recorded(), run.recorder.trace.work_done);
            SystemProgress {
                rows,
                work_done,
                settled: run.settled.clone(),
                engaged: run.brakes.iter().map(|brake| brake.is_engaged).collect(),
            }
        };
        let mut state = self.state.map(|x| x.value());
        state.contacts = self.equations.contacts.all_states(&state.contacts);
        Progress {
            steps: self.steps,
            cursor: self.schedule.cursor(),
            state,
            step_control,
            idle_steps,
            has_jumped,
            trees: self.equations.trees.iter().enumerate().map(tree).collect(),
            systems: self.systems.iter().map(system).collect(),
            world: WorldProgress {
                members: self.save_members(),
                events: self.events.states.clone(),
                records: Vec::new(),
                attached: self.events.attached.clone(),
                ledger: self.ledger,
                balance: self.balance.clone(),
                contacts,
                touches,
                resting,
            },
        }
    }

    /// Restores the state that [`RunState::progress`] returned, and removes the rows recorded since then.
    pub(super) fn restore(&mut self, progress: Progress) -> Result<(), SimulationError> {
        self.restore_brakes(&progress.systems);
        self.restore_world(progress.world)?;
        self.state = progress.state.map(|x| S::of(*x));
        self.schedule.set_cursor(progress.cursor);
        self.steps = progress.steps;
        self.mover.restore((progress.step_control, progress.idle_steps, progress.has_jumped));
        for (number, (saved, tree)) in progress.trees.into_iter().zip(&mut self.equations.trees).enumerate() {
            tree.modes.restore(&saved.modes);
            self.accuracy.restore(number, (saved.errors, saved.checks));
        }
        for (saved, run) in progress.systems.into_iter().zip(&mut self.systems) {
            run.recorder.truncate_to(saved.rows);
            run.recorder.trace.work_done = saved.work_done;
            run.settled = saved.settled;
        }
        Ok(())
    }

    /// Restores the connections, the events and the balance of the group.
    fn restore_world(&mut self, world: WorldProgress) -> Result<(), SimulationError> {
        self.restore_members(world.members)?;
        self.balance = world.balance;
        let (modes, touches, resting) = (world.contacts, world.touches, world.resting);
        self.equations.contacts.restore(SavedContacts { modes, touches, resting });
        self.ledger = world.ledger;
        if !self.events.list.is_empty() {
            self.events.states = world.events;
            self.events.attached = world.attached;
            self.events_changed();
            self.find_latches();
        }
        Ok(())
    }

    /// Passes the indices of the events that have happened to the controllers, and sets the times in the
    /// schedule at which events are due or seating motions require that a step ends.
    pub(super) fn events_changed(&mut self) {
        let step = self.schedule.time_step();
        let seatings = self.connections.active.welds.iter().filter_map(|weld| weld.seating);
        let seatings = seatings.flat_map(|seating| seating.cuts(step));
        self.schedule.set_due(self.events.due_times().into_iter().chain(seatings).collect());
        let happened = self.events.happened();
        self.systems.iter_mut().for_each(|run| run.controllers.set.set_events(&happened));
    }

    /// Returns a checkpoint of the current state. The checkpoint does not contain the rows recorded so far.
    pub(super) fn checkpoint(&self) -> Result<GroupCheckpoint, SimulationError> {
        let EquationsOfMotion { trees, members, loads, .. } = &self.equations;
        let systems = self.systems.iter().enumerate();
        let systems = systems
            .map(|(number, run)| run.save_controllers(members.system(number, trees, &self.state.trees).1));
        let systems = systems.collect::<Result<_, _>>()?;
        let mut progress = self.progress();
        progress.world.records.clone_from(&self.events.records);
        Ok(GroupCheckpoint {
            time: self.time,
            schedule: self.schedule.clone(),
            progress,
            local_reference: loads.local_reference().cloned(),
            wrenches: loads.commands.clone(),
            controllers: SavedControllers { controllers_updated: self.controllers_updated, systems },
        })
    }

    /// Restores the state of a checkpoint; `rows` contains the rows of each system recorded before the
    /// checkpoint.
    pub(super) fn resume(&mut self, from: GroupCheckpoint, rows: Vec<Trace>) -> Result<(), SimulationError> {
        let counts: Vec<usize> = rows.iter().map(Trace::rows_recorded).collect();
        from.check(&self.layout, &self.schedule, &counts, self.events.list.len())?;
        self.check_connections(&from.progress.world)?;
        self.check_contacts(&from.progress)?;
        self.check_brakes(&from.progress)?;
        self.restore_brakes(&from.progress.systems);
        self.restore_members(from.progress.world.members.clone())?;
        self.check_members(&from.progress.world)?;
        from.check_trees(&self.state)?;
        let GroupCheckpoint { time, mut progress, local_reference, wrenches, controllers: saved, .. } = from;
        self.events.records = std::mem::take(&mut progress.world.records);
        self.equations.loads.commands = wrenches;
        self.check_estimates(&progress)?;
        for (run, rows) in self.systems.iter_mut().zip(rows) {
            run.recorder.resume(rows)?;
        }
        self.restore(progress)?;
        self.time = time;
        if let Some(local) = local_reference {
            self.equations.loads.set_local_reference(local)?;
        }
        self.controllers_updated = saved.controllers_updated;
        let EquationsOfMotion { trees, members, .. } = &mut self.equations;
        for (number, (saved, run)) in saved.systems.into_iter().zip(&mut self.systems).enumerate() {
            match members.places[number] {
                Place::Tree(tree) => run.load_controllers(saved, &mut trees[tree])?,
                Place::Part(part) => {
                    let part = &mut members.parts[part];
                    run.load_controllers(saved, &mut part.own)?;
                    part.drive(&mut trees[part.tree]);
                }
            }
        }
        Ok(())
    }

    /// Checks that the checkpoint contains error estimates if and only if this run computes them.
    fn check_estimates(&self, progress: &Progress) -> Result<(), CheckpointError> {
        for (number, saved) in progress.trees.iter().enumerate() {
            let (errors, checks) = self.accuracy.save(number);
            let [own_errors, own_checks] = [errors.is_some(), checks.is_some()].map(usize::from);
            let [got_errors, got_checks] = [saved.errors.is_some(), saved.checks.is_some()].map(usize::from);
            check_each([
                ("sets of error estimates", got_errors, own_errors),
                ("sets of checks at every step", got_checks, own_checks),
            ])?;
        }
        Ok(())
    }

    /// Adds to the traces the results that cannot be computed from the rows: error estimates, changes of the
    /// reference orbit, and outcomes of goals.
    pub(super) fn conclude(&mut self) {
        let local = self.equations.loads.local_reference();
        let rereferenced = local.map_or_else(Vec::new, |local| local.times.clone());
        for number in 0..self.systems.len() {
            let estimates = self.estimates(number);
            let EquationsOfMotion { trees, members, .. } = &self.equations;
            let model = &members.system(number, trees, &self.state.trees).1.model;
            let run = &mut self.systems[number];
            let results = run.goal_results(model);
            let trace = &mut run.recorder.trace;
            estimates.write(trace);
            (trace.rereferenced, trace.results) = (rereferenced.clone(), results);
        }
    }

    /// Returns the error estimates of the system with index `number` over the whole run.
    fn estimates(&self, number: usize) -> Estimates {
        let members = &self.equations.members;
        let place = members.places[number];
        let tree = members.tree_at(place);
        let control = self.mover.save().0;
        let rotation_error = control.map(|control| control.trees[tree].rotation_error);
        let estimates = self.accuracy.estimates(tree, self.steps, rotation_error);
        let estimates = match place {
            Place::Tree(_) => estimates,
            Place::Part(part) => estimates.of_part(&members.parts[part].member.joints),
        };
        match &self.systems[number].settled {
            Some(settled) => estimates.after(settled),
            None => estimates,
        }
    }

    /// Stores the error estimates of each system so far, before the trees change.
    pub(super) fn conclude_trees(&mut self) {
        for number in 0..self.systems.len() {
            let estimates = self.estimates(number);
            self.systems[number].settled = Some(estimates);
        }
    }
}
