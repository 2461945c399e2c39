//! Reference orbits.

use crate::arrays::{Input, fixed, fresh, wrong_shape, zeros};
use crate::errors::{IntoPython, fields, raise};
use nalgebra::Vector3;
use onorbit_core::orbit::{Elements, Kepler, Orbit, Phase, Size, lvlh_frames, states};
use pyo3::prelude::*;
use std::sync::Arc;

type Any<'a, 'py> = &'a Bound<'py, PyAny>;

/// A reference orbit: the origin of W rides on it.
#[pyclass(name = "Orbit", subclass, frozen, module = "onorbit_rs")]
pub(crate) struct PyOrbit {
    pub(crate) orbit: Arc<dyn Orbit>,
}

#[pymethods]
impl PyOrbit {
    /// Gravitational parameter of the planet, m³/s², or None.
    #[getter]
    fn mu(&self) -> Option<f64> {
        self.orbit.mu()
    }

    /// Position and velocity at ``t`` s: (3,), (3,) or for (T,) times (T, 3), (T, 3); m, m/s, inertial axes.
    fn state<'py>(
        &self,
        py: Python<'py>,
        t: Any<'_, 'py>,
    ) -> PyResult<(Bound<'py, PyAny>, Bound<'py, PyAny>)> {
        let (times, shape) = times(t)?;
        let dims: Vec<usize> = shape.iter().copied().chain([3]).collect();
        let (r, v) = (zeros(py, &dims)?, zeros(py, &dims)?);
        let (to_r, to_v) = (fresh(&r), fresh(&v));
        py.detach(|| states(&*self.orbit, &times, to_r, to_v)).map_err(|error| error.into_python(py))?;
        Ok((r.into_any(), v.into_any()))
    }

    /// Local orbital frame in the Hill (RSW) sense at ``t`` s: ``rot_il`` (3, 3), which takes its components to
    /// inertial ones (x radial outward, z along the angular momentum), and its rate in its own axes (3,), rad/s;
    /// for (T,) times (T, 3, 3) and (T, 3).
    fn lvlh<'py>(
        &self,
        py: Python<'py>,
        t: Any<'_, 'py>,
    ) -> PyResult<(Bound<'py, PyAny>, Bound<'py, PyAny>)> {
        let (times, shape) = times(t)?;
        let with = |tail: &[usize]| shape.iter().chain(tail).copied().collect::<Vec<usize>>();
        let (rotations, rates) = (zeros(py, &with(&[3, 3]))?, zeros(py, &with(&[3]))?);
        let (to_r, to_w) = (fresh(&rotations), fresh(&rates));
        py.detach(|| lvlh_frames(&*self.orbit, &times, to_r, to_w)).map_err(|error| error.into_python(py))?;
        Ok((rotations.into_any(), rates.into_any()))
    }
}

/// One instant (shape ``()``) or many (shape ``(T,)``).
pub(crate) fn times(t: Any<'_, '_>) -> PyResult<(Vec<f64>, Vec<usize>)> {
    if let Ok(one) = t.extract::<f64>() {
        return Ok((vec![one], Vec::new()));
    }
    let input = Input::new(t, "t")?;
    match input.shape() {
        [n] => Ok((input.data().to_vec(), vec![*n])),
        other => Err(wrong_shape(t.py(), "t", "a number or (T,)", other)),
    }
}

/// Two-body motion: ellipse, parabola (by its semi-latus rectum) or hyperbola (negative semi-major axis).
///
/// Lengths in m, angles in rad, ``mu`` in m³/s². One phase: mean or true anomaly at ``epoch``, or the time of a
/// periapsis passage, s of simulation. Raises ``OrbitError``, such as for a semi-major axis whose sign contradicts
/// the eccentricity.
#[pyclass(name = "Kepler", extends = PyOrbit, frozen, module = "onorbit_rs")]
pub(crate) struct PyKepler {
    kepler: Arc<Kepler>,
}

fn wrap(kepler: Kepler) -> PyClassInitializer<PyKepler> {
    let kepler = Arc::new(kepler);
    PyClassInitializer::from(PyOrbit { orbit: Arc::clone(&kepler) as Arc<dyn Orbit> })
        .add_subclass(PyKepler { kepler })
}

