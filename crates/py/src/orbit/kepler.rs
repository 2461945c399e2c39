//! Two-body orbits.

use super::{Any, PyOrbit, base, vector};
use crate::arrays::{Threads, array_of};
use crate::batch::kepler_states;
use crate::errors::{IntoPython, fields, raise};
use onorbit_core::orbit::{Elements, Kepler, Orbit, OrbitError, Phase, Size};
use pyo3::prelude::*;
use pyo3::types::PyTuple;
use std::sync::Arc;

/// Two-body orbit: an ellipse, a parabola or a hyperbola.
///
/// Specify either ``semi_major_axis`` or ``semi_latus_rectum``, and at most one of ``mean_anomaly``,
/// ``true_anomaly`` and ``periapsis_time``. Without any of these three, the orbit is at its periapsis at
/// ``epoch``.
///
/// Parameters
/// ----------
/// semi_major_axis : float, optional
///     Semi-major axis, m; negative for a hyperbola.
/// semi_latus_rectum : float, optional
///     Semi-latus rectum, m; required for a parabola.
/// eccentricity : float
///     Eccentricity.
/// inclination : float
///     Inclination, rad.
/// raan : float
///     Right ascension of the ascending node, rad.
/// argument_of_periapsis : float
///     Argument of periapsis, rad.
/// mean_anomaly : float, optional
///     Mean anomaly at ``epoch``, rad.
/// true_anomaly : float, optional
///     True anomaly at ``epoch``, rad.
/// periapsis_time : float, optional
///     Simulation time of a periapsis passage, s.
/// epoch : float
///     Simulation time to which the anomaly refers, s.
/// mu : float
///     Gravitational parameter, m³/s²; default: that of the Earth.
/// secular_j2 : bool
///     If True, the elements are mean elements, and node, periapsis and mean anomaly drift at the secular
///     rates due to oblateness. Such an orbit is not in free fall.
/// j2 : float, optional
///     Coefficient J2 of the planet; default: that of the Earth. Only with ``secular_j2``.
/// radius : float, optional
///     Reference radius of ``j2``, m; default: that of the Earth. Only with ``secular_j2``.
///
/// Raises
/// ------
/// OrbitError
///     If the elements are invalid or inconsistent, such as a semi-major axis whose sign contradicts the
///     eccentricity, or if ``secular_j2`` is set for an open orbit.
#[pyclass(name = "Kepler", extends = PyOrbit, frozen, module = "onorbit_rs")]
pub(super) struct PyKepler {
    kepler: Kepler,
    flattening: Flattening,
}

/// Returns J2 and the reference radius, m, for the secular rates; by default, the values of the Earth. The
/// result is `None` without secular rates; `j2` or `radius` is then an error.
fn flattening(
    py: Python<'_>,
    secular_j2: bool,
    j2: Option<f64>,
    radius: Option<f64>,
) -> PyResult<Flattening> {
    if !secular_j2 && (j2.is_some() || radius.is_some()) {
        let message = "j2 or radius is given without secular_j2=True; set secular_j2, or omit both";
        return Err(raise(py, "OrbitError", message, &fields!(py, "name": "j2, radius")));
    }
    Ok(secular_j2.then_some((j2.unwrap_or(1.08262617e-3), radius.unwrap_or(6_378_136.3))))
}

/// J2 and reference radius, m, of the secular rates; `None` for a two-body orbit.
type Flattening = Option<(f64, f64)>;

/// Creates the Python object of a two-body orbit, with secular rates if `flattening` is given.
fn wrap(
    py: Python<'_>,
    kepler: Result<Kepler, OrbitError>,
    flattening: Flattening,
    base: impl FnOnce(Arc<dyn Orbit>) -> PyResult<PyOrbit>,
) -> PyResult<PyClassInitializer<PyKepler>> {
    let make = || -> Result<(Kepler, Arc<dyn Orbit>), OrbitError> {
        let kepler = kepler?;
        let orbit: Arc<dyn Orbit> = match flattening {
            None => Arc::new(kepler),
            Some((j2, radius)) => Arc::new(kepler.with_secular_j2(j2, radius)?),
        };
        Ok((kepler, orbit))
    };
    let (kepler, orbit) = make().map_err(|error| error.into_python(py))?;
    Ok(PyClassInitializer::from(base(orbit)?).add_subclass(PyKepler { kepler, flattening }))
}

