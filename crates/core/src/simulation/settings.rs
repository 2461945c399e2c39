//! Settings of a simulation.

use super::engine::Engine;
use super::integrator::Integrator;
use crate::control::Control;
use crate::earth::Earth;
use crate::environment::{Effect, GravityMode};
use crate::gravity::Gravity;
use crate::model::Model;
use crate::orbit::Orbit;
use crate::reference::TaskReference;
use std::sync::Arc;

/// Simulation of one robot: model, initial state, environment, controls and integrator.
///
/// An orbit around a planet adds differential gravity on every body.
pub struct Simulation {
    /// The robot.
    pub model: Arc<Model>,
    /// Initial configuration, `(nq,)`, m and rad.
    pub q: Vec<f64>,
    /// Initial velocity, `(nv,)`, m/s and rad/s.
    pub v: Vec<f64>,
    /// Reference orbit, on which the origin of W moves.
    pub orbit: Option<Arc<dyn Orbit>>,
    /// Gravity field of the run; by default that of the orbit or, if the orbit has none, that of a point mass.
    pub gravity: Option<Arc<Gravity>>,
    /// Orientation of the Earth; required by the effects that depend on it.
    pub earth: Option<Arc<Earth>>,
    /// Determines whether the robot drifts away from a reference orbit that is not in free fall (`True`) or is
    /// carried along with it (`Carried`).
    pub gravity_mode: GravityMode,
    /// Effects in addition to gravity.
    pub effects: Vec<Arc<dyn Effect>>,
    /// Controls of the joints; joints without an active control have no motor torque by default.
    pub controls: Vec<Control>,
    /// Index of the frame that is recorded and compared with the reference.
    pub tool: Option<usize>,
    /// Reference pose of the tool, recorded for comparison if no control tracks the tool.
    pub reference: Option<TaskReference>,
    /// Largest distance and angle between the tool and the start of its reference, m and rad.
    pub reference_start_tolerance: [f64; 2],
    /// Length of fixed steps and spacing of the grid, s.
    pub time_step: f64,
    /// Time between two updates of the controllers, s; by default the controllers are updated at every step.
    pub control_period: Option<f64>,
    /// External engine in place of the native equations of motion. It has its own integrator, friction and stops, and
    /// no local reference.
    pub engine: Option<Box<dyn Engine>>,
    /// Integrator of the native equations of motion.
    pub integrator: Integrator,
    /// Permitted error of a step of the adaptive integrator, relative to one radian (attitude and joints), to the
    /// robot's size or distance from the origin of W (lengths), and to the rates.
    pub tolerance: f64,
    /// Coefficient of restitution of rigid stops at the position limits of joints; `None` for no stops.
    pub stops: Option<f64>,
    /// Distance of the base from the reference orbit, m, beyond which integration continues about a local reference
    /// orbit in free fall. The reference orbit is kept in `Carried` mode, without gravity, with an external engine,
    /// and if a control or `reference` depends on the position in W.
    pub rereference_beyond: f64,
    /// If true, the wrench of every effect on every body is recorded.
    pub record_wrenches: bool,
    /// Number of steps per recorded row.
    pub record_every: usize,
}

impl Simulation {
    /// Returns a simulation without environment and controls: RK4 with steps of 1 ms, each of which is recorded.
    pub fn new(model: Arc<Model>, q: Vec<f64>, v: Vec<f64>) -> Self {
        Self {
            model,
            q,
            v,
            orbit: None,
            gravity: None,
            earth: None,
            gravity_mode: GravityMode::True,
            effects: Vec::new(),
            controls: Vec::new(),
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
