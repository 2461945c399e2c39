//! Asking the controller for torques.

use super::checkpoint::{CheckpointError, ControlMemory};
use super::error::SimulationError;
use super::plant::Plant;
use super::schedule::SAME_INSTANT;
use super::state::State;
use super::surroundings::Surroundings;
use crate::control::{
    ComputedTorque, ComputedTorqueWork, ControlError, ControlLaw, Controller, Law, Observation, Stack,
    computed_torque,
};
use crate::dynamics::Data;
use crate::model::Model;
use crate::reference::{TaskReference, TaskSample};
use crate::spatial::Scalar;

/// The controller of a run with what it needs between calls.
pub(super) enum Driver<'a, S> {
    None,
    ComputedTorque {
        law: &'a ComputedTorque,
        reference: &'a TaskReference,
        work: Box<ComputedTorqueWork<S>>,
        /// When it was asked last, and what the reference wanted then.
        last: Option<(f64, TaskSample<f64>)>,
    },
    User {
        controller: &'a mut dyn Controller,
        reference: Option<&'a TaskReference>,
        joints: Vec<usize>,
        buffers: [Vec<f64>; 3],
    },
    Stack(Box<Stack<'a, S>>),
}

impl<'a, S: Scalar> Driver<'a, S> {
    pub(super) fn new(
        control: &'a mut ControlLaw,
        reference: Option<&'a TaskReference>,
        model: &Model,
        time_step: f64,
    ) -> Result<Self, SimulationError> {
        Ok(match (control, reference) {
            (ControlLaw::None, _) => Self::None,
            (ControlLaw::ComputedTorque(law), Some(reference)) => {
                let work = Box::new(ComputedTorqueWork::new(model));
                Self::ComputedTorque { law, reference, work, last: None }
            }
            (ControlLaw::ComputedTorque(_), None) => return Err(SimulationError::NeedsReference),
            (ControlLaw::User(controller), reference) => {
                controller.reset()?;
                let buffers = [model.nq(), model.nv(), model.joint_count()].map(|n| vec![0.0; n]);
                let joints = (0..model.joint_count()).collect();
                Self::User { controller: controller.as_mut(), reference, joints, buffers }
            }
            (ControlLaw::Stack(controls), _) => {
                Self::Stack(Box::new(Stack::new(controls, model, SAME_INSTANT * time_step)?))
            }
        })
    }

    /// Expects the friction of an external engine, which creeps through rest.
    pub(super) fn expect_creeping_friction(&mut self) {
        if let Self::Stack(stack) = self {
            stack.expect_creeping_friction();
        }
    }

    /// Whether the law wants the external wrenches in the plant's data when it is asked.
    pub(super) fn compensates(&self) -> bool {
        match self {
            Self::ComputedTorque { law, .. } => law.compensate_environment,
            Self::Stack(stack) => stack.compensates_environment(),
            _ => false,
        }
    }

