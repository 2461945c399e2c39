//! Relative states in the rotating local frame of an orbit.

use super::{Any, Pair, with_shape};
use crate::arrays::{fresh, times, zeros};
use crate::errors::{fields, raise};
use crate::interrupt::{in_pieces, prepare};
use crate::orbit::PyOrbit;
use onorbit_core::orbit::relative::{self, LocalFrame};
use onorbit_core::orbit::{Orbit, OrbitError};
use pyo3::prelude::*;

/// Convert an inertial state to relative position and velocity in the rotating local frame of an orbit.
///
/// Parameters
/// ----------
/// orbit : Orbit
///     Reference orbit.
/// t : float or (T,) array
///     Simulation time, s.
/// r : (3,) or (T, 3) array
///     Position from the planet's centre, inertial axes, m.
/// v : (3,) or (T, 3) array
///     Velocity, inertial axes, m/s.
/// frame : {"lvlh", "nadir"}
///     Axes of the frame: ``lvlh`` has x radial outward and z along the angular momentum; ``nadir`` has x
///     along track and z towards the planet.
///
/// Returns
/// -------
/// rho : (3,) or (T, 3) array
///     Position relative to the reference orbit, axes of the frame, m.
/// rho_dot : (3,) or (T, 3) array
///     Rate of change of the relative position in the rotating frame, m/s.
///
/// Raises
/// ------
/// OrbitError
///     As for :meth:`Orbit.lvlh`, or if a number is not finite.
/// InputError, ShapeError
///     If ``frame`` is unknown, or the shapes of ``r`` and ``v`` do not match that of ``t``.
#[pyfunction]
#[pyo3(signature = (orbit, t, r, v, *, frame="lvlh"))]
pub(super) fn to_lvlh<'py>(
    py: Python<'py>,
    orbit: &Bound<'py, PyOrbit>,
    t: Any<'_, 'py>,
    r: Any<'_, 'py>,
    v: Any<'_, 'py>,
    frame: &str,
) -> PyResult<Pair<'py>> {
    convert_states(py, orbit, t, (r, v), frame, relative::to_local_rows)
}

/// Convert relative position and velocity in the rotating local frame of an orbit to an inertial state.
///
/// This is the inverse of :func:`to_lvlh`.
///
/// Parameters
/// ----------
/// orbit : Orbit
///     Reference orbit.
/// t : float or (T,) array
///     Simulation time, s.
/// r : (3,) or (T, 3) array
///     Position relative to the reference orbit, axes of the frame, m.
/// v : (3,) or (T, 3) array
///     Rate of change of the relative position in the rotating frame, m/s.
/// frame : {"lvlh", "nadir"}
///     Axes of the frame, as for :func:`to_lvlh`.
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
/// OrbitError, InputError, ShapeError
///     As for :func:`to_lvlh`.
#[pyfunction]
#[pyo3(signature = (orbit, t, r, v, *, frame="lvlh"))]
pub(super) fn from_lvlh<'py>(
    py: Python<'py>,
    orbit: &Bound<'py, PyOrbit>,
    t: Any<'_, 'py>,
    r: Any<'_, 'py>,
    v: Any<'_, 'py>,
    frame: &str,
) -> PyResult<Pair<'py>> {
    convert_states(py, orbit, t, (r, v), frame, relative::from_local_rows)
}

/// Function of the core that converts states to or from the local frame.
type Convert = fn(&dyn Orbit, LocalFrame, &[f64], [&[f64]; 2], [&mut [f64]; 2]) -> Result<(), OrbitError>;

/// Converts the states at one time or at an array of times.
fn convert_states<'py>(
    py: Python<'py>,
    orbit: &Bound<'py, PyOrbit>,
    t: Any<'_, 'py>,
    (r, v): (Any<'_, 'py>, Any<'_, 'py>),
    frame: &str,
    convert: Convert,
) -> PyResult<Pair<'py>> {
    let Some((_, frame)) = LocalFrame::ALL.iter().find(|(name, _)| *name == frame) else {
        let message = format!("frame is '{frame}'; the choices are 'lvlh' and 'nadir'");
        return Err(raise(py, "InputError", &message, &fields!(py, "name": "frame", "got": frame)));
    };
    let (instants, shape) = times(t)?;
    let shape: Vec<usize> = shape.into_iter().chain([3]).collect();
    let given = [with_shape(r, "r", &shape)?, with_shape(v, "v", &shape)?];
    let (to_r, to_v) = (zeros(py, &shape)?, zeros(py, &shape)?);
    let (given, out) = ([given[0].data(), given[1].data()], [fresh(&to_r), fresh(&to_v)]);
    let orbit = &*orbit.get().orbit;
    prepare(py, orbit, &instants)?;
    let [out_r, out_v] = out;
    in_pieces(py, instants.len(), 4096, |range| {
        let rows = 3 * range.start..3 * range.end;
        let out = [&mut out_r[rows.clone()], &mut out_v[rows.clone()]];
        convert(orbit, *frame, &instants[range], given.map(|rows_of| &rows_of[rows.clone()]), out)
    })?;
    Ok((to_r.into_any(), to_v.into_any()))
}
