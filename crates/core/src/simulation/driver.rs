//! Asking the controller for torques.

use super::error::SimulationError;
use super::plant::Plant;
use super::state::State;
use super::surroundings::Surroundings;
use crate::control::{
    ComputedTorque, ComputedTorqueWork, ControlError, ControlLaw, Controller, Observation, computed_torque,
};
use crate::dynamics::Data;
use crate::model::Model;
use crate::reference::{TaskReference, TaskSample};
use crate::spatial::Scalar;

/// The controller of a run with what it needs between calls.
pub(super) enum Driver<'a, S> {
    None,
    ComputedTorque { law: &'a ComputedTorque, reference: &'a TaskReference, work: Box<ComputedTorqueWork<S>> },
    User { controller: &'a mut dyn Controller, reference: Option<&'a TaskReference>, buffers: [Vec<f64>; 3] },
}

impl<'a, S: Scalar> Driver<'a, S> {
    pub(super) fn new(
        control: &'a mut ControlLaw,
        reference: Option<&'a TaskReference>,
        model: &Model,
    ) -> Result<Self, SimulationError> {
        Ok(match (control, reference) {
            (ControlLaw::None, _) => Self::None,
            (ControlLaw::ComputedTorque(law), Some(reference)) => {
                Self::ComputedTorque { law, reference, work: Box::new(ComputedTorqueWork::new(model)) }
            }
            (ControlLaw::ComputedTorque(_), None) => return Err(SimulationError::NeedsReference),
            (ControlLaw::User(controller), reference) => {
                controller.reset()?;
                let buffers = [model.nq(), model.nv(), model.joint_count()].map(|n| vec![0.0; n]);
                Self::User { controller: controller.as_mut(), reference, buffers }
            }
        })
    }

    /// Whether the law wants the external wrenches in the plant's data when it is asked.
    pub(super) fn compensates(&self) -> bool {
        matches!(self, Self::ComputedTorque { law, .. } if law.compensate_environment)
    }

    /// Whether the law is one of ours.
    pub(super) fn is_built_in(&self) -> bool {
        matches!(self, Self::ComputedTorque { .. })
    }

    /// Puts new torques into the plant, whose kinematics are those of `state`.
    pub(super) fn ask(
        &mut self,
        t: f64,
        state: &State<S>,
        plant: &mut Plant<'_, S, Surroundings>,
    ) -> Result<(), SimulationError> {
        let Plant { model, data, command, .. } = plant;
        match self {
            Self::None => return Ok(()),
            Self::ComputedTorque { law, reference, work } => {
                let desired = at(reference, t)?.lift();
                let data: &mut Data<S> = data;
                computed_torque(law, model, data, &state.q, &state.v, &desired, work, command);
            }
            Self::User { controller, reference, buffers: [q, v, tau] } => {
                q.iter_mut().zip(&state.q).for_each(|(to, from)| *to = from.value());
                v.iter_mut().zip(&state.v).for_each(|(to, from)| *to = from.value());
                let desired = reference.map(|reference| at(reference, t)).transpose()?;
                controller.update(&Observation { time: t, q, v, model, desired }, tau)?;
                command.iter_mut().zip(tau.iter()).for_each(|(to, from)| *to = S::of(*from));
            }
        }
        match command.iter().position(|tau| !tau.value().is_finite()) {
            Some(joint) if !matches!(self, Self::None) => {
                let value = command[joint].value();
                Err(ControlError::TorqueNotFinite { joint, time: t, value }.into())
            }
            _ => Ok(()),
        }
    }
}

/// What the reference of the run wants at `t`.
pub(super) fn at(reference: &TaskReference, t: f64) -> Result<TaskSample<f64>, SimulationError> {
    reference.sample(t, 0.0).map_err(|source| SimulationError::Reference { time: t, source })
}
