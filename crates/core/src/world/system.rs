//! System of a world: one robot with its initial state and its controls.

use super::brake::Brake;
use crate::control::Control;
use crate::model::Model;
use crate::reference::{MovingFrame, TaskReference};
use std::sync::Arc;

/// System of a world, such as a spacecraft: its model, initial state and controls.
pub struct System {
    /// Name, which is unique in the world.
    pub name: String,
    /// Model of the robot.
    pub model: Arc<Model>,
    /// Initial configuration, `(nq,)`, m and rad.
    pub q: Vec<f64>,
    /// Initial velocity, `(nv,)`, m/s and rad/s.
    pub v: Vec<f64>,
    /// Controls of the joints. Joints without an active control have no motor torque, unless a stepper's
    /// caller commands one.
    pub controls: Vec<Control>,
    /// Time between two updates of the controllers, s; by default the controllers are updated at every step.
    pub control_period: Option<f64>,
    /// Index of the frame that is recorded and compared with the reference.
    pub tool: Option<usize>,
    /// Reference pose of the tool, recorded for comparison if no control tracks the tool.
    pub reference: Option<TaskReference>,
    /// Largest accepted distance and angle between the tool and the start of its reference, m and rad.
    pub reference_start_tolerance: [f64; 2],
    /// Numbers of those systems in the world whose models the controllers know. While they are connected to
    /// this system, laws that use a model use the model of the connected tree.
    pub knows: Vec<usize>,
    /// Coefficient of restitution of rigid stops at the position limits of joints; `None` for no stops.
    pub stops: Option<f64>,
    /// Brakes of joints.
    pub brakes: Vec<Brake>,
}

impl System {
    /// Returns the frames of other systems in which the references of this system are given.
    pub fn moving_frames(&self) -> impl Iterator<Item = &MovingFrame> {
        let tracked = self.controls.iter().filter_map(|control| Some(control.law.task()?.1));
        tracked.chain(&self.reference).filter_map(TaskReference::moving_frame)
    }

    /// Creates a system without controls.
    pub fn new(name: &str, model: Arc<Model>, q: Vec<f64>, v: Vec<f64>) -> Self {
        Self {
            name: name.to_owned(),
            model,
            q,
            v,
            controls: Vec::new(),
            control_period: None,
            tool: None,
            reference: None,
            reference_start_tolerance: [0.05, 0.1],
            knows: Vec::new(),
            stops: None,
            brakes: Vec::new(),
        }
    }
}
