//! What a run is made of.

use super::engine::Engine;
use super::integrator::Integrator;
use crate::control::ControlLaw;
use crate::earth::Earth;
use crate::environment::{Effect, ReferenceMotion};
use crate::gravity::Gravity;
use crate::model::Model;
use crate::orbit::Orbit;
use crate::reference::TaskReference;
use std::sync::Arc;

/// A robot, where it starts, what acts on it and how time is cut.
///
/// An orbit brings gravity: the differential pull on every body is always on around a planet.
pub struct Simulation {
    /// The robot.
    pub model: Arc<Model>,
    /// Configuration at the start, `(nq,)`.
    pub q: Vec<f64>,
    /// Velocity at the start, `(nv,)`.
    pub v: Vec<f64>,
    /// Reference orbit; W's origin rides on it.
    pub orbit: Option<Arc<dyn Orbit>>,
    /// Gravity on robot and reference; the orbit's point mass if none.
    pub gravity: Option<Arc<Gravity>>,
    /// How the Earth turns; effects that need to know refuse to act if none.
    pub earth: Option<Arc<Earth>>,
    /// Whether the robot falls away from a reference that does not fall freely, or is carried along.
    pub reference_motion: ReferenceMotion,
    /// Effects beside gravity.
    pub effects: Vec<Arc<dyn Effect>>,
    /// What drives the joints.
    pub control: ControlLaw,
    /// Index of the frame to record, and to compare with the reference.
    pub tool: Option<usize>,
    /// What the tool should do.
    pub reference: Option<TaskReference>,
    /// How far from the tool the reference may start: m, rad.
    pub reference_start_tolerance: [f64; 2],
    /// Step, s.
    pub time_step: f64,
    /// Time between two calls of the controller, s; every step if none.
    pub control_period: Option<f64>,
    /// Another engine that moves the robot in the place of our own equations; it has its own integrator, friction and
    /// stops, and stays about the reference of the run.
    pub engine: Option<Box<dyn Engine>>,
    /// How to step.
    pub integrator: Integrator,
    /// Error that a step of the adaptive integrator may make, as a share: of a radian in attitude and
    /// joints, of the robot's size (or distance from W's origin) in lengths, of themselves in rates.
    pub tolerance: f64,
    /// Keeps the joints within their position limits by rigid stops, which give back this share of the
    /// rate; joints pass them if none.
    pub stops: Option<f64>,
    /// How far the base may drift from the reference before it gets one of its own, m: where gravity pulls, nothing
    /// carries the robot and no control looks at W.
    pub rereference_beyond: f64,
    /// Whether rows hold the wrench of every effect on every body.
    pub record_wrenches: bool,
    /// Every how many steps a row is recorded.
    pub record_every: usize,
}

impl Simulation {
    /// A robot alone in W, no control, RK4 with a step of 1 ms, every step recorded.
    pub fn new(model: Arc<Model>, q: Vec<f64>, v: Vec<f64>) -> Self {
        Self {
            model,
            q,
            v,
            orbit: None,
            gravity: None,
            earth: None,
            reference_motion: ReferenceMotion::True,
            effects: Vec::new(),
            control: ControlLaw::None,
            tool: None,
            reference: None,
            reference_start_tolerance: [0.05, 0.1],
            time_step: 1e-3,
            control_period: None,
            engine: None,
            integrator: Integrator::Rk4,
            tolerance: 1e-9,
            stops: None,
            rereference_beyond: 1e5,
            record_wrenches: false,
            record_every: 1,
        }
    }
}
