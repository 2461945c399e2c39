//! Settings of a simulation.

use super::engine::Engine;
use super::integrator::Integrator;
use crate::contact::{Contact, ContactSteps};
use crate::earth::Earth;
use crate::environment::{Effect, GravityMode};
use crate::gravity::Gravity;
use crate::model::Model;
use crate::orbit::Orbit;
use crate::world::{Event, System};
use std::sync::Arc;

/// Simulation of one robot, or of a world of several systems, with initial states, environment, controls and
/// integrator.
///
/// If there is an orbit around a planet, differential gravity acts on every body.
pub struct Simulation {
    /// Systems of the world; usually a single robot.
    pub systems: Vec<System>,
    /// Events that connect and separate systems, or engage and disengage brakes.
    pub events: Vec<Event>,
    /// Contacts between the collision shapes of links.
    pub contacts: Vec<Contact>,
    /// Settings of the evaluation of contacts and of the length of steps while bodies touch.
    pub contact_steps: ContactSteps,
    /// Reference orbit, on which the origin of W moves; `None` for motion without gravity in an inertial
    /// frame W.
    pub orbit: Option<Arc<dyn Orbit>>,
    /// Gravity field of the run. `None` selects the field of the orbit or, if the orbit has none, that of a
    /// point mass.
    pub gravity: Option<Arc<Gravity>>,
    /// Rotation and epoch of the Earth, which some effects require; `None` if they are not known.
    pub earth: Option<Arc<Earth>>,
    /// Determines whether the systems fall freely and thus drift away from a reference orbit that is not in
    /// free fall (`True`), or move along with that orbit (`Carried`).
    pub gravity_mode: GravityMode,
    /// Effects in addition to gravity.
    pub effects: Vec<Arc<dyn Effect>>,
    /// Length of fixed steps and spacing of the grid, s.
    pub time_step: f64,
    /// External engine that replaces the native engine; `None` for the native engine. It has its own
    /// integrator, friction and stops, and no local reference orbit.
    pub engine: Option<Box<dyn Engine>>,
    /// Integrator of the native engine.
    pub integrator: Integrator,
    /// Permitted relative error of a step of the adaptive integrator. Errors of the attitude and of revolute
    /// joints are relative to 1 rad, those of lengths to the robot's size or its distance from the origin of
    /// W, and those of rates to the magnitude of the rates.
    pub tolerance: f64,
    /// Distance between the base and the reference orbit, m, beyond which integration continues about a local
    /// reference orbit in free fall. The reference orbit is kept in `Carried` mode, without gravity, with an
    /// external engine, for systems that may interact with others, and if a control or `reference` depends on
    /// the position in W.
    pub rereference_beyond: f64,
    /// True if the wrench of every effect on every body is recorded.
    pub record_wrenches: bool,
    /// Number of grid steps from one recorded row to the next.
    pub record_every: usize,
}

impl Simulation {
    /// Creates a simulation of one robot with the initial configuration `q` and velocity `v`, without
    /// environment and controls. It uses RK4 with steps of 1 ms, each of which is recorded.
    pub fn new(model: Arc<Model>, q: Vec<f64>, v: Vec<f64>) -> Self {
        let name = model.name().to_owned();
        Self::of(vec![System::new(&name, model, q, v)])
    }

    /// Creates a simulation of several systems with the default settings of [`Simulation::new`].
    pub fn of(systems: Vec<System>) -> Self {
        Self {
            systems,
            events: Vec::new(),
            contacts: Vec::new(),
            contact_steps: ContactSteps::default(),
            orbit: None,
            gravity: None,
            earth: None,
            gravity_mode: GravityMode::True,
            effects: Vec::new(),
            time_step: 1e-3,
            engine: None,
            integrator: Integrator::Rk4,
            tolerance: 1e-9,
            rereference_beyond: 1e5,
            record_wrenches: false,
            record_every: 1,
        }
    }
}
