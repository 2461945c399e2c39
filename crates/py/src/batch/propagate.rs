//! States of many orbits.

use crate::arrays::{Input, Threads, list_of, shape_text, wrong_shape};
use crate::errors::IntoPython;
use crate::interrupt::{self, LONG_BATCH};
use crate::orbit::PyOrbit;
use crate::output::{outputs, pair};
use onorbit_core::batch::{self, Times};
use onorbit_core::orbit::Orbit;
use pyo3::prelude::*;
use std::sync::Arc;

type Any<'a, 'py> = &'a Bound<'py, PyAny>;
type Pair<'py> = (Bound<'py, PyAny>, Bound<'py, PyAny>);
type Out<'a, 'py> = Option<Any<'a, 'py>>;

/// Return the positions and velocities of many orbits, which may be of different kinds.
///
/// The states equal those of ``orbit.state`` up to rounding, and their bits do not depend on ``threads``.
///
/// Parameters
/// ----------
/// orbits : list of Orbit
///     Orbits, ``N`` in total.
/// times : (T,) or (N, T) array
///     Simulation times, s: common to all orbits, or one row per orbit.
/// threads : int, optional
///     Number of threads; default: all cores.
/// out : tuple of two (N, T, 3) arrays, optional
///     Arrays in which the results are stored and which are returned. Other threads must not access them
///     during the call.
///
/// Returns
/// -------
/// r : (N, T, 3) array
///     Positions from the centre of the planet, m, in the axes of the respective orbit.
/// v : (N, T, 3) array
///     Velocities, m/s, in the same axes.
///
/// Raises
/// ------
/// OrbitError
///     If a state cannot be computed; the attribute ``index`` is the index of the orbit. ``Sgp4Error`` and
///     ``PathError`` are subclasses. Errors of an orbit's gravity or Earth have the same attribute.
/// ShapeError, InputError, DtypeError
///     If an array has the wrong shape, ``threads`` is less than 1, or an argument has the wrong type.
#[pyfunction]
#[pyo3(signature = (orbits, times, *, threads=None, out=None))]
pub(super) fn propagate<'py>(
    py: Python<'py>,
    orbits: Any<'_, 'py>,
    times: Any<'_, 'py>,
    threads: Option<Threads>,
    out: Option<Any<'_, 'py>>,
) -> PyResult<(Bound<'py, PyAny>, Bound<'py, PyAny>)> {
    let input = Input::new(times, "times")?;
    let orbits = list_of::<PyOrbit>(orbits, "orbits", "orbits")?;
    let count = orbits.len();
    let (instants, each) = match input.shape() {
        [each] => (Times::Common(input.data()), *each),
        [n, each] if *n == count => (Times::Each(input.data()), *each),
        other => return Err(wrong_shape(py, "times", &format!("(T,) or ({count}, T)"), other)),
    };
    let orbits: Vec<Arc<dyn Orbit>> = orbits.iter().map(|orbit| Arc::clone(&orbit.get().orbit)).collect();
    let (shape, threads) = ([count, each, 3], threads.map(|count| count.0));
    let is_ready = |(index, orbit): (usize, &Arc<dyn Orbit>)| match instants {
        Times::Common(times) => orbit.prepare(times, 0),
        Times::Each(times) => orbit.prepare(&times[index * each..][..each], 0),
    };
    let run = |r: &mut [f64], v: &mut [f64]| {
        let is_long = count * each >= LONG_BATCH || !orbits.iter().enumerate().all(is_ready);
        interrupt::batch(py, threads, is_long, |on| batch::propagate(&orbits, instants, r, v, on))?
            .map_err(|error| error.into_python(py))
    };
    written(py, &shape, out, std::slice::from_ref(&input), run)
}

/// Calls `write` with two arrays of this shape, and returns the arrays. They are those in `out`, or new
/// arrays.
fn written<'py>(
    py: Python<'py>,
    shape: &[usize],
    out: Out<'_, 'py>,
    inputs: &[Input<'py>],
    write: impl FnOnce(&mut [f64], &mut [f64]) -> PyResult<()>,
) -> PyResult<Pair<'py>> {
    let given = pair(out, &format!("(r, v), each of shape {}", shape_text(shape)))?;
    let [mut r, mut v] = outputs(py, given, [shape, shape], inputs)?;
    write(r.numbers(), v.numbers())?;
    Ok((r.into_array().into_any(), v.into_array().into_any()))
}

/// Returns positions, m, and velocities, m/s, of many elliptic orbits, each (N, 3). `given` are the six
/// elements, m and rad, and the time, s, each a number or an (N,) array; `mu` is in m³/s².
pub(crate) fn kepler_states<'py>(
    py: Python<'py>,
    given: [(&str, Any<'_, 'py>); 7],
    mu: f64,
    threads: Option<Threads>,
    out: Out<'_, 'py>,
) -> PyResult<Pair<'py>> {
    let inputs = given.iter().map(|(name, value)| Input::new(value, name)).collect::<PyResult<Vec<_>>>()?;
    let count = inputs.iter().map(|input| input.data().len()).find(|count| *count != 1).unwrap_or(1);
    for ((name, _), input) in given.iter().zip(&inputs) {
        if input.shape().len() > 1 || ![1, count].contains(&input.data().len()) {
            return Err(wrong_shape(py, name, &format!("a number or ({count},)"), input.shape()));
        }
    }
    let elements: [&[f64]; 7] = std::array::from_fn(|k| inputs[k].data());
    let threads = threads.map(|count| count.0);
    written(py, &[count, 3], out, &inputs, |r, v| {
        let is_long = count >= LONG_BATCH;
        interrupt::batch(py, threads, is_long, |on| batch::kepler_states(elements, mu, r, v, on))?
            .map_err(|error| error.into_python(py))
    })
}
