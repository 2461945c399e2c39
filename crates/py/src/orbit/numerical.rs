//! Orbits integrated in a gravity field.

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

/// Orbit integrated numerically in a gravity field.
///
/// The integration uses collocation of order 16. It is extended, forwards or backwards, when a state beyond
/// the integrated span is requested. After one day in a low Earth orbit, its error is some micrometres.
///
/// Parameters
/// ----------
/// r : (3,) array
///     Position from the planet's centre at ``t0``, inertial axes, m.
/// v : (3,) array
///     Velocity at ``t0``, inertial axes, m/s.
/// t0 : float
///     Simulation time of the initial state, s.
/// environment : list of Effect, optional
///     Gravity effects (``GravityField``, ``ThirdBody``); other effects are rejected.
/// earth : Earth, optional
///     Orientation of the planet; required by a ``ThirdBody``, and by a ``GravityField`` of an order above 0.
/// mu : float, optional
///     Gravitational parameter, m³/s². If there is a ``GravityField``, its value is used, and the relative
///     difference of ``mu`` from it must not exceed 1e-5. Otherwise the default is the value of the Earth.
/// axes : {"GCRF", "TEME"}
///     Inertial axes of the position and the velocity.
///
/// Raises
/// ------
/// OrbitError
///     If an effect is not gravity, ``mu`` is not positive, or the orbit begins inside the planet. The
///     methods raise this error at times at which the orbit is inside the planet.
/// GravityError, EarthError
///     If the gravity effects contradict each other or ``mu``, or if they require an ``earth`` or an epoch.
/// InputError, ShapeError
///     If ``axes`` is unknown, or ``r`` or ``v`` is not finite or has the wrong shape.
#[pyclass(name = "Numerical", extends = PyOrbit, frozen, module = "onorbit_rs")]
pub(super) struct PyNumerical;

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
                let message = format!("axes is '{other}'; the choices are 'GCRF' and 'TEME'");
                return Err(raise(py, "InputError", &message, &fields!(py, "name": "axes", "got": other)));
            }
        };
        wrap(py, start, axes, effects(environment)?, earth, mu)
    }

    /// Return the orbit that starts from a state of another orbit, in the axes of that orbit.
    ///
    /// Parameters
    /// ----------
    /// orbit : Orbit
    ///     Orbit that provides the initial state.
    /// t0 : float
    ///     Simulation time of the initial state, s.
    /// environment : list of Effect, optional
    ///     Gravity effects, as in the constructor.
    /// earth : Earth, optional
    ///     Orientation of the planet.
    /// mu : float, optional
    ///     Gravitational parameter, m³/s². The default is that of the ``GravityField`` or, without one, of
    ///     ``orbit``.
    ///
    /// Returns
    /// -------
    /// Numerical
    ///
    /// Raises
    /// ------
    /// OrbitError, GravityError, EarthError
    ///     If ``orbit`` has no state at ``t0``, or for the reasons stated for the constructor.
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
        let has_field = environment.iter().any(|effect| effect.get().field().is_some());
        let mu = mu.or_else(|| if has_field { None } else { orbit.mu() });
        Bound::new(py, wrap(py, (r, v, t0), orbit.axes(), environment, earth, mu)?)
    }

    fn __repr__(&self) -> &'static str {
        "<Numerical>"
    }
}

/// Creates the Python object of the orbit with the state `(r, v)`, m and m/s, at `t0`, s, in the gravity of
/// the effects.
fn wrap(
    py: Python<'_>,
    (r, v, t0): (Vector3<f64>, Vector3<f64>, f64),
    axes: Axes,
    environment: Vec<Bound<'_, PyEffect>>,
    earth: Option<&Bound<'_, PyEarth>>,
    mu: Option<f64>,
) -> PyResult<PyClassInitializer<PyNumerical>> {
    let earth_in_axes = earth.map(|earth| Arc::new(earth.get().earth.in_axes(axes)));
    let others = environment.iter().filter(|effect| !effect.get().is_gravity());
    let others: Vec<_> = others.map(|effect| type_name(effect)).collect();
    if !others.is_empty() {
        let message = format!(
            "a numerical orbit is in free fall, so {} cannot act on it; pass only GravityField and ThirdBody \
             to the orbit, and the other effects to the simulation",
            others.join(", ")
        );
        return Err(raise(py, "OrbitError", &message, &fields!(py, "name": "environment", "got": others)));
    }
    // the field defines mu
    let has_field = environment.iter().any(|effect| effect.get().field().is_some());
    let chosen = mu.or_else(|| (!has_field).then_some(MU_EARTH));
    if let Some(value) = chosen.filter(|mu| !(mu.is_finite() && *mu > 0.0)) {
        return Err(OrbitError::NotPositive { name: "mu", value }.into_python(py));
    }
    let gravity = gravity_of(py, &environment, chosen, earth_in_axes.as_ref())?
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
