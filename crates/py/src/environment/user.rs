//! Effects written in Python.

use super::PyEffect;
use super::target::Target;
use crate::arrays::{Input, array_of, finite, type_name, wrong_shape};
use crate::errors::{fields, raise};
use nalgebra::Vector3;
use onorbit_core::environment::{
    BodyIndex, BodyState, Effect, EnvironmentError, Scene, UserError, Wrench, Wrenches,
};
use pyo3::prelude::*;
use std::sync::Arc;

/// States of all K bodies at one instant, which an effect written in Python receives. The arrays are copies.
#[pyclass(name = "BodyStates", frozen, get_all, module = "onorbit_rs")]
pub(crate) struct PyBodies {
    /// Names of the bodies: their links, or ``SYSTEM/LINK`` in a world of several systems. The bodies of each
    /// system begin with its base.
    names: Vec<String>,
    /// Masses, (K,), kg.
    mass: Py<PyAny>,
    /// Positions of the centres of mass in W, (K, 3), m.
    position: Py<PyAny>,
    /// Rotation matrices from body axes to W axes, (K, 3, 3).
    rotation: Py<PyAny>,
    /// Velocities of the centres of mass relative to W, (K, 3), W axes, m/s.
    velocity: Py<PyAny>,
    /// Angular velocities, (K, 3), W axes, rad/s.
    angular_velocity: Py<PyAny>,
    /// Position of the reference orbit, at which W has its origin, from the planet's centre, (3,), inertial axes,
    /// m. None without an orbit.
    orbit_position: Option<Py<PyAny>>,
    /// Velocity of the reference orbit, (3,), inertial axes, m/s. None without an orbit.
    orbit_velocity: Option<Py<PyAny>>,
}

/// Effect of the core that calls the method `wrenches(t, bodies)` of a Python object.
#[derive(Debug)]
pub(super) struct PythonEffect {
    object: Py<PyEffect>,
    /// Name of the class.
    name: String,
    /// Names of the bodies of every system of the world.
    names: Vec<Vec<String>>,
    event_times: Vec<f64>,
}

impl PythonEffect {
    /// Creates the effect for the bodies of `targets`.
    pub(super) fn new(object: &Bound<'_, PyEffect>, targets: &[Target<'_>]) -> PyResult<Self> {
        let (py, name) = (object.py(), type_name(object.as_any()));
        if object.getattr_opt("wrenches")?.is_none() {
            let message = format!(
                "{name} has no method wrenches(t, bodies); define it so that it returns a (K, 6) array of the forces, N, \
                 and torques, N m, on the K bodies"
            );
            return Err(raise(py, "EffectError", &message, &fields!(py, "name": "wrenches", "got": &name)));
        }
        let path = |target: &Target<'_>, body: usize| {
            let link = &target.model.body_frame(body).name;
            if targets.len() == 1 { link.clone() } else { format!("{}/{link}", target.name) }
        };
        let bodies =
            |target: &Target<'_>| (0..target.model.nodes().len()).map(|body| path(target, body)).collect();
        let event_times = match object.getattr_opt("event_times")? {
            Some(times) => {
                let times = times.call0()?;
                let input = Input::new(&times, &format!("the times returned by {name}.event_times"))?;
                finite(py, "event_times", input.data())?;
                input.data().to_vec()
            }
            None => Vec::new(),
        };
        let names = targets.iter().map(bodies).collect();
        Ok(Self { object: object.clone().unbind(), name, names, event_times })
    }

    /// Returns the wrenches that the Python object computes for `bodies`.
    fn call(&self, scene: &Scene<'_>, bodies: &[(BodyIndex, BodyState)]) -> PyResult<Vec<Wrench>> {
        Python::attach(|py| {
            let object = self.object.bind(py);
            let state = Bound::new(py, self.state(py, scene, bodies))?;
            let result = object.call_method1("wrenches", (scene.time, state))?;
            let name = format!("the array returned by {}.wrenches", self.name);
            let wrenches = Input::new(&result, &name)?;
            if wrenches.shape() != [bodies.len(), 6] {
                let expected = format!("({}, 6), a force and a torque per body", bodies.len());
                return Err(wrong_shape(py, &name, &expected, wrenches.shape()));
            }
            finite(py, &name, wrenches.data())?;
            let wrench = |row: &[f64]| Wrench {
                force: Vector3::from_column_slice(&row[..3]),
                torque: Vector3::from_column_slice(&row[3..]),
            };
            Ok(wrenches.data().chunks_exact(6).map(wrench).collect())
        })
    }

    fn state(&self, py: Python<'_>, scene: &Scene<'_>, bodies: &[(BodyIndex, BodyState)]) -> PyBodies {
        let count = bodies.len();
        let array = |shape: &[usize], data: &[f64]| array_of(py, shape, data).into_any().unbind();
        let vectors = |of: fn(&BodyState) -> Vector3<f64>| {
            let data: Vec<f64> = bodies.iter().flat_map(|(_, body)| of(body).data.0[0]).collect();
            array(&[count, 3], &data)
        };
        let masses: Vec<f64> = bodies.iter().map(|(_, body)| body.mass).collect();
        let rotations = bodies.iter().flat_map(|(_, body)| body.rot_wk.transpose().data.0.concat());
        let orbit = scene.reference.map(|reference| reference.state);
        let of_orbit = |vector: Vector3<f64>| array(&[3], vector.as_slice());
        PyBodies {
            names: bodies.iter().map(|(index, _)| self.names[index.system][index.body].clone()).collect(),
            mass: array(&[count], &masses),
            position: vectors(|body| body.com),
            rotation: array(&[count, 3, 3], &rotations.collect::<Vec<_>>()),
            velocity: vectors(|body| body.velocity),
            angular_velocity: vectors(|body| body.angular_velocity),
            orbit_position: orbit.map(|state| of_orbit(state.position)),
            orbit_velocity: orbit.map(|state| of_orbit(state.velocity)),
        }
    }
}

impl Effect for PythonEffect {
    fn name(&self) -> &str {
        &self.name
    }

    fn event_times(&self) -> Vec<f64> {
        self.event_times.clone()
    }

    fn add_wrenches(&self, scene: &Scene<'_>, wrenches: &mut Wrenches) -> Result<(), EnvironmentError> {
        let bodies: Vec<_> = scene.bodies.iter().collect();
        let found = self.call(scene, &bodies).map_err(|error| UserError(Arc::new(error)))?;
        for ((index, _), wrench) in bodies.iter().zip(found) {
            wrenches.add(*index, wrench)?;
        }
        Ok(())
    }
}
