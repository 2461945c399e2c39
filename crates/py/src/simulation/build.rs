//! Construction of simulations from Python arguments.

use super::Any;
use crate::arrays::type_name;
use crate::earth::PyEarth;
use crate::environment::{PyEffect, SurfaceAssignment, Target};
use crate::errors::{IntoPython, fields, raise};
use crate::gravity::gravity_of;
use crate::model::PyModel;
use crate::orbit::PyOrbit;
use crate::reference::Around;
use crate::world::{PyWorld, RobotSettings, initial_state};
use onorbit_core::environment::GravityMode;
use onorbit_core::simulation::{Integrator, Simulation};
use onorbit_core::world::System;
use pyo3::exceptions::PyTypeError;
use pyo3::prelude::*;
use std::sync::Arc;

/// Creates the simulation of a world with the default integrator settings. `given` states for each argument
/// that applies only to a robot whether it was given; such an argument is an error.
pub(super) fn of_world(world: &Bound<'_, PyWorld>, given: &[(&str, bool)]) -> PyResult<Simulation> {
    if let Some((name, _)) = given.iter().find(|(_, is_given)| *is_given) {
        return Err(PyTypeError::new_err(format!(
            "{name} is given to Simulation with a World, but it belongs to the world or to its systems; give \
             {name} to World or to System"
        )));
    }
    world.get().simulation(world.py())
}

/// Orbit, Earth, gravity mode and effects of a simulation, as given in Python.
type Surroundings<'a, 'py> =
    (Option<&'a Bound<'py, PyOrbit>>, Option<&'a Bound<'py, PyEarth>>, &'a str, &'a [Bound<'py, PyEffect>]);

/// Creates the simulation of a robot with the default integrator settings.
pub(super) fn of_robot(
    model: Any<'_, '_>,
    (q, v): (Option<Any<'_, '_>>, Option<Any<'_, '_>>),
    (orbit, earth, gravity_mode, environment): Surroundings<'_, '_>,
    settings: &RobotSettings,
) -> PyResult<Simulation> {
    let py = model.py();
    let Ok(model) = model.cast::<PyModel>() else {
        let got = type_name(model);
        return Err(PyTypeError::new_err(format!("model is of type {got}; expected a Model or a World")));
    };
    let (Some(q), Some(v)) = (q, v) else {
        return Err(PyTypeError::new_err(
            "q or v, the initial state of the Model, is missing; give both q and v",
        ));
    };
    let model = model.get();
    let (q, v) = initial_state(py, &model.model, q, v)?;
    let mut simulation = Simulation::new(Arc::clone(&model.model), q, v);
    simulation.orbit = orbit.map(|orbit| Arc::clone(&orbit.get().orbit));
    simulation.earth = earth.map(|earth| earth.get().in_axes_of(simulation.orbit.as_deref()));
    simulation.gravity_mode = gravity_mode_named(py, gravity_mode)?;
    set_environment(py, &mut simulation, environment, &[None])?;
    let orbit = simulation.orbit.clone();
    let around = Around { orbit: orbit.as_ref(), ..Around::default() };
    settings.apply(py, model, &around, &mut simulation.systems[0])?;
    Ok(simulation)
}

/// Sets the effects and the gravity of a simulation whose orbit and Earth have been set. `surfaces` are the
/// surfaces declared with each system.
pub(crate) fn set_environment(
    py: Python<'_>,
    simulation: &mut Simulation,
    environment: &[Bound<'_, PyEffect>],
    surfaces: &[Option<&SurfaceAssignment>],
) -> PyResult<()> {
    let systems = simulation.systems.iter().zip(surfaces);
    let targets: Vec<Target<'_>> = systems
        .map(|(System { name, model, .. }, surfaces)| Target { name, model, surfaces: *surfaces })
        .collect();
    for (number, own) in surfaces.iter().enumerate() {
        own.map_or(Ok(()), |own| own.on_robot(py, &targets, number).map(drop))?; // reports errors even if no effect uses the surfaces
    }
    let on_systems = environment.iter().filter_map(|effect| PyEffect::on(effect, &targets).transpose());
    simulation.effects = on_systems.collect::<PyResult<_>>()?;
    let mu = simulation.orbit.as_ref().and_then(|orbit| orbit.mu());
    let of_orbit = simulation.orbit.as_ref().and_then(|orbit| orbit.gravity());
    let given = gravity_of(py, environment, mu, simulation.earth.as_ref())?;
    if let (Some(orbit), Some(earth)) = (&simulation.orbit, &simulation.earth) {
        earth.check_orbit(orbit.axes(), orbit.epoch()).map_err(|error| error.into_python(py))?;
    }
    let shared = given.map(|given| match of_orbit {
        Some(of_orbit) => given.shared_with(of_orbit),
        None => Ok(Arc::new(given)),
    });
    simulation.gravity = shared.transpose().map_err(|error| error.into_python(py))?;
    Ok(())
}

pub(crate) fn gravity_mode_named(py: Python<'_>, name: &str) -> PyResult<GravityMode> {
    match name {
        "true" => Ok(GravityMode::True),
        "carried" => Ok(GravityMode::Carried),
        other => {
            let message = format!("gravity_mode is '{other}'; it must be 'true' or 'carried'");
            Err(raise(py, "InputError", &message, &fields!(py, "name": "gravity_mode", "got": other)))
        }
    }
}

pub(crate) fn integrator_named(py: Python<'_>, name: &str) -> PyResult<Integrator> {
    match name {
        "rk4" => Ok(Integrator::Rk4),
        "semi_implicit_euler" => Ok(Integrator::SemiImplicitEuler),
        "dormand_prince" => Ok(Integrator::DormandPrince),
        other => {
            let hint = if other.eq_ignore_ascii_case("euler") {
                "; did you mean 'semi_implicit_euler'?"
            } else {
                ""
            };
            let message = format!(
                "integrator is '{other}'; it must be 'rk4', 'semi_implicit_euler' or 'dormand_prince'{hint}"
            );
            Err(raise(py, "InputError", &message, &fields!(py, "name": "integrator", "got": other)))
        }
    }
}
