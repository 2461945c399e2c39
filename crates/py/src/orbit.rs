//! Reference orbits.

mod custom_path;
mod fixed_frame;
mod numerical;
mod reference;
mod sgp4;

pub(crate) use custom_path::PyCustomPath;
pub(crate) use fixed_frame::PyFixedFrame;
pub(crate) use numerical::PyNumerical;
pub(crate) use sgp4::PySgp4;

use crate::arrays::{Input, Threads, array_of, fixed, fresh, wrong_shape, zeros};
use crate::errors::{IntoPython, fields, raise};
use crate::interrupt::{in_pieces, prepare};
use nalgebra::Vector3;
use onorbit_core::orbit::{
    Elements, Kepler, Orbit, OrbitError, Phase, Size, lvlh_frames, path_frames, states,
};
use pyo3::prelude::*;
use pyo3::types::{PyDict, PyTuple};
use std::sync::Arc;

type Any<'a, 'py> = &'a Bound<'py, PyAny>;

/// A reference orbit: the origin of W rides on it.
#[pyclass(name = "Orbit", subclass, frozen, module = "onorbit_rs")]
pub(crate) struct PyOrbit {
    pub(crate) orbit: Arc<dyn Orbit>,
    /// Constructor, arguments and keywords that make it again.
    made: Py<PyTuple>,
}

/// The base object of an orbit of any kind.
fn base(
    orbit: Arc<dyn Orbit>,
    constructor: &str,
    arguments: &Bound<'_, PyTuple>,
    keywords: &Bound<'_, PyDict>,
) -> PyResult<PyOrbit> {
    let made = (constructor, arguments, keywords).into_pyobject(arguments.py())?;
    Ok(PyOrbit { orbit, made: made.unbind() })
}

/// One of the functions that fill rotations and rates.
type FillFrames = fn(&dyn Orbit, &[f64], &mut [f64], &mut [f64]) -> Result<(), OrbitError>;

#[pymethods]
impl PyOrbit {
    /// Gravitational parameter of the planet, m³/s², or None.
    #[getter]
    fn mu(&self) -> Option<f64> {
        self.orbit.mu()
    }

    /// Inertial axes of positions and velocities: ``GCRF``, or ``TEME`` for an element set.
    #[getter]
    fn axes(&self) -> &'static str {
        self.orbit.axes().name()
    }

    /// Where the velocity comes from: SGP4's is not exactly the derivative of its position.
    #[getter]
    fn velocity_source(&self) -> &'static str {
        self.orbit.velocity_source()
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
        let orbit = &*self.orbit;
        prepare(py, orbit, &times)?;
        in_pieces(py, times.len(), 16_384, |range| {
            let rows = 3 * range.start..3 * range.end;
            states(orbit, &times[range], &mut to_r[rows.clone()], &mut to_v[rows])
        })?;
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
        self.frames(py, t, lvlh_frames)
    }

    /// Frame that rides on the reference at ``t`` s: the attitude it was given (its axes to inertial ones), else the
    /// local orbital frame; shapes as those of :meth:`lvlh`.
    fn frame<'py>(
        &self,
        py: Python<'py>,
        t: Any<'_, 'py>,
    ) -> PyResult<(Bound<'py, PyAny>, Bound<'py, PyAny>)> {
        self.frames(py, t, path_frames)
    }

    fn __reduce__<'py>(&self, py: Python<'py>) -> PyResult<(Bound<'py, PyAny>, Py<PyTuple>)> {
        Ok((py.import("onorbit_rs.rebuild")?.getattr("rebuild")?, self.made.clone_ref(py)))
    }
}

