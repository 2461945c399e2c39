//! Orbits, and their base class.

mod custom_path;
mod fixed_frame;
mod kepler;
mod numerical;
mod reference;
mod relative;
mod sgp4;

use crate::arrays::{fixed, fresh, times, zeros};
use crate::interrupt::{in_pieces, prepare};
use crate::pickling::{ConstructorCall, Reduced};
use nalgebra::Vector3;
use onorbit_core::orbit::{Orbit, OrbitError, lvlh_frames, path_frames, states};
use pyo3::prelude::*;
use pyo3::types::{PyDict, PyTuple};
use std::sync::Arc;

type Any<'a, 'py> = &'a Bound<'py, PyAny>;

pub(crate) fn add_classes(m: &Bound<'_, PyModule>) -> PyResult<()> {
    m.add_class::<PyOrbit>()?;
    m.add_class::<kepler::PyKepler>()?;
    m.add_class::<sgp4::PySgp4>()?;
    m.add_class::<custom_path::PyCustomPath>()?;
    m.add_class::<fixed_frame::PyFixedFrame>()?;
    m.add_class::<numerical::PyNumerical>()?;
    relative::add_functions(m)
}

/// Base class of orbits. The origin of W moves along the orbit that is given to a simulation.
#[pyclass(name = "Orbit", subclass, frozen, module = "onorbit_rs")]
pub(crate) struct PyOrbit {
    pub(crate) orbit: Arc<dyn Orbit>,
    constructor_call: ConstructorCall,
}

/// Creates the base object of an orbit, with the constructor and arguments used to pickle it.
fn base(
    orbit: Arc<dyn Orbit>,
    constructor: &str,
    arguments: &Bound<'_, PyTuple>,
    keywords: &Bound<'_, PyDict>,
) -> PyResult<PyOrbit> {
    let constructor_call = ConstructorCall::new(constructor, arguments.clone(), keywords)?;
    Ok(PyOrbit { orbit, constructor_call })
}

/// Function of the core that computes rotations and angular velocities at given times.
type FillFrames = fn(&dyn Orbit, &[f64], &mut [f64], &mut [f64]) -> Result<(), OrbitError>;

#[pymethods]
impl PyOrbit {
    /// Gravitational parameter of the planet, m³/s²; None if there is no planet.
    #[getter]
    fn mu(&self) -> Option<f64> {
        self.orbit.mu()
    }

    /// Inertial axes of positions and velocities: ``GCRF``, or ``TEME`` for an element set and orbits
    /// integrated in TEME.
    #[getter]
    fn axes(&self) -> &'static str {
        self.orbit.axes().name()
    }

    /// Text that describes how the velocity is obtained. The velocity of SGP4 is not exactly the derivative
    /// of its position.
    #[getter]
    fn velocity_source(&self) -> &'static str {
        self.orbit.velocity_source()
    }

    /// Return position and velocity at one or more times.
    ///
    /// Parameters
    /// ----------
    /// t : float or (T,) array
    ///     Simulation time, s.
    ///
    /// Returns
    /// -------
    /// r : (3,) or (T, 3) array
    ///     Position from the planet's centre, inertial axes, m.
    /// v : (3,) or (T, 3) array
    ///     Velocity, inertial axes, m/s.
    ///
    /// Raises
    /// ------
    /// OrbitError
    ///     If the orbit has no state at one of the times. ``Sgp4Error`` and ``PathError`` are subclasses.
    /// GravityError, EarthError
    ///     If the gravity or the Earth of a ``Numerical`` orbit cannot be evaluated.
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

    /// Return attitude and angular velocity of the local orbital frame L (Hill, RSW).
    ///
    /// Parameters
    /// ----------
    /// t : float or (T,) array
    ///     Simulation time, s.
    ///
    /// Returns
    /// -------
    /// rot_il : (3, 3) or (T, 3, 3) array
    ///     Rotation from L components (x radial outward, z along the angular momentum) to inertial
    ///     components.
    /// w : (3,) or (T, 3) array
    ///     Angular velocity of L in its own axes, rad/s.
    ///
    /// Raises
    /// ------
    /// OrbitError
    ///     If the velocity is zero or parallel to the position, or for the reasons stated for :meth:`state`.
    fn lvlh<'py>(
        &self,
        py: Python<'py>,
        t: Any<'_, 'py>,
    ) -> PyResult<(Bound<'py, PyAny>, Bound<'py, PyAny>)> {
        self.frames(py, t, lvlh_frames)
    }

    /// Return attitude and angular velocity of the frame that moves along the orbit.
    ///
    /// The frame has the attitude given with a path or a fixed frame; without one, it is the local orbital
    /// frame.
    ///
    /// Parameters
    /// ----------
    /// t : float or (T,) array
    ///     Simulation time, s.
    ///
    /// Returns
    /// -------
    /// rot : (3, 3) or (T, 3, 3) array
    ///     Rotation from components in the frame to inertial components.
    /// w : (3,) or (T, 3) array
    ///     Angular velocity of the frame in its own axes, rad/s.
    ///
    /// Raises
    /// ------
    /// OrbitError
    ///     As for :meth:`lvlh`; if an attitude was given, the conditions on the motion do not apply.
    fn frame<'py>(
        &self,
        py: Python<'py>,
        t: Any<'_, 'py>,
    ) -> PyResult<(Bound<'py, PyAny>, Bound<'py, PyAny>)> {
        self.frames(py, t, path_frames)
    }

    fn __reduce__<'py>(&self, py: Python<'py>) -> PyResult<Reduced<'py>> {
        self.constructor_call.reduce(py)
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

/// Reads three finite numbers.
fn vector(value: Any<'_, '_>, name: &str) -> PyResult<Vector3<f64>> {
    Ok(Vector3::from(fixed::<3>(value, name, &[3])?))
}
