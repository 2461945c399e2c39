//! Many orbits at once.

use crate::arrays::{Count, Input, fresh, list_of, shape_text, wrong_shape, zeros};
use crate::errors::{IntoPython, fields, raise};
use crate::orbit::PyOrbit;
use numpy::{PyArrayDyn, PyArrayMethods, PyReadwriteArrayDyn, PyUntypedArrayMethods};
use onorbit_core::batch::{self, Times};
use onorbit_core::orbit::Orbit;
use pyo3::prelude::*;
use std::sync::Arc;

type Any<'a, 'py> = &'a Bound<'py, PyAny>;
type Pair<'py> = (Bound<'py, PyAny>, Bound<'py, PyAny>);
type Out<'a, 'py> = Option<Any<'a, 'py>>;

/// Positions and velocities of many orbits of any kinds: ``r``, ``v`` (N, T, 3), m and m/s, each in the axes of its orbit.
///
/// ``times`` (T,) s for all, or (N, T); ``out`` a pair of such arrays to write into, which is then what returns (nobody
/// may look at them meanwhile). On all cores unless ``threads`` says otherwise; the bits do not depend on it. The states
/// are those of ``orbit.state`` up to rounding. An orbit that is refused raises ``OrbitError`` (``Sgp4Error``, ``PathError``)
/// with its ``index``.
#[pyfunction]
#[pyo3(signature = (orbits, times, *, threads=None, out=None))]
pub(crate) fn propagate<'py>(
    py: Python<'py>,
    orbits: Any<'_, 'py>,
    times: Any<'_, 'py>,
    threads: Option<Count>,
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
    let run = |r: &mut [f64], v: &mut [f64]| {
        py.detach(|| batch::propagate(&orbits, instants, r, v, threads))
            .map_err(|error| error.into_python(py))
    };
    written(py, &shape, out, run)
}

/// What `write` leaves in two arrays of this shape: the caller's, or fresh ones.
fn written<'py>(
    py: Python<'py>,
    shape: &[usize],
    out: Out<'_, 'py>,
    write: impl FnOnce(&mut [f64], &mut [f64]) -> PyResult<()>,
) -> PyResult<Pair<'py>> {
    let Some(out) = out else {
        let (r, v) = (zeros(py, shape)?, zeros(py, shape)?);
        write(fresh(&r), fresh(&v))?;
        return Ok((r.into_any(), v.into_any()));
    };
    let (r, v) = out.extract::<Pair<'py>>().map_err(|_| {
        let message = format!("out is no pair of arrays: give (r, v), each of shape {}", shape_text(shape));
        raise(py, "InputError", &message, &fields!(py, "name": "out", "expected": "(r, v)"))
    })?;
    let (mut to_r, mut to_v) = (writable(&r, "out[0]", shape)?, writable(&v, "out[1]", shape)?);
    write(slice(&mut to_r), slice(&mut to_v))?;
    drop((to_r, to_v));
    Ok((r, v))
}

/// A caller's array, to be written.
fn writable<'py>(
    value: Any<'_, 'py>,
    name: &str,
    shape: &[usize],
) -> PyResult<PyReadwriteArrayDyn<'py, f64>> {
    let refuse = |got: String| {
        let message = format!(
            "{name} is {got}, a writable contiguous float64 array of shape {} of its own is needed",
            shape_text(shape)
        );
        let fields = fields!(value.py(), "name": name, "expected": shape.to_vec(), "got": got);
        raise(value.py(), "ShapeError", &message, &fields)
    };
    let Ok(array) = value.cast::<PyArrayDyn<f64>>() else {
        return Err(refuse("no float64 array".to_owned()));
    };
    if array.shape() != shape {
        return Err(refuse(format!("of shape {}", shape_text(array.shape()))));
    }
    if !array.is_c_contiguous() {
        return Err(refuse("not contiguous".to_owned()));
    }
    array.try_readwrite().map_err(|_| refuse("read-only or in use".to_owned()))
}

fn slice<'a>(array: &'a mut PyReadwriteArrayDyn<'_, f64>) -> &'a mut [f64] {
    array.as_slice_mut().unwrap_or(&mut []) // contiguity was checked when it was borrowed
}

/// Elements and time of [`crate::orbit::PyKepler`]'s `states`, each a number or (N,).
pub(crate) fn kepler_states<'py>(
    py: Python<'py>,
    given: [(&str, Any<'_, 'py>); 7],
    mu: f64,
    threads: Option<Count>,
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
    written(py, &[count, 3], out, |r, v| {
        py.detach(|| batch::kepler_states(elements, mu, r, v, threads)).map_err(|error| error.into_python(py))
    })
}
