//! Computations for many states or orbits at once.

mod propagate;
mod rollout;

pub(crate) use propagate::kepler_states;

use pyo3::prelude::*;

pub(crate) fn add_functions(m: &Bound<'_, PyModule>) -> PyResult<()> {
    m.add_function(wrap_pyfunction!(rollout::rollout, m)?)?;
    m.add_function(wrap_pyfunction!(propagate::propagate, m)?)
}
