//! Linear relative motion near a circular orbit.

use super::Any;
use crate::arrays::{array_of, fixed, fresh, times, zeros};
use crate::errors::IntoPython;
use crate::interrupt::in_pieces;
use nalgebra::Vector3;
use numpy::PyArrayDyn;
use onorbit_core::orbit::relative;
use pyo3::prelude::*;

/// Return the Clohessy-Wiltshire transition matrix.
///
/// The matrix solves Hill's linear equations of relative motion near a circular orbit. The error is of second
/// order in the separation.
///
/// Parameters
/// ----------
/// mean_motion : float
///     Mean motion of the circular orbit, rad/s.
/// t : float or (T,) array
///     Time over which the motion is propagated, s.
///
/// Returns
/// -------
/// (6, 6) or (T, 6, 6) array
///     Matrix that maps the initial to the final relative state ``(x, y, z, ẋ, ẏ, ż)``, m and m/s, in Hill's
///     axes (x radial outward, y along track, z normal to the orbit).
///
/// Raises
/// ------
/// OrbitError
///     If ``mean_motion`` is not positive, or a number is not finite.
#[pyfunction]
pub(super) fn hill_transition<'py>(
    py: Python<'py>,
    mean_motion: f64,
    t: Any<'_, 'py>,
) -> PyResult<Bound<'py, PyAny>> {
    let (instants, shape) = times(t)?;
    let out = zeros(py, &shape.iter().copied().chain([6, 6]).collect::<Vec<_>>())?;
    let to = fresh(&out);
    in_pieces(py, instants.len(), 16_384, |range| {
        let into = 36 * range.start..36 * range.end;
        relative::hill_transitions(mean_motion, &instants[range], &mut to[into])
    })?;
    Ok(out.into_any())
}

/// Return the velocity with which a satellite near a circular orbit reaches the origin in a given time.
///
/// The origin moves on the circular orbit. The change of the satellite's velocity to the returned velocity is
/// the first impulse of a two-impulse rendezvous.
///
/// Parameters
/// ----------
/// mean_motion : float
///     Mean motion of the circular orbit, rad/s.
/// r : (3,) array
///     Position relative to the origin, in Hill's axes (see :func:`hill_transition`), m.
/// t : float
///     Time after which the satellite reaches the origin, s.
///
/// Returns
/// -------
/// (3,) array
///     Relative velocity, Hill's axes, m/s.
///
/// Raises
/// ------
/// OrbitError
///     If no such velocity exists, as for zero time or half a period, or if ``mean_motion`` is not positive.
#[pyfunction]
pub(super) fn intercept_velocity<'py>(
    py: Python<'py>,
    mean_motion: f64,
    r: Any<'_, 'py>,
    t: f64,
) -> PyResult<Bound<'py, PyArrayDyn<f64>>> {
    let r = Vector3::from(fixed::<3>(r, "r", &[3])?);
    let v = relative::intercept_velocity(mean_motion, &r, t).map_err(|error| error.into_python(py))?;
    Ok(array_of(py, &[3], v.as_slice()))
}
