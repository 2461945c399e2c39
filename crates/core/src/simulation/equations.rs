//! Equations of motion of all trees of a run, with which the time derivatives of the state are computed from
//! the state, the loads and the joint torques.

use super::common_center::{move_to_own_centers, orbital_moment, refer_to_common_center};
use super::contacts::{Contacts, Hold, Touched, at_time};
use super::error::SimulationError;
use super::external_loads::ExternalLoads;
use super::latch::Latch;
use super::members::Members;
use super::state::{Rate, State};
use super::tree::Tree;
use crate::dynamics::{Data, kinetic_energy};
use crate::spatial::Real;

/// Equations of motion of all trees under external loads and constant joint torques.
///
/// Every evaluation computes first the kinematics of all trees, then the loads for all trees together, and
/// then the time derivatives for each tree.
pub(crate) struct EquationsOfMotion<'a, S, W> {
    /// The trees, in the order of the run.
    pub(crate) trees: Vec<Tree<'a, S>>,
    /// Places of the systems in the trees.
    pub(crate) members: Members<'a, S>,
    /// Latches whose captures have not happened.
    pub(super) latches: Vec<Latch>,
    pub(super) contacts: Contacts,
    pub(crate) loads: W,
}

impl<'a, S: Real, W: ExternalLoads<S>> EquationsOfMotion<'a, S, W> {
    /// Creates the equations of motion of systems that are not connected: each of `trees` is one system.
    pub(crate) fn new(trees: Vec<Tree<'a, S>>, loads: W) -> Self {
        let (members, latches, contacts) = (Members::alone(trees.len()), Vec::new(), Contacts::default());
        Self { trees, members, latches, contacts, loads }
    }

    /// Computes the kinematics of `state` and projects every base twist onto the momentum of its tree.
    pub(crate) fn project_momentum(&mut self, state: &mut State<S>) {
        for (tree, state) in self.trees.iter_mut().zip(&mut state.trees) {
            tree.project_momentum(state);
        }
    }

    /// Computes the kinematics of `state` in W.
    pub(crate) fn update_kinematics(&mut self, state: &State<S>) {
        for (tree, state) in self.trees.iter_mut().zip(&state.trees) {
            tree.update_kinematics(state);
        }
    }

    /// Restores the kinematics and loads at the start of a step after a trial step has overwritten them.
    pub(super) fn restore(&mut self, start: &[Data<S>]) {
        for (tree, start) in self.trees.iter_mut().zip(start) {
            tree.restore(start);
        }
    }

    /// Computes the external wrenches on all trees at time `t`, s, in a step over `interval`, s: those of the
    /// environment and those of the contacts. Requires the kinematics of `state` in the trees.
    #[inline]
    pub(crate) fn apply_loads(
        &mut self,
        t: f64,
        interval: (f64, f64),
        state: &State<S>,
    ) -> Result<(), SimulationError> {
        if self.contacts.is_empty() {
            return self.apply_environment(t, interval, state);
        }
        if self.loads.is_active() {
            self.apply_environment(t, interval, state)?;
        } else {
            self.trees.iter_mut().for_each(|tree| tree.data.clear_external());
        }
        self.contacts.add_forces(&mut self.trees, state).map_err(at_time(t))
    }

    /// Computes the wrenches of the environment alone; see [`Self::apply_loads`].
    #[inline]
    pub(crate) fn apply_environment(
        &mut self,
        t: f64,
        interval: (f64, f64),
        state: &State<S>,
    ) -> Result<(), SimulationError> {
        if !self.loads.is_active() {
            return Ok(()); // the wrenches on all bodies remain zero
        }
        self.loads.apply(&mut self.trees, &mut self.members, state, t, interval)
    }

    /// Computes the time derivatives of `state`. Requires the kinematics and loads of `state` in the trees.
    pub(crate) fn rates(&mut self, state: &State<S>, rate: &mut Rate<S>) {
        let has_contacts = !self.contacts.is_empty();
        let is_loaded = has_contacts || self.loads.is_active();
        for ((tree, state), rate) in self.trees.iter_mut().zip(&state.trees).zip(&mut rate.trees) {
            tree.rates(state, is_loaded, rate);
        }
        if self.trees.len() > 1 {
            self.refer_moments(state, rate);
        }
        if has_contacts {
            self.contacts.rates(&mut rate.contacts);
        }
    }

    /// Refers the moments in `rate` to the common centre of mass of the trees.
    #[inline(never)]
    fn refer_moments(&self, state: &State<S>, rate: &mut Rate<S>) {
        if !self.contacts.is_empty() {
            refer_to_common_center(&self.trees, state, rate);
        } else if self.loads.is_active() {
            rate.orbital = orbital_moment(&self.trees, state, rate);
        }
    }

    /// Computes the kinematics, the loads and the time derivatives for a stage after the first.
    pub(crate) fn evaluate(
        &mut self,
        t: f64,
        interval: (f64, f64),
        state: &mut State<S>,
        rate: &mut Rate<S>,
    ) -> Result<(), SimulationError> {
        for (tree, state) in self.trees.iter_mut().zip(&mut state.trees) {
            tree.update_stage_kinematics(state);
        }
        self.apply_loads(t, interval, state)?;
        self.rates(state, rate);
        Ok(())
    }