    /// The controls of a run that has several.
    pub(super) fn stack(&self) -> Option<&Stack<'a, S>> {
        if let Self::Stack(stack) = self { Some(stack) } else { None }
    }

    /// Where the tool of the run should be at `t`, and whether that is relative to the base. Needs kinematics
    /// of `state`.
    pub(super) fn desired(
        &mut self,
        t: f64,
        state: &State<S>,
        plant: &Plant<'_, S, Surroundings>,
        (tool, reference): (Option<usize>, Option<&TaskReference>),
    ) -> Result<Option<(TaskSample<f64>, bool)>, SimulationError> {
        if let Self::Stack(stack) = self {
            stack.look(t, plant.model, &plant.data, &state.q, &state.v)?;
        }
        if let Some(reference) = reference {
            let sample = match self {
                Self::ComputedTorque { last: Some((asked, sample)), .. } if *asked == t => *sample,
                _ => at(reference, t)?,
            };
            return Ok(Some((sample, reference.is_relative_to_base())));
        }
        Ok(self.stack().and_then(|stack| {
            stack.controls().iter().enumerate().find_map(|(i, control)| {
                let (_, reference) = control.task().filter(|(frame, _)| Some(*frame) == tool)?;
                Some((stack.desired(i)?, reference.is_relative_to_base()))
            })
        }))
    }

    /// What the controllers remember.
    pub(super) fn save(&self) -> Result<ControlMemory, ControlError> {
        let mut memory = ControlMemory::default();
        match self {
            Self::Stack(stack) => {
                let mut numbers = Vec::new();
                stack.save(&mut numbers);
                memory.bits = numbers.into_iter().map(f64::to_bits).collect();
                let laws = stack.controls().iter().map(|control| &control.law);
                for law in laws {
                    if let Law::User(controller, _) = law {
                        memory.users.push(controller.save()?);
                    }
                }
            }
            Self::User { controller, .. } => memory.users.push(controller.save()?),
            Self::None | Self::ComputedTorque { .. } => {}
        }
        Ok(memory)
    }

    /// Takes up what [`Driver::save`] gave.
    pub(super) fn load(&mut self, memory: &ControlMemory) -> Result<(), SimulationError> {
        let mut users: Vec<&mut dyn Controller> = Vec::new();
        match self {
            Self::Stack(stack) => {
                let numbers: Vec<f64> = memory.bits.iter().map(|bits| f64::from_bits(*bits)).collect();
                stack.load(&numbers)?;
                users.extend(stack.user_controllers());
            }
            Self::User { controller, .. } => users.push(&mut **controller),
            Self::None | Self::ComputedTorque { .. } => {}
        }
        let (got, expected) = (memory.users.len(), users.len());
        if got != expected {
            return Err(CheckpointError::OtherSize { name: "controllers", got, expected }.into());
        }
        users.into_iter().zip(&memory.users).try_for_each(|(user, saved)| user.load(saved))?;
        Ok(())
    }

    /// Whether the law is one of ours.
    pub(super) fn is_built_in(&self) -> bool {
        matches!(self, Self::ComputedTorque { .. } | Self::Stack(_)) // what a user returns is checked by the stack
    }

    /// Puts new torques into the plant, whose kinematics are those of `state`.
    pub(super) fn ask(
        &mut self,
        t: f64,
        state: &State<S>,
        plant: &mut Plant<'_, S, Surroundings>,
    ) -> Result<(), SimulationError> {
        let Plant { model, data, command, contacts, .. } = plant;
        match self {
            Self::None => return Ok(()),
            Self::ComputedTorque { law, reference, work, last } => {
                let sample = at(reference, t)?;
                *last = Some((t, sample));
                let desired = sample.lift();
                let data: &mut Data<S> = data;
                let is_relative = reference.is_relative_to_base();
                computed_torque(law, model, data, &state.q, &state.v, &desired, is_relative, work, command);
                work.ask(law, contacts.asked_mut());
            }
            Self::User { controller, reference, joints, buffers: [q, v, tau] } => {
                q.iter_mut().zip(&state.q).for_each(|(to, from)| *to = from.value());
                v.iter_mut().zip(&state.v).for_each(|(to, from)| *to = from.value());
                let desired = reference.map(|reference| at(reference, t)).transpose()?;
                controller.update(&Observation { time: t, q, v, model, joints, desired }, tau)?;
                command.iter_mut().zip(tau.iter()).for_each(|(to, from)| *to = S::of(*from));
            }
            Self::Stack(stack) => {
                stack.update(t, model, data, &state.q, &state.v, command)?;
                contacts.asked_mut().copy_from_slice(stack.asked());
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
fn at(reference: &TaskReference, t: f64) -> Result<TaskSample<f64>, SimulationError> {
    reference.sample(t, 0.0).map_err(|source| SimulationError::Reference { time: t, source })
}
