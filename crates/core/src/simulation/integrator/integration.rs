//! Integration of the equations of motion over an interval with the integrator of the run.

use super::dormand_prince::DormandPrince;
use super::rk4::{BaseStages, rk4};
use super::semi_implicit_euler::semi_implicit_euler;
use super::settings::{Integrator, StepSettings};
use super::stages::Stages;
use super::tolerance::StepControl;
use crate::simulation::equations::EquationsOfMotion;
use crate::simulation::error::SimulationError;
use crate::simulation::external_loads::ExternalLoads;
use crate::simulation::state::State;
use crate::spatial::Real;

/// Integrator of a run with its buffers.
pub(crate) struct Integration<S> {
    integrator: Integrator,
    pub(crate) stages: Stages<S>,
    /// Motion of each base over the stages of RK4.
    bases: Vec<BaseStages<S>>,
    /// Additional stages and step control of the adaptive integrator.
    dormand_prince: Option<Box<DormandPrince<S>>>,
}

impl<S: Real> Integration<S> {
    pub(crate) fn new(state: &State<S>, settings: &StepSettings) -> Self {
        let stages = Stages::new(state);
        let bases = state.trees.iter().map(|_| BaseStages::new()).collect();
        let is_adaptive = settings.integrator == Integrator::DormandPrince;
        let dormand_prince = is_adaptive.then(|| Box::new(DormandPrince::new(&stages.rate, settings)));
        Self { integrator: settings.integrator, stages, bases, dormand_prince }
    }

    /// Advances `state` from the start of `interval`, s, to its end, or as far as the tolerance permits.
    /// Returns the time reached, s. Requires the kinematics and loads of `state` in `equations`.
    pub(crate) fn advance(
        &mut self,
        equations: &mut EquationsOfMotion<'_, S, impl ExternalLoads<S>>,
        state: &mut State<S>,
        interval: (f64, f64),
    ) -> Result<f64, SimulationError> {
        match &mut self.dormand_prince {
            Some(method) => method.adaptive_step(&mut self.stages, equations, state, interval),
            None => self.step(equations, state, interval).map(|()| interval.1),
        }
    }

    /// Advances `state` over the whole of `interval`, s, in one step. Requires the kinematics and loads of
    /// `state` in `equations`.
    pub(crate) fn step(
        &mut self,
        equations: &mut EquationsOfMotion<'_, S, impl ExternalLoads<S>>,
        state: &mut State<S>,
        interval: (f64, f64),
    ) -> Result<(), SimulationError> {
        self.stages.evaluate_first(equations, state);
        match (&mut self.dormand_prince, self.integrator) {
            (Some(method), _) => method.step(&mut self.stages, equations, state, interval)?,
            (None, Integrator::SemiImplicitEuler) => {
                semi_implicit_euler(&mut self.stages, equations, state, interval);
            }
            (None, _) => rk4(&mut self.stages, &mut self.bases, equations, state, interval)?,
        }
        self.stages.finish(equations, state);
        Ok(())
    }

    /// Writes the state at `t`, s, within the last step of the adaptive integrator to `state`. The base twist
    /// is not projected onto the momentum. Fixed-step integrators have no dense output and leave `state`
    /// unchanged.
    pub(crate) fn interpolate(&mut self, t: f64, state: &mut State<S>) {
        if let Some(method) = &self.dormand_prince {
            method.interpolate(&mut self.stages, t, state);
        }
    }

    /// Returns true if the integrator is RK4.
    pub(crate) fn is_rk4(&self) -> bool {
        self.integrator == Integrator::Rk4
    }

    /// Returns true if the tolerance determines the length of steps.
    pub(crate) fn is_adaptive(&self) -> bool {
        self.dormand_prince.is_some()
    }

    /// Returns the state of the step control; `None` for a fixed-step integrator.
    pub(crate) fn control(&self) -> Option<&StepControl> {
        self.dormand_prince.as_ref().map(|method| &method.control)
    }

    /// Continues with the step size and the error of a step control that was used with different trees.
    pub(crate) fn continue_from(&mut self, before: StepControl) {
        if let Some(method) = &mut self.dormand_prince {
            (method.control.step, method.control.error) = (before.step, before.error);
        }
    }

    /// Restores the state of the step control.
    pub(crate) fn set_control(&mut self, control: StepControl) {
        if let Some(method) = &mut self.dormand_prince {
            method.control = control;
        }
    }
}
