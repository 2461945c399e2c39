//! The class `World`.

use super::event::{events_in, events_of, names_of};
use super::loops::close_systems;
use super::system::PySystem;
use crate::arrays::list_of;
use crate::contact::{PyContact, contacts_in, contacts_of};
use crate::earth::PyEarth;
use crate::environment::{PyEffect, effects};
use crate::errors::{IntoPython, SimulationErrorExt, fields, raise};
use crate::model::PyModel;
use crate::model::closed_loop::loops_in;
use crate::orbit::PyOrbit;
use crate::pickling::{ConstructorCall, Reduced};
use crate::reference::Around;
use crate::simulation::{gravity_mode_named, set_environment};
use onorbit_core::contact::Contact;
use onorbit_core::number_text::{names, short};
use onorbit_core::simulation::Simulation;
use onorbit_core::world::{System, WorldError, idle_knowledge};
use pyo3::exceptions::PyUserWarning;
use pyo3::prelude::*;
use pyo3::types::PyDict;
use std::ffi::CString;
use std::sync::Arc;

/// World of one or more systems on one reference orbit, with their environment and events.
///
/// Parameters
/// ----------
/// systems : list of System
///     Systems, each of which is a spacecraft with a unique name.
/// orbit : Orbit, optional
///     Reference orbit, on which the origin of W moves. An orbit around a planet adds gravity on every body.
/// earth : Earth, optional
///     Epoch and orientation of the Earth.
/// gravity_mode : {"true", "carried"}
///     Behaviour for a reference orbit that is not in free fall, as for ``Simulation``.
/// environment : list of Effect, optional
///     Effects on the bodies of all systems; links are named ``SYSTEM/LINK``.
/// contacts : list of Contact, optional
///     Contacts between links.
/// events : list of Capture, Release, Engage and Disengage, optional
///     Events that connect and separate systems, or engage and disengage brakes.
/// rereference_beyond : float
///     Distance of a system from the reference orbit, m, beyond which integration continues about a new
///     reference orbit. Systems that may interact, for example because events may connect them or because
///     they may touch, keep their reference orbit.
/// loops : list of Loop, optional
///     Closed loops of the robots; both frames of a loop are ``SYSTEM/FRAME`` of the same system.
///
/// Raises
/// ------
/// WorldError, FrameError, ModelError
///     If a system, a contact, an event or a loop is invalid.
/// InputError, OrbitError, EarthError, GravityError, EffectError, ControlError
///     If a number, the orbit, the Earth, the environment or a controller is invalid, as for ``Simulation``.
#[pyclass(name = "World", frozen, module = "onorbit_rs")]
pub(crate) struct PyWorld {
    systems: Vec<Py<PySystem>>,
    orbit: Option<Py<PyOrbit>>,
    earth: Option<Py<PyEarth>>,
    gravity_mode: String,
    pub(crate) environment: Vec<Py<PyEffect>>,
    pub(crate) contacts: Vec<Py<PyContact>>,
    events: Vec<Py<PyAny>>,
    rereference_beyond: f64,
}