#[pymethods]
impl PyKepler {
    #[new]
    #[pyo3(signature = (
        *, semi_major_axis=None, semi_latus_rectum=None, eccentricity=0.0, inclination=0.0, raan=0.0,
        argument_of_periapsis=0.0, mean_anomaly=None, true_anomaly=None, periapsis_time=None, epoch=0.0, mu=3.986004418e14,
        secular_j2=false, j2=None, radius=None,
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
        secular_j2: bool,
        j2: Option<f64>,
        radius: Option<f64>,
    ) -> PyResult<PyClassInitializer<Self>> {
        let refuse = |message: &str| raise(py, "OrbitError", message, &fields!(py,));
        let size = match (semi_major_axis, semi_latus_rectum) {
            (Some(a), None) => Size::SemiMajorAxis(a),
            (None, Some(p)) => Size::SemiLatusRectum(p),
            (None, None) => {
                return Err(refuse(
                    "the size of the orbit is missing; give semi_major_axis or semi_latus_rectum (m)",
                ));
            }
            (Some(_), Some(_)) => {
                return Err(refuse(
                    "semi_major_axis and semi_latus_rectum are both given; give exactly one of them",
                ));
            }
        };
        let phase = match (mean_anomaly, true_anomaly, periapsis_time) {
            (Some(m), None, None) => Phase::MeanAnomaly(m),
            (None, Some(nu), None) => Phase::TrueAnomaly(nu),
            (None, None, Some(t)) => Phase::PeriapsisTime(t),
            (None, None, None) => Phase::TrueAnomaly(0.0),
            _ => {
                return Err(refuse(
                    "more than one of mean_anomaly, true_anomaly and periapsis_time is given; give at most one",
                ));
            }
        };
        let elements =
            Elements { size, eccentricity, inclination, raan, argument_of_periapsis, phase, mu, epoch };
        let keywords = fields!(
            py, "semi_major_axis": semi_major_axis, "semi_latus_rectum": semi_latus_rectum,
            "eccentricity": eccentricity, "inclination": inclination, "raan": raan,
            "argument_of_periapsis": argument_of_periapsis, "mean_anomaly": mean_anomaly,
            "true_anomaly": true_anomaly, "periapsis_time": periapsis_time, "epoch": epoch, "mu": mu,
            "secular_j2": secular_j2, "j2": j2, "radius": radius,
        );
        let flattening = flattening(py, secular_j2, j2, radius)?;
        let base_object = |orbit| base(orbit, "Kepler", &PyTuple::empty(py), &keywords);
        wrap(py, Kepler::new(&elements), flattening, base_object)
    }

    /// Return the orbit that has the position ``r`` and the velocity ``v`` at time zero.
    ///
    /// Parameters
    /// ----------
    /// r : (3,) array
    ///     Position from the planet's centre, inertial axes, m.
    /// v : (3,) array
    ///     Velocity, inertial axes, m/s.
    /// mu : float
    ///     Gravitational parameter, m³/s²; default: that of the Earth.
    /// secular_j2, j2, radius
    ///     As for the constructor.
    ///
    /// Returns
    /// -------
    /// Kepler
    ///
    /// Raises
    /// ------
    /// OrbitError
    ///     If position and velocity are parallel or zero, or for the reasons stated for the constructor.
    #[staticmethod]
    #[pyo3(signature = (r, v, *, mu=3.986004418e14, secular_j2=false, j2=None, radius=None))]
    fn from_state<'py>(
        py: Python<'py>,
        r: Any<'_, 'py>,
        v: Any<'_, 'py>,
        mu: f64,
        secular_j2: bool,
        j2: Option<f64>,
        radius: Option<f64>,
    ) -> PyResult<Bound<'py, Self>> {
        let (r, v) = (vector(r, "r")?, vector(v, "v")?);
        let arguments =
            (array_of(py, &[3], r.as_slice()), array_of(py, &[3], v.as_slice())).into_pyobject(py)?;
        let keywords = fields!(py, "mu": mu, "secular_j2": secular_j2, "j2": j2, "radius": radius);
        let flattening = flattening(py, secular_j2, j2, radius)?;
        let base_object = |orbit| base(orbit, "Kepler.from_state", &arguments, &keywords);
        Bound::new(py, wrap(py, Kepler::from_state(r, v, mu), flattening, base_object)?)
    }

    /// Return the states of many elliptic orbits without creating an object for each.
    ///
    /// The states equal those of ``Kepler(...).state(t)`` up to the rounding of the product of mean motion
    /// and time.
    ///
    /// Parameters
    /// ----------
    /// t : float or (N,) array
    ///     Simulation time, s.
    /// semi_major_axis : float or (N,) array
    ///     Semi-major axis, m.
    /// eccentricity : float or (N,) array
    ///     Eccentricity, below 1.
    /// inclination, raan, argument_of_periapsis, mean_anomaly : float or (N,) array
    ///     Angles, rad; ``mean_anomaly`` is the mean anomaly at time zero.
    /// mu : float
    ///     Gravitational parameter, m³/s²; default: that of the Earth.
    /// threads : int, optional
    ///     Number of threads; default: all cores.
    /// out : tuple of two (N, 3) arrays, optional
    ///     Arrays in which the results are stored and which are returned.
    ///
    /// Returns
    /// -------
    /// r : (N, 3) array
    ///     Positions from the planet's centre, inertial axes, m.
    /// v : (N, 3) array
    ///     Velocities, inertial axes, m/s.
    ///
    /// Raises
    /// ------
    /// InputError
    ///     If an orbit is not an ellipse, or a number is not finite.
    /// ShapeError
    ///     If the arrays have different lengths.
    #[staticmethod]
    #[pyo3(signature = (
        t, *, semi_major_axis, eccentricity, inclination, raan, argument_of_periapsis, mean_anomaly,
        mu=3.986004418e14, threads=None, out=None,
    ))]
    fn states<'py>(
        py: Python<'py>,
        t: Any<'_, 'py>,
        semi_major_axis: Any<'_, 'py>,
        eccentricity: Any<'_, 'py>,
        inclination: Any<'_, 'py>,
        raan: Any<'_, 'py>,
        argument_of_periapsis: Any<'_, 'py>,
        mean_anomaly: Any<'_, 'py>,
        mu: f64,
        threads: Option<Threads>,
        out: Option<Any<'_, 'py>>,
    ) -> PyResult<(Bound<'py, PyAny>, Bound<'py, PyAny>)> {
        let given = [
            ("semi_major_axis", semi_major_axis),
            ("eccentricity", eccentricity),
            ("inclination", inclination),
            ("raan", raan),
            ("argument_of_periapsis", argument_of_periapsis),
            ("mean_anomaly", mean_anomaly),
            ("t", t),
        ];
        kepler_states(py, given, mu, threads, out)
    }

    /// True if node, periapsis and mean anomaly drift at the secular rates due to oblateness.
    #[getter]
    fn secular_j2(&self) -> bool {
        self.flattening.is_some()
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

    /// Mean anomaly at the epoch, or at ``periapsis_time`` if that was given instead, rad; None for parabolas
    /// and nearly parabolic orbits.
    #[getter]
    fn mean_anomaly(&self) -> Option<f64> {
        match self.kepler.elements().phase {
            Phase::MeanAnomaly(m) => Some(m),
            Phase::TrueAnomaly(_) | Phase::PeriapsisTime(_) => None,
        }
    }

    /// Period of revolution without secular rates, s; None for an open orbit.
    #[getter]
    fn period(&self) -> Option<f64> {
        self.kepler.period()
    }

    fn __repr__(&self) -> String {
        let (a, e) = (self.kepler.semi_major_axis(), self.kepler.eccentricity());
        format!("<Kepler: semi-major axis {a:.3} m, eccentricity {e:.6}>")
    }
}
