//! Controllers, recorder and brakes of one system of a run.

use super::checkpoint::SystemControllers;
use super::controllers::Controllers;
use super::environment_loads::EnvironmentLoads;
use super::error::SimulationError;
use super::estimates::Estimates;
use super::recorder::Recorder;
use super::trace::GoalResult;
use super::tree::Tree;
use super::tree_state::TreeState;
use crate::model::Model;
use crate::orbit::OrbitState;
use crate::spatial::Scalar;
use crate::world::{Brake, Member};

/// Controllers, recorder and brakes of one system.
pub(super) struct RunSystem<'a, S> {
    pub(super) controllers: Controllers<'a, S>,
    pub(super) recorder: Recorder,
    /// Torques, `(n,)`, N m or N, and requested accelerations, `(n,)`, rad/s² or m/s², that were held before
    /// the last trial step that updated the controllers; `None` if no trial step has updated them.
    pub(super) held: Option<(Vec<S>, Vec<Option<f64>>)>,
    /// True if an update of the controllers is due at the start of the current step.
    pub(super) is_due: bool,
    /// Indices in the group of the systems whose models the controllers know.
    pub(super) knows: Vec<usize>,
    /// Places of the systems in the tree whose model the controllers use. Empty until a known system is
    /// connected for the first time; ignored while none is connected.
    pub(super) known_members: Vec<Member>,
    /// Error estimates of the previous trees that contained the system; `None` if its tree has never changed.
    pub(super) settled: Option<Estimates>,
    /// Brakes of the system; their fields `is_engaged` are kept up to date.
    pub(super) brakes: Vec<Brake>,
}

impl<S: Scalar> RunSystem<'_, S> {
    /// Adds a row at `t`, s, without the acceleration, for a state whose kinematics are in `system`. `orbit`
    /// is the state of the reference orbit.
    pub(super) fn add_row(
        &mut self,
        t: f64,
        state: &TreeState<S>,
        system: &Tree<'_, S>,
        loads: &mut EnvironmentLoads,
        orbit: Option<OrbitState>,
    ) -> Result<(), SimulationError> {
        let Self { controllers, recorder, .. } = self;
        recorder.record_state(t, state, system, orbit, controllers.desired(t, state, system)?);
        recorder.record_tracking(&controllers.set);
        recorder.record_wrenches(&system.model, loads, t)
    }

    /// Returns the state of the controllers and the torques of `system`.
    pub(super) fn save_controllers(
        &self,
        system: &Tree<'_, S>,
    ) -> Result<SystemControllers, SimulationError> {
        Ok(SystemControllers {
            command: system.command.iter().map(|x| x.value()).collect(),
            commanded: self.controllers.set.commanded().to_vec(),
            requested: system.modes.requested().to_vec(),
            held: self
                .held
                .as_ref()
                .map(|(command, requested)| (command.iter().map(|x| x.value()).collect(), requested.clone())),
            controls: self.controllers.set.save()?,
        })
    }

    /// Restores the state that [`RunSystem::save_controllers`] returned.
    pub(super) fn load_controllers(
        &mut self,
        saved: SystemControllers,
        system: &mut Tree<'_, S>,
    ) -> Result<(), SimulationError> {
        let SystemControllers { command, commanded, requested, held, controls } = saved;
        let lift = |command: Vec<f64>| command.into_iter().map(S::of).collect();
        self.held = held.map(|(command, requested)| (lift(command), requested));
        system.command.iter_mut().zip(command).for_each(|(to, from)| *to = S::of(from));
        self.controllers.set.command(&commanded);
        system.modes.requested_mut().copy_from_slice(&requested);
        Ok(self.controllers.set.load(&controls)?)
    }

    /// Returns the present outcomes of the goals of the controls.
    pub(super) fn goal_results(&self, model: &Model) -> Vec<GoalResult> {
        let set = &self.controllers.set;
        let with_goal = set.controls().iter().enumerate().filter(|(_, control)| control.goal.is_some());
        with_goal
            .map(|(i, control)| {
                let outcome = set.outcome(i);
                let component = outcome.miss().map(|miss| match control.law.task() {
                    Some(_) => ["position", "attitude"][miss.component].to_owned(),
                    None if control.law.grip().is_some() => "force".to_owned(),
                    None => model.joints()[control.joints[miss.component]].name.clone(),
                });
                GoalResult { name: control.name.clone(), outcome, component }
            })
            .collect()
    }
}