#[pymethods]
impl PyWorld {
    #[new]
    #[pyo3(signature = (
        systems, *, orbit=None, earth=None, gravity_mode="true", environment=None, contacts=None, events=None,
        rereference_beyond=1e5, loops=None,
    ))]
    fn new(
        py: Python<'_>,
        systems: &Bound<'_, PyAny>,
        orbit: Option<Py<PyOrbit>>,
        earth: Option<Py<PyEarth>>,
        gravity_mode: &str,
        environment: Option<&Bound<'_, PyAny>>,
        contacts: Option<&Bound<'_, PyAny>>,
        events: Option<&Bound<'_, PyAny>>,
        rereference_beyond: f64,
        loops: Option<&Bound<'_, PyAny>>,
    ) -> PyResult<Self> {
        let systems = list_of::<PySystem>(systems, "systems", "systems, such as [oo.System(…)]")?;
        let systems = close_systems(py, &systems, &loops.map_or(Ok(Vec::new()), loops_in)?)?;
        let contacts = contacts.map_or(Ok(Vec::new()), contacts_in)?;
        let events = events.map_or(Ok(Vec::new()), events_in)?;
        let environment = effects(environment)?.into_iter().map(Bound::unbind).collect();
        let world = Self {
            systems,
            orbit,
            earth,
            gravity_mode: gravity_mode.to_owned(),
            environment,
            contacts,
            events,
            rereference_beyond,
        };
        let simulation = world.simulation(py)?;
        simulation.check().map_err(|error| error.into_python_with(py, None))?;
        warn_of_distance(py, &simulation)?;
        warn_of_knowledge(py, &simulation)?;
        warn_of_pairs(py, &simulation)?;
        Ok(world)
    }

    /// Names of the systems.
    #[getter]
    fn names(&self) -> Vec<String> {
        self.systems.iter().map(|system| system.get().name.clone()).collect()
    }

    fn __reduce__<'py>(&self, py: Python<'py>) -> PyResult<Reduced<'py>> {
        let keywords = PyDict::new(py);
        keywords.set_item("orbit", &self.orbit)?;
        keywords.set_item("earth", &self.earth)?;
        keywords.set_item("gravity_mode", &self.gravity_mode)?;
        keywords.set_item("environment", &self.environment)?;
        keywords.set_item("contacts", &self.contacts)?;
        keywords.set_item("events", &self.events)?;
        keywords.set_item("rereference_beyond", self.rereference_beyond)?;
        ConstructorCall::new("World", (&self.systems,), &keywords)?.reduce(py)
    }

    fn __repr__(&self) -> String {
        format!("<World: {}>", self.names().join(", "))
    }
}

impl PyWorld {
    /// Returns the reference orbit, or `None` if the world has no reference orbit.
    pub(crate) fn orbit(&self, py: Python<'_>) -> Option<Py<PyOrbit>> {
        self.orbit.as_ref().map(|orbit| orbit.clone_ref(py))
    }

    /// Returns the controller of each system, or `None` for a system without one.
    pub(crate) fn controllers(&self) -> impl Iterator<Item = Option<&Py<PyAny>>> {
        self.systems.iter().map(|system| system.get().settings.controller.as_ref())
    }

    /// Returns the model of the system `name`; an unknown name is an error.
    pub(crate) fn model_of<'py>(&self, py: Python<'py>, name: &str) -> PyResult<Bound<'py, PyModel>> {
        let system = self.systems.iter().find(|system| system.get().name == name);
        system.map(|system| system.get().model.bind(py).clone()).ok_or_else(|| {
            let message = format!("there is no system '{name}'; {}", names(&self.names(), "system"));
            raise(py, "WorldError", &message, &fields!(py, "name": name, "got": name))
        })
    }

    /// Creates a simulation of the world with the default integrator settings.
    pub(crate) fn simulation(&self, py: Python<'_>) -> PyResult<Simulation> {
        let orbit = self.orbit.as_ref().map(|orbit| Arc::clone(&orbit.get().orbit));
        let names = names_of(py, &self.events)?;
        let model = |system: &Py<PySystem>| Arc::clone(&system.get().model.get().model);
        let models: Vec<_> =
            self.systems.iter().map(|system| (system.get().name.clone(), model(system))).collect();
        let around = Around { orbit: orbit.as_ref(), events: &names, systems: &models };
        let systems = self.systems.iter().map(|system| system.get().system(py, &around));
        let mut systems = systems.collect::<PyResult<Vec<_>>>()?;
        for (number, system) in self.systems.iter().enumerate() {
            systems[number].knows = known_systems(py, system.get(), &self.names())?;
        }
        let brakes = |system: &System| system.brakes.iter().map(|brake| brake.name.clone()).collect();
        let brakes: Vec<_> = systems.iter().map(|system| (system.name.clone(), brakes(system))).collect();
        let events = events_of(py, &self.events, &names, &models, &brakes)?;
        let contacts = contacts_of(py, &self.contacts, &models)?;
        if systems.is_empty() {
            return Err(WorldError::NoSystems.into_python(py));
        }
        let mut simulation = Simulation::of(systems);
        simulation.events = events;
        simulation.contacts = contacts;
        simulation.earth = self.earth.as_ref().map(|earth| earth.get().in_axes_of(orbit.as_deref()));
        simulation.orbit = orbit;
        simulation.gravity_mode = gravity_mode_named(py, &self.gravity_mode)?;
        simulation.rereference_beyond = self.rereference_beyond;
        let environment: Vec<_> = self.environment.iter().map(|effect| effect.bind(py).clone()).collect();
        let surfaces: Vec<_> = self.systems.iter().map(|system| system.get().surfaces.as_ref()).collect();
        set_environment(py, &mut simulation, &environment, &surfaces)?;
        Ok(simulation)
    }
}

