//! References integrated in the full gravity field.

use super::{Any, PyOrbit, base, vector};
use crate::arrays::{array_of, type_name};
use crate::earth::PyEarth;
use crate::environment::{PyEffect, effects};
use crate::errors::{IntoPython, fields, raise};
use crate::gravity::gravity_of;
use crate::interrupt::prepare;
use nalgebra::Vector3;
use onorbit_core::gravity::Gravity;
use onorbit_core::orbit::{Axes, MU_EARTH, Numerical, Orbit, OrbitError};
use pyo3::prelude::*;
use pyo3::types::PyList;
use std::sync::Arc;

/// An orbit integrated in the full gravity field: through ``r`` (3,) m with ``v`` (3,) m/s at ``t0`` s, inertial axes.
///
/// ``environment`` is a list with what of it is gravity (``GravityField``, ``ThirdBody``; a point mass ``mu``, m³/s², where
/// there is none), ``earth`` how the planet turns, ``axes`` the inertial ones, ``GCRF`` or ``TEME``. Integrated as far as it is asked for, by collocation of order 16: a LEO day
/// is good to a micrometre. Raises ``OrbitError`` from the time on at which it enters the planet.
#[pyclass(name = "Numerical", extends = PyOrbit, frozen, module = "onorbit_rs")]
pub(crate) struct PyNumerical;

#[pymethods]
impl PyNumerical {
    #[new]
    #[pyo3(signature = (r, v, *, t0=0.0, environment=None, earth=None, mu=None, axes="GCRF"))]
    fn new(
        py: Python<'_>,
        r: Any<'_, '_>,
        v: Any<'_, '_>,
        t0: f64,
        environment: Option<&Bound<'_, PyAny>>,
        earth: Option<&Bound<'_, PyEarth>>,
        mu: Option<f64>,
        axes: &str,
    ) -> PyResult<PyClassInitializer<Self>> {
        let start = (vector(r, "r")?, vector(v, "v")?, t0);
        let axes = match axes {
            "GCRF" => Axes::Gcrf,
            "TEME" => Axes::Teme,
            other => {
                let message = format!("axes is '{other}'; there are 'GCRF' and 'TEME'");
                return Err(raise(py, "InputError", &message, &fields!(py, "name": "axes", "got": other)));
            }
        };
        made(py, start, axes, effects(environment)?, earth, mu)
    }

    /// The orbit that leaves from where ``orbit`` is at ``t0`` s, in its axes; ``mu`` is its own where not given.
    #[staticmethod]
    #[pyo3(signature = (orbit, *, t0=0.0, environment=None, earth=None, mu=None))]
    fn from_orbit<'py>(
        py: Python<'py>,
        orbit: &Bound<'py, PyOrbit>,
        t0: f64,
        environment: Option<&Bound<'py, PyAny>>,
        earth: Option<&Bound<'py, PyEarth>>,
        mu: Option<f64>,
    ) -> PyResult<Bound<'py, Self>> {
        let orbit = &orbit.get().orbit;
        prepare(py, &**orbit, &[t0])?;
        let (r, v) = orbit.position_velocity(t0).map_err(|error| error.into_python(py))?;
        let environment = effects(environment)?;
        let brings_mu = environment.iter().any(|effect| effect.get().field().is_some());
        let mu = mu.or_else(|| if brings_mu { None } else { orbit.mu() });
        Bound::new(py, made(py, (r, v, t0), orbit.axes(), environment, earth, mu)?)
    }

    fn __repr__(&self) -> &'static str {
        "<Numerical>"
    }
}

fn made(
    py: Python<'_>,
    (r, v, t0): (Vector3<f64>, Vector3<f64>, f64),
    axes: Axes,
    environment: Vec<Bound<'_, PyEffect>>,
    earth: Option<&Bound<'_, PyEarth>>,
    mu: Option<f64>,
) -> PyResult<PyClassInitializer<PyNumerical>> {
    let turning = earth.map(|earth| Arc::new(earth.get().earth.in_axes(axes)));
    let others = environment.iter().filter(|effect| !effect.get().is_gravity());
    let others: Vec<_> = others.map(|effect| type_name(effect)).collect();
    if !others.is_empty() {
        let message = format!(
            "{} would act on the robot, not on the reference, which falls freely: leave out what is no \
             GravityField or ThirdBody, and give it to the simulation",
            others.join(", ")
        );
        return Err(raise(py, "OrbitError", &message, &fields!(py, "name": "environment", "got": others)));
    }
    // a field brings its own
    let brings_mu = environment.iter().any(|effect| effect.get().field().is_some());
    let chosen = mu.or_else(|| (!brings_mu).then_some(MU_EARTH));
    if let Some(value) = chosen.filter(|mu| !(mu.is_finite() && *mu > 0.0)) {
        return Err(OrbitError::NotPositive { name: "mu", value }.into_python(py));
    }
    let gravity = gravity_of(py, &environment, chosen, turning.as_ref())?
        .unwrap_or_else(|| Gravity::point_mass(chosen.unwrap_or(MU_EARTH)));
    let numerical = Numerical::new(r, v, t0, Arc::new(gravity)).map_err(|error| error.into_python(py))?;
    let numerical = Arc::new(numerical.with_axes(axes)) as Arc<dyn Orbit>;
    let arguments = (array_of(py, &[3], r.as_slice()), array_of(py, &[3], v.as_slice())).into_pyobject(py)?;
    let keywords = fields!(
        py, "t0": t0, "environment": PyList::new(py, environment)?, "earth": earth, "mu": mu, "axes": axes.name(),
    );
    let orbit = base(numerical, "Numerical", &arguments, &keywords)?;
    Ok(PyClassInitializer::from(orbit).add_subclass(PyNumerical))
}