    /// Completes a step from `start` to `state`: in a run with contacts, refers the angular impulses of the
    /// trees to their own centres of mass.
    pub(super) fn end_step(&self, start: &State<S>, state: &mut State<S>) {
        if !self.contacts.is_empty() && self.trees.len() > 1 {
            move_to_own_centers(&self.trees, start, state);
        }
    }

    /// Initializes the states of the contacts and checks that bodies overlap only where their contact permits
    /// it. `names` contains the names of the systems for error messages. Requires the kinematics of `state`
    /// in the trees.
    pub(super) fn start_contacts(
        &self,
        names: &[String],
        state: &mut State<S>,
    ) -> Result<(), SimulationError> {
        Ok(self.contacts.start(names, &self.trees, state)?)
    }

    /// Determines the modes of the contacts for the step from `t` to `end`, s, and returns the end of the
    /// step, which may be earlier than `end` while bodies touch or approach each other. The function reduces
    /// the contact states in `state` to those of the pairs that may touch. Requires the kinematics of `state`
    /// in the trees.
    pub(super) fn begin_contacts(
        &mut self,
        t: f64,
        end: f64,
        state: &mut State<S>,
    ) -> Result<f64, SimulationError> {
        if self.contacts.is_empty() {
            return Ok(end);
        }
        self.contacts.begin((t, end), &self.trees, state).map_err(at_time(t))
    }

    /// Determines whether an impact between bodies with an impact law occurs at `t`, s, and whether such
    /// bodies begin to rest on each other. Requires the kinematics of `state` in the trees.
    pub(super) fn touched(&mut self, t: f64, state: &State<S>) -> Result<Touched, SimulationError> {
        if !self.contacts.has_impact_laws() {
            return Ok(Touched::default());
        }
        self.contacts.touched(&self.trees, state).map_err(at_time(t))
    }

    /// Applies the impacts between bodies with an impact law at `t`, s. If `t` is `None`, no touches are
    /// recorded. If `is_endless` is true, the impacts have no restitution. See [`Contacts::strike`].
    pub(super) fn strike(
        &mut self,
        t: Option<f64>,
        state: &mut State<S>,
        is_endless: bool,
    ) -> Result<(), SimulationError> {
        if !self.contacts.has_impact_laws() {
            return Ok(());
        }
        self.contacts.strike(t, &mut self.trees, state, is_endless).map_err(at_time(t.unwrap_or_default()))
    }

    /// Corrects the forces between bodies that rest on each other, and returns the largest change of a
    /// velocity, m/s; see [`Contacts::correct`].
    pub(super) fn correct_forces(
        &mut self,
        hold: &mut Hold,
        t: f64,
        state: &State<S>,
    ) -> Result<f64, SimulationError> {
        self.contacts.correct(hold, &self.trees, state).map_err(at_time(t))
    }

    /// Returns true if a joint of any tree has friction, stops or a brake, if there is a latch whose capture
    /// has not happened, or if bodies may touch.
    pub(crate) fn has_modes(&self) -> bool {
        !self.latches.is_empty()
            || !self.contacts.is_empty()
            || self.trees.iter().any(|tree| tree.modes.is_active())
    }

    /// Returns the smallest margin of any latch or contact to its next change at `state` and `t`, s. The
    /// margin is negative beyond the change, and infinite without latches and contacts. If there are latches
    /// or contacts, writes the kinematics of `state` relative to W to the trees.
    pub(super) fn margin(&mut self, t: f64, state: &State<S>) -> Result<f64, SimulationError> {
        if self.latches.is_empty() && self.contacts.is_empty() {
            return Ok(f64::INFINITY);
        }
        self.update_kinematics(state);
        let margin = |latch: &Latch| latch.margin(latch.inside(&self.trees, &state.trees));
        let latches = self.latches.iter().map(margin).fold(f64::INFINITY, f64::min);
        let contacts = self.contacts.margin(&self.trees, state).map_err(at_time(t))?;
        Ok(latches.min(contacts))
    }

    /// Returns two sums over all trees, J: the kinetic energy less the work, which changes only by the error
    /// of the integrator, and the kinetic energy plus the magnitude of the work. Requires the kinematics of
    /// `state` relative to W in the trees.
    pub(super) fn energy_balance(&self, state: &State<S>) -> [S; 2] {
        let (mut balance, mut scale) = (S::of(0.0), S::of(0.0));
        for (tree, state) in self.trees.iter().zip(&state.trees) {
            let energy = kinetic_energy(&tree.model, &tree.data, &state.v);
            balance += energy - state.work;
            scale += energy + state.work.abs();
        }
        [balance, scale]
    }

    /// Returns true if a joint of any tree is locked.
    pub(super) fn any_locked(&self) -> bool {
        self.trees.iter().any(|tree| tree.modes.locked().is_some())
    }

    /// Determines the modes of all joints for the step that starts at `state`. Requires the kinematics and
    /// loads of `state` in the trees.
    pub(crate) fn solve_modes(&mut self, state: &State<S>) {
        for (tree, state) in self.trees.iter_mut().zip(&state.trees) {
            tree.solve_modes(&state.q, &state.v);
        }
    }
}
