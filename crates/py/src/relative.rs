//! Relative motion.

use crate::arrays::{Input, array_of, fixed, fresh, wrong_shape, zeros};
use crate::errors::{IntoPython, fields, raise};
use crate::interrupt::{in_pieces, prepare};
use crate::orbit::{PyOrbit, times};
use nalgebra::Vector3;
use numpy::PyArrayDyn;
use onorbit_core::orbit::relative::{self, LocalFrame};
use onorbit_core::orbit::{Orbit, OrbitError};
use pyo3::prelude::*;

type Any<'a, 'py> = &'a Bound<'py, PyAny>;
type Array<'py> = Bound<'py, PyArrayDyn<f64>>;
type Pair<'py> = (Bound<'py, PyAny>, Bound<'py, PyAny>);

/// What ``t`` s make of relative position and velocity on a circle of mean motion ``mean_motion``, rad/s: (6, 6), or
/// for (T,) times (T, 6, 6); rows ``(x, y, z, ẋ, ẏ, ż)`` in Hill's axes (x outward, y along track, z normal), m and m/s.
///
/// Clohessy and Wiltshire's linear motion: wrong by terms of second order in the separation.
#[pyfunction]
pub(crate) fn hill_transition<'py>(
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

/// Velocity (3,) m/s at ``r`` (3,) m that leads to the origin in ``t`` s, Hill's axes, on a circle of mean motion
/// ``mean_motion``, rad/s: the first impulse of a rendezvous by two. Raises ``OrbitError`` where none does, such as at
/// half a period.
#[pyfunction]
pub(crate) fn intercept_velocity<'py>(
    py: Python<'py>,
    mean_motion: f64,
    r: Any<'_, 'py>,
    t: f64,
) -> PyResult<Array<'py>> {
    let r = Vector3::from(fixed::<3>(r, "r", &[3])?);
    let v = relative::intercept_velocity(mean_motion, &r, t).map_err(|error| error.into_python(py))?;
    Ok(array_of(py, &[3], v.as_slice()))
}

/// Position and velocity relative to ``orbit`` at ``t`` s, as seen in its turning frame: (3,), (3,), or for (T,) times
/// (T, 3), (T, 3); m and m/s. ``r`` and ``v`` in inertial axes; ``frame`` is ``lvlh`` (x outward, z along the angular
/// momentum) or ``nadir`` (x along track, z down).
#[pyfunction]
#[pyo3(signature = (orbit, t, r, v, *, frame="lvlh"))]
pub(crate) fn to_lvlh<'py>(
    py: Python<'py>,
    orbit: &Bound<'py, PyOrbit>,
    t: Any<'_, 'py>,
    r: Any<'_, 'py>,
    v: Any<'_, 'py>,
    frame: &str,
) -> PyResult<Pair<'py>> {
    converted(py, orbit, t, (r, v), frame, relative::to_local_rows)
}

/// Position and velocity in inertial axes of what is at ``r`` with ``v`` in the turning frame of ``orbit``: undoes
/// :func:`to_lvlh`, arguments and shapes as there.
#[pyfunction]
#[pyo3(signature = (orbit, t, r, v, *, frame="lvlh"))]
pub(crate) fn from_lvlh<'py>(
    py: Python<'py>,
    orbit: &Bound<'py, PyOrbit>,
    t: Any<'_, 'py>,
    r: Any<'_, 'py>,
    v: Any<'_, 'py>,
    frame: &str,
) -> PyResult<Pair<'py>> {
    converted(py, orbit, t, (r, v), frame, relative::from_local_rows)
}

/// One of the two conversions of the core.
type Convert = fn(&dyn Orbit, LocalFrame, &[f64], [&[f64]; 2], [&mut [f64]; 2]) -> Result<(), OrbitError>;

fn converted<'py>(
    py: Python<'py>,
    orbit: &Bound<'py, PyOrbit>,
    t: Any<'_, 'py>,
    (r, v): (Any<'_, 'py>, Any<'_, 'py>),
    frame: &str,
    convert: Convert,
) -> PyResult<Pair<'py>> {
    let Some((_, frame)) = LocalFrame::ALL.iter().find(|(name, _)| *name == frame) else {
        let message = format!("frame is '{frame}'; there are 'lvlh' and 'nadir'");
        return Err(raise(py, "InputError", &message, &fields!(py, "name": "frame", "got": frame)));
    };
    let (instants, shape) = times(t)?;
    let shape: Vec<usize> = shape.into_iter().chain([3]).collect();
    let given = [shaped(r, "r", &shape)?, shaped(v, "v", &shape)?];
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