#[pymethods]
impl PyKepler {
    #[new]
    #[pyo3(signature = (
        *, semi_major_axis=None, semi_latus_rectum=None, eccentricity=0.0, inclination=0.0, raan=0.0,
        argument_of_periapsis=0.0, mean_anomaly=None, true_anomaly=None, periapsis_time=None, epoch=0.0, mu=3.986004418e14,
    ))]
    fn new(
        py: Python<'_>,
        semi_major_axis: Option<f64>,
        semi_latus_rectum: Option<f64>,
        eccentricity: f64,
        inclination: f64,
        raan: f64,
        argument_of_periapsis: f64,
        mean_anomaly: Option<f64>,
        true_anomaly: Option<f64>,
        periapsis_time: Option<f64>,
        epoch: f64,
        mu: f64,
    ) -> PyResult<PyClassInitializer<Self>> {
        let refuse = |message: &str| raise(py, "OrbitError", message, &fields!(py,));
        let size = match (semi_major_axis, semi_latus_rectum) {
            (Some(a), None) => Size::SemiMajorAxis(a),
            (None, Some(p)) => Size::SemiLatusRectum(p),
            _ => return Err(refuse("give either semi_major_axis or semi_latus_rectum, m")),
        };
        let phase = match (mean_anomaly, true_anomaly, periapsis_time) {
            (Some(m), None, None) => Phase::MeanAnomaly(m),
            (None, Some(nu), None) => Phase::TrueAnomaly(nu),
            (None, None, Some(t)) => Phase::PeriapsisTime(t),
            (None, None, None) => Phase::TrueAnomaly(0.0),
            _ => return Err(refuse("give one of mean_anomaly, true_anomaly and periapsis_time")),
        };
        let elements =
            Elements { size, eccentricity, inclination, raan, argument_of_periapsis, phase, mu, epoch };
        Ok(wrap(Kepler::new(&elements).map_err(|error| error.into_python(py))?))
    }

    /// The orbit through position ``r`` (3,) m with velocity ``v`` (3,) m/s at time zero, inertial axes.
    #[staticmethod]
    #[pyo3(signature = (r, v, *, mu=3.986004418e14))]
    fn from_state<'py>(
        py: Python<'py>,
        r: Any<'_, 'py>,
        v: Any<'_, 'py>,
        mu: f64,
    ) -> PyResult<Bound<'py, Self>> {
        let vector = |value, name| Ok::<_, PyErr>(Vector3::from(fixed::<3>(value, name, &[3])?));
        let kepler = Kepler::from_state(vector(r, "r")?, vector(v, "v")?, mu);
        Bound::new(py, wrap(kepler.map_err(|error| error.into_python(py))?))
    }

    /// Semi-major axis, m; negative for a hyperbola, infinite for a parabola.
    #[getter]
    fn semi_major_axis(&self) -> f64 {
        self.kepler.semi_major_axis()
    }

    /// Semi-latus rectum, m.
    #[getter]
    fn semi_latus_rectum(&self) -> f64 {
        self.kepler.semi_latus_rectum()
    }

    /// Eccentricity.
    #[getter]
    fn eccentricity(&self) -> f64 {
        self.kepler.eccentricity()
    }

    /// Inclination, rad.
    #[getter]
    fn inclination(&self) -> f64 {
        self.kepler.elements().inclination
    }

    /// Right ascension of the ascending node, rad.
    #[getter]
    fn raan(&self) -> f64 {
        self.kepler.elements().raan
    }

    /// Argument of periapsis, rad.
    #[getter]
    fn argument_of_periapsis(&self) -> f64 {
        self.kepler.elements().argument_of_periapsis
    }

    /// Mean anomaly at the epoch, rad; None near and on a parabola.
    #[getter]
    fn mean_anomaly(&self) -> Option<f64> {
        match self.kepler.elements().phase {
            Phase::MeanAnomaly(m) => Some(m),
            Phase::TrueAnomaly(_) | Phase::PeriapsisTime(_) => None,
        }
    }

    /// Period, s; None on an open orbit.
    #[getter]
    fn period(&self) -> Option<f64> {
        self.kepler.period()
    }

    fn __repr__(&self) -> String {
        let (a, e) = (self.kepler.semi_major_axis(), self.kepler.eccentricity());
        format!("<Kepler: semi-major axis {a:.3} m, eccentricity {e:.6}>")
    }
}
