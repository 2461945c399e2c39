//! System of a world: one robot with its initial state, controls and brakes.

use super::brake::Brake;
use crate::control::Control;
use crate::model::Model;
use crate::reference::{MovingFrame, TaskReference};
use std::sync::Arc;

/// System of a world, such as a spacecraft: its model, initial state, controls and brakes.
pub struct System {
    /// Name, which is unique in the world.
    pub name: String,
    /// Model of the robot.
    pub model: Arc<Model>,
    /// Initial configuration, `(nq,)`: position of the base in W, m, its quaternion (x, y, z, w), then joint
    /// positions, rad or m.
    pub q: Vec<f64>,
    /// Initial velocity, `(nv,)`: linear and angular velocity of the base in base axes, m/s and rad/s, then
    /// joint rates, rad/s or m/s.
    pub v: Vec<f64>,
    /// Controls of the joints. A joint without an active control has no motor torque, unless the caller of a
    /// stepper commands one.
    pub controls: Vec<Control>,
    /// Time between two updates of the controllers, s; `None` selects the length of a regular step.
    pub control_period: Option<f64>,
    /// Index of the frame whose pose is recorded and compared with the reference; `None` for a system without
    /// a tool.
    pub tool: Option<usize>,
    /// Reference of the tool that is recorded for comparison, although no control needs to track it; `None`
    /// if only the references of controls are recorded.
    pub reference: Option<TaskReference>,
    /// Largest accepted distance, m, and angle, rad, between a frame and the start of its reference. The
    /// second entry also applies to references of joint positions, rad or m.
    pub reference_start_tolerance: [f64; 2],
    /// Indices in the world of the systems whose models the controllers know. While such a system is
    /// connected to this one, control laws use the model of the connected tree.
    pub knows: Vec<usize>,
    /// Coefficient of restitution, from 0 to 1, of rigid stops at the position limits of joints; `None` if
    /// the joints have no stops.
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

    /// Creates a system that has no controls, tool, reference, stops or brakes and knows no other system.
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