/// Returns the indices of the systems whose models a system knows; `names` are the names of all systems.
fn known_systems(py: Python<'_>, system: &PySystem, names: &[String]) -> PyResult<Vec<usize>> {
    let number = |known: &String| {
        let others = || names.iter().filter(|name| **name != system.name).map(String::as_str);
        names.iter().position(|name| name == known && *name != system.name).ok_or_else(|| {
            let others = others().collect::<Vec<_>>().join(", ");
            let hint = if others.is_empty() {
                "there is no other system".to_owned()
            } else {
                format!("choose from: {others}")
            };
            let message = format!(
                "the system '{}' knows '{known}', which is not another system of the world; {hint}",
                system.name
            );
            raise(py, "WorldError", &message, &fields!(py, "name": &system.name, "got": known))
        })
    };
    system.knows.iter().map(number).collect()
}

/// Issues a warning for each system whose model another system knows without effect.
fn warn_of_knowledge(py: Python<'_>, simulation: &Simulation) -> PyResult<()> {
    let name = |system: usize| &simulation.systems[system].name;
    for idle in idle_knowledge(&simulation.systems, &simulation.events) {
        let (system, known) = (name(idle.system), name(idle.known));
        let through: Vec<String> = idle.through.iter().map(|&system| format!("'{}'", name(system))).collect();
        let through = through.join(" and ");
        let message = if through.is_empty() {
            format!(
                "system '{system}' knows '{known}' without effect, because no capture connects them; add a \
                 capture, or remove '{known}' from knows"
            )
        } else {
            format!(
                "system '{system}' knows '{known}' without effect, because captures connect them only \
                 through {through}; add {through} to knows"
            )
        };
        PyErr::warn(py, &py.get_type::<PyUserWarning>(), &CString::new(message)?, 1)?;
    }
    Ok(())
}

/// Number of pairs of convex pieces in a world above which a warning is issued.
const MANY_PAIRS: usize = 2000;

/// Issues a warning about the contact with the most pairs of convex pieces if there are more than
/// [`MANY_PAIRS`] pairs in total.
fn warn_of_pairs(py: Python<'_>, simulation: &Simulation) -> PyResult<()> {
    let pairs = |contact: &Contact| contact.sides.iter().map(Vec::len).product::<usize>();
    let total: usize = simulation.contacts.iter().map(pairs).sum();
    let Some(most) = simulation.contacts.iter().filter(|_| total > MANY_PAIRS).max_by_key(|one| pairs(one))
    else {
        return Ok(());
    };
    let [a, b] = [0, 1].map(|side| most.sides[side].len());
    let message = format!(
        "the contacts have {total} pairs of convex pieces; the contact with the most pairs is '{}', whose \
         sides have {a} and {b} pieces; each pair needs about 3 kB of memory, and pairs near each other are \
         evaluated in every step; narrow the patterns to the links that can touch, such as SYSTEM/gripper* \
         instead of SYSTEM/*",
        most.name
    );
    PyErr::warn(py, &py.get_type::<PyUserWarning>(), &CString::new(message)?, 1)
}

/// Issues a warning for each system that starts so far from the reference orbit that its position loses
/// precision.
fn warn_of_distance(py: Python<'_>, simulation: &Simulation) -> PyResult<()> {
    for far in simulation.far_systems() {
        let reason =
            if far.keeps_reference { "; systems that may interact keep this reference orbit" } else { "" };
        let message = format!(
            "system '{}' starts {} m from the reference orbit, where positions are resolved to {} m{reason}; \
             use a reference orbit near the systems",
            simulation.systems[far.system].name,
            short(far.distance),
            short(far.resolution)
        );
        PyErr::warn(py, &py.get_type::<PyUserWarning>(), &CString::new(message)?, 1)?;
    }
    Ok(())
}
