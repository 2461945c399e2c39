//! Choice between the native engine and an external engine, which advance the trees over a step.

use super::environment_loads::EnvironmentLoads;
use super::equations::EquationsOfMotion;
use super::error::SimulationError;
use super::external_engine::ExternalEngine;
use super::integrator::{Integration, StepControl};
use super::modes::StepMethod;
use super::recorder::Recorder;
use super::state::State;
use super::tree_state::TreeState;
use crate::model::Model;
use crate::spatial::Scalar;

type Equations<'a, S> = EquationsOfMotion<'a, S, EnvironmentLoads>;

/// Native engine or external engine of a run. The order of execution in a step is the same for both. With an
/// external engine, every system remains a separate tree even while it is connected to others.
pub(super) enum Mover<'a, S> {
    Native(StepMethod<S>),
    External(ExternalEngine<'a>),
}

impl<S: Scalar> Mover<'_, S> {
    /// Computes the kinematics of `state`. With the native engine, base twists are projected onto the
    /// momentum; with an external engine, they do not change.
    pub(super) fn kinematics(&self, equations: &mut Equations<'_, S>, state: &mut State<S>) {
        match self {
            Self::Native(_) => equations.project_momentum(state),
            Self::External(_) => equations.update_kinematics(state),
        }
    }

    /// Applies the impacts between bodies with an impact law, and those of joints that move into their stops,
    /// at `t`, s. `t` is `None` for a copy of the state, whose touches are not recorded. Does nothing with an
    /// external engine, which handles stops itself.
    pub(super) fn resolve_impacts(
        &self,
        equations: &mut Equations<'_, S>,
        state: &mut State<S>,
        t: Option<f64>,
    ) -> Result<(), SimulationError> {
        match self {
            Self::Native(method) => method.resolve_impacts(equations, state, t),
            Self::External(_) => Ok(()),
        }
    }

    /// Computes the forces between bodies with an impact law that rest on each other, for a step over
    /// `interval`, s. Returns true if bodies have separated. Does nothing with an external engine.
    pub(super) fn hold_contacts(
        &mut self,
        equations: &mut Equations<'_, S>,
        state: &mut State<S>,
        interval: (f64, f64),
    ) -> Result<bool, SimulationError> {
        match self {
            Self::Native(method) if equations.contacts.has_resting() => {
                method.hold_contacts(equations, state, interval)
            }
            Self::Native(_) | Self::External(_) => Ok(false),
        }
    }

    /// Computes which joints stick, slip or rest at a stop during the step. With an external engine, computes
    /// the friction compensation instead.
    pub(super) fn solve_modes(&self, equations: &mut Equations<'_, S>, state: &State<S>) {
        match self {
            Self::Native(_) => equations.solve_modes(state),
            Self::External(_) => {
                for (tree, state) in equations.trees.iter_mut().zip(&state.trees) {
                    tree.modes.compensate_by_rate(&state.v);
                }
            }
        }
    }

    pub(super) fn is_external(&self) -> bool {
        matches!(self, Self::External(_))
    }

    pub(super) fn is_adaptive(&self) -> bool {
        matches!(self, Self::Native(method) if method.integration.is_adaptive())
    }

    /// Returns true if a single step may take a long time to compute.
    pub(super) fn has_long_steps(&self) -> bool {
        self.is_external() || self.is_adaptive()
    }

    /// Returns true if a step may end before the end of its interval.
    pub(super) fn may_end_early(&self, equations: &Equations<'_, S>) -> bool {
        match self {
            Self::Native(_) => equations.has_modes() || self.is_adaptive(),
            Self::External(_) => !equations.contacts.is_empty(),
        }
    }

    /// Advances `state` from the start of `interval`, s, towards its end. Returns the time reached, s.
    pub(super) fn advance(
        &mut self,
        equations: &mut Equations<'_, S>,
        state: &mut State<S>,
        interval: (f64, f64),
    ) -> Result<f64, SimulationError> {
        match self {
            Self::Native(method) => method.advance(equations, state, interval),
            Self::External(engine) => {
                engine.advance(&equations.trees, state, interval)?;
                engine.add_exchanged(&equations.contacts, state);
                Ok(interval.1)
            }
        }
    }

    /// Returns the acceleration of the tree with index `number` at the start of the last step, `(nv,)`, m/s²
    /// and rad/s²; `None` with an external engine.
    pub(super) fn first_acceleration(&self, number: usize) -> Option<&[S]> {
        match self {
            Self::Native(method) => Some(&method.integration.stages.first[number].acceleration),
            Self::External(_) => None,
        }
    }

    /// Adds the acceleration at the start of the last step to the last row in `recorder`, which belongs to
    /// the tree with index `number`. If an external engine returned no acceleration, removes the row instead.
    pub(super) fn complete_row(&self, number: usize, recorder: &mut Recorder, model: &Model) {
        match self {
            Self::Native(method) => {
                recorder.record_acceleration(model, &method.integration.stages.first[number].acceleration);
            }
            Self::External(engine) => engine.complete_row(number, recorder, model),
        }
    }

    /// Adds the force and the power at the start of the last step to the last row of the contact `name`, if
    /// an external engine computes its force.
    pub(super) fn complete_contact(&self, contact: usize, name: &str, recorder: &mut Recorder) {
        if let Self::External(engine) = self
            && let Some(done) = engine.contact(contact)
        {
            recorder.record_contact_force(name, done);
        }
    }

    /// Returns the work done on the tree with index `number` in the last step less the energy dissipated in
    /// its joints, J; `state` is the state at the end of the step.
    pub(super) fn work_of_step(&self, number: usize, state: &TreeState<S>) -> f64 {
        match self {
            Self::Native(method) => (state.work - method.integration.stages.start.trees[number].work).value(),
            Self::External(engine) => engine.work_of_step(number),
        }
    }

    /// Returns the integrator of the native engine; `None` for an external engine.
    pub(super) fn integration(&mut self) -> Option<&mut Integration<S>> {
        match self {
            Self::Native(method) => Some(&mut method.integration),
            Self::External(_) => None,
        }
    }

    /// Returns the state that [`Mover::restore`] restores: the adaptive step control (`None` for other
    /// methods), the number of consecutive idle steps, and whether the elastic energy of contacts has jumped
    /// in the last step.
    pub(super) fn save(&self) -> (Option<StepControl>, usize, bool) {
        match self {
            Self::Native(method) => {
                (method.integration.control().cloned(), method.idle_steps, method.has_jumped)
            }
            Self::External(_) => (None, 0, false),
        }
    }

    /// Restores the state returned by [`Mover::save`].
    pub(super) fn restore(&mut self, (control, idle_steps, has_jumped): (Option<StepControl>, usize, bool)) {
        if let Self::Native(method) = self {
            (method.idle_steps, method.has_jumped) = (idle_steps, has_jumped);
            if let Some(control) = control {
                method.integration.set_control(control);
            }
        }
    }

    /// Returns the index of the first tree whose state is not finite, in `state` or in the last stage of the
    /// integrator; `None` if all are finite.
    pub(super) fn first_diverged(&self, state: &State<S>) -> Option<usize> {
        state.trees.iter().enumerate().position(|(number, state)| match self {
            Self::Native(method) => !state.is_finite() || !method.integration.stages.is_finite(number),
            Self::External(_) => !state.is_finite(),
        })
    }

    /// Returns the configuration and the velocity in the last finite state of the tree with index `number`.
    /// With the native engine, this is the state at the start of the step if `state` is not finite; otherwise
    /// it is `state`.
    pub(super) fn last_finite(&self, number: usize, state: &State<S>) -> [Vec<f64>; 2] {
        let current = &state.trees[number];
        match self {
            Self::Native(method) if !current.is_finite() => method.integration.stages.start_state(number),
            _ => current.values(),
        }
    }
}