impl PyOrbit {
    fn frames<'py>(
        &self,
        py: Python<'py>,
        t: Any<'_, 'py>,
        fill: FillFrames,
    ) -> PyResult<(Bound<'py, PyAny>, Bound<'py, PyAny>)> {
        let (times, shape) = times(t)?;
        let with = |tail: &[usize]| shape.iter().chain(tail).copied().collect::<Vec<usize>>();
        let (rotations, rates) = (zeros(py, &with(&[3, 3]))?, zeros(py, &with(&[3]))?);
        let (to_r, to_w) = (fresh(&rotations), fresh(&rates));
        let orbit = &*self.orbit;
        prepare(py, orbit, &times)?;
        in_pieces(py, times.len(), 4096, |range| {
            let (nine, three) = (9 * range.start..9 * range.end, 3 * range.start..3 * range.end);
            fill(orbit, &times[range], &mut to_r[nine], &mut to_w[three])
        })?;
        Ok((rotations.into_any(), rates.into_any()))
    }
}

/// Three finite numbers.
fn vector(value: Any<'_, '_>, name: &str) -> PyResult<Vector3<f64>> {
    Ok(Vector3::from(fixed::<3>(value, name, &[3])?))
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
/// periapsis passage, s of simulation. With ``secular_j2`` the elements are mean ones, and node, periapsis and mean
/// anomaly drift as a planet's flattening ``j2`` (reference radius ``radius``, m) makes them on average; such an
/// orbit no longer falls freely. Raises ``OrbitError``, such as for a semi-major axis whose sign contradicts
/// the eccentricity.
#[pyclass(name = "Kepler", extends = PyOrbit, frozen, module = "onorbit_rs")]
pub(crate) struct PyKepler {
    kepler: Kepler,
    flattening: Flattening,
}

/// The flattening that an ellipse obeys: the Earth's where nothing else is given.
fn flattening(
    py: Python<'_>,
    secular_j2: bool,
    j2: Option<f64>,
    radius: Option<f64>,
) -> PyResult<Flattening> {
    if !secular_j2 && (j2.is_some() || radius.is_some()) {
        let message = "j2 and radius do nothing without secular_j2=True: give it, or leave them out";
        return Err(raise(py, "OrbitError", message, &fields!(py, "name": "j2, radius")));
    }
    Ok(secular_j2.then_some((j2.unwrap_or(1.08262617e-3), radius.unwrap_or(6_378_136.3))))
}

/// Whether the planet's flattening turns the ellipse: its `j2` and reference radius, m.
type Flattening = Option<(f64, f64)>;

fn wrap(
    py: Python<'_>,
    kepler: Result<Kepler, OrbitError>,
    flattening: Flattening,
    made: impl FnOnce(Arc<dyn Orbit>) -> PyResult<PyOrbit>,
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
    Ok(PyClassInitializer::from(made(orbit)?).add_subclass(PyKepler { kepler, flattening }))
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
        let keywords = fields!(
            py, "semi_major_axis": semi_major_axis, "semi_latus_rectum": semi_latus_rectum,
            "eccentricity": eccentricity, "inclination": inclination, "raan": raan,
            "argument_of_periapsis": argument_of_periapsis, "mean_anomaly": mean_anomaly,
            "true_anomaly": true_anomaly, "periapsis_time": periapsis_time, "epoch": epoch, "mu": mu,
            "secular_j2": secular_j2, "j2": j2, "radius": radius,
        );
        let flattening = flattening(py, secular_j2, j2, radius)?;
        let made = |orbit| base(orbit, "Kepler", &PyTuple::empty(py), &keywords);
        wrap(py, Kepler::new(&elements), flattening, made)
    }

    /// The orbit through position ``r`` (3,) m with velocity ``v`` (3,) m/s at time zero, inertial axes.
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
        let made = |orbit| base(orbit, "Kepler.from_state", &arguments, &keywords);
        Bound::new(py, wrap(py, Kepler::from_state(r, v, mu), flattening, made)?)
    }

    /// States on many ellipses at once, without an object for each: ``r``, ``v`` (N, 3), m and m/s, at ``t`` s.
    ///
    /// Each argument is a number or (N,); angles in rad, ``mean_anomaly`` that at time zero. The same as
    /// ``Kepler(...).state(t)`` up to the rounding of ``n t``; ``out`` and ``threads`` as those of ``propagate``. Raises ``InputError`` for what is no ellipse.
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
        crate::propagate::kepler_states(py, given, mu, threads, out)
    }

    /// Whether node, periapsis and mean anomaly drift as the planet's flattening makes them.
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