/// An array of exactly this shape.
fn shaped<'py>(value: Any<'_, 'py>, name: &str, shape: &[usize]) -> PyResult<Input<'py>> {
    let input = Input::new(value, name)?;
    if input.shape() == shape {
        return Ok(input);
    }
    Err(wrong_shape(value.py(), name, &crate::arrays::shape_text(shape), input.shape()))
}

/// One state (3,) or many (B, 3): the shape without the 3.
fn states_of<'py>(value: Any<'_, 'py>, name: &str, width: usize) -> PyResult<(Input<'py>, Vec<usize>)> {
    let input = Input::new(value, name)?;
    match input.shape() {
        [last] if *last == width => Ok((input, Vec::new())),
        [many, last] if *last == width => {
            let many = vec![*many];
            Ok((input, many))
        }
        other => Err(wrong_shape(value.py(), name, &format!("({width},) or (B, {width})"), other)),
    }
}

/// Relative orbital elements ``(δa, δλ, δex, δey, δix, δiy)`` of a deputy about a chief (D'Amico): (6,) or (B, 6), no
/// unit and rad; times the chief's semi-major axis they are lengths.
///
/// ``r``, ``v`` the chief's, ``deputy_r``, ``deputy_v`` the deputy's state, (3,) or (B, 3) each, m and m/s, inertial axes.
/// Raises ``OrbitError`` for a chief in the equator's plane and for open orbits.
#[pyfunction]
#[pyo3(signature = (r, v, deputy_r, deputy_v, *, mu=3.986004418e14))]
pub(crate) fn relative_elements<'py>(
    py: Python<'py>,
    r: Any<'_, 'py>,
    v: Any<'_, 'py>,
    deputy_r: Any<'_, 'py>,
    deputy_v: Any<'_, 'py>,
    mu: f64,
) -> PyResult<Bound<'py, PyAny>> {
    let (r, batch) = states_of(r, "r", 3)?;
    let shape: Vec<usize> = batch.iter().copied().chain([3]).collect();
    let v = shaped(v, "v", &shape)?;
    let (deputy_r, deputy_v) = (shaped(deputy_r, "deputy_r", &shape)?, shaped(deputy_v, "deputy_v", &shape)?);
    let out = zeros(py, &batch.into_iter().chain([6]).collect::<Vec<_>>())?;
    let (chief, deputy, to) = ([r.data(), v.data()], [deputy_r.data(), deputy_v.data()], fresh(&out));
    in_pieces(py, r.data().len() / 3, 4096, |range| {
        let (rows, into) = (3 * range.start..3 * range.end, 6 * range.start..6 * range.end);
        let [chief, deputy] = [chief, deputy].map(|pair| pair.map(|values| &values[rows.clone()]));
        relative::relative_elements_rows(chief, deputy, mu, &mut to[into])
    })?;
    Ok(out.into_any())
}

/// Position and velocity of the deputy with these relative elements ``(6,)`` or ``(B, 6)`` about the chief at ``r``, ``v``:
/// undoes :func:`relative_elements`.
#[pyfunction]
#[pyo3(signature = (r, v, elements, *, mu=3.986004418e14))]
pub(crate) fn deputy_state<'py>(
    py: Python<'py>,
    r: Any<'_, 'py>,
    v: Any<'_, 'py>,
    elements: Any<'_, 'py>,
    mu: f64,
) -> PyResult<Pair<'py>> {
    let (r, batch) = states_of(r, "r", 3)?;
    let with = |last: usize| batch.iter().copied().chain([last]).collect::<Vec<usize>>();
    let (v, elements) = (shaped(v, "v", &with(3))?, shaped(elements, "elements", &with(6))?);
    let (to_r, to_v) = (zeros(py, &with(3))?, zeros(py, &with(3))?);
    let (chief, elements, out_r, out_v) = ([r.data(), v.data()], elements.data(), fresh(&to_r), fresh(&to_v));
    in_pieces(py, r.data().len() / 3, 4096, |range| {
        let (rows, six) = (3 * range.start..3 * range.end, 6 * range.start..6 * range.end);
        let chief = chief.map(|values| &values[rows.clone()]);
        let out = [&mut out_r[rows.clone()], &mut out_v[rows]];
        relative::deputy_states(chief, &elements[six], mu, out)
    })?;
    Ok((to_r.into_any(), to_v.into_any()))
}
