//! State of an orbit in the frame W of a reference orbit.

use super::Pair;
use crate::arrays::array_of;
use crate::earth::PyEarth;
use crate::errors::IntoPython;
use crate::interrupt::prepare;
use crate::orbit::PyOrbit;
use onorbit_core::orbit::relative;
use pyo3::prelude::*;

/// Return position and velocity of an orbit in the frame W of a reference orbit.
///
/// ``t`` is the simulation time of the reference; an orbit with an epoch (``Sgp4``) is evaluated at the same
/// instant. The velocity is the time derivative of the position. A robot whose base has the rotation
/// ``rot_wb`` from base axes to W starts on ``orbit`` with ``q[:3] = r`` and ``v[:3] = rot_wb.T @ v_w``.
///
/// Parameters
/// ----------
/// reference : Orbit
///     Reference orbit, on which the origin of W moves.
/// orbit : Orbit
///     Orbit around the same planet.
/// t : float
///     Simulation time, s.
/// earth : Earth, optional
///     Earth that defines the epoch of time zero and the orientation of the axes. It is required if only
///     ``orbit`` has an epoch, and if the axes of the two orbits differ (``GCRF`` and ``TEME``).
///
/// Returns
/// -------
/// r : (3,) array
///     Position in W, m.
/// v_w : (3,) array
///     Velocity in W, axes of W, m/s.
///
/// Raises
/// ------
/// OrbitError
///     If an orbit has no state at this time, if the orbits are around different planets, or if a required
///     ``earth`` is missing.
#[pyfunction]
#[pyo3(signature = (reference, orbit, t=0.0, *, earth=None))]
pub(super) fn to_world<'py>(
    py: Python<'py>,
    reference: &Bound<'py, PyOrbit>,
    orbit: &Bound<'py, PyOrbit>,
    t: f64,
    earth: Option<&Bound<'py, PyEarth>>,
) -> PyResult<Pair<'py>> {
    let (reference, orbit) = (&*reference.get().orbit, &*orbit.get().orbit);
    prepare(py, reference, &[t])?;
    prepare(py, orbit, &[t])?;
    let earth = earth.map(|earth| &*earth.get().earth);
    let state = relative::to_world(reference, orbit, t, earth).map_err(|error| error.into_python(py))?;
    let [r, v] = state.map(|vector| array_of(py, &[3], vector.as_slice()).into_any());
    Ok((r, v))
}
