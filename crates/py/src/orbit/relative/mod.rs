//! Motion of one orbit relative to another.

mod elements;
mod hill;
mod local;
mod world;

use crate::arrays::{Input, shape_text, wrong_shape};
use pyo3::prelude::*;

type Any<'a, 'py> = &'a Bound<'py, PyAny>;
type Pair<'py> = (Bound<'py, PyAny>, Bound<'py, PyAny>);

pub(super) fn add_functions(m: &Bound<'_, PyModule>) -> PyResult<()> {
    m.add_function(wrap_pyfunction!(hill::hill_transition, m)?)?;
    m.add_function(wrap_pyfunction!(hill::intercept_velocity, m)?)?;
    m.add_function(wrap_pyfunction!(local::to_lvlh, m)?)?;
    m.add_function(wrap_pyfunction!(local::from_lvlh, m)?)?;
    m.add_function(wrap_pyfunction!(world::to_world, m)?)?;
    m.add_function(wrap_pyfunction!(elements::relative_elements, m)?)?;
    m.add_function(wrap_pyfunction!(elements::deputy_state, m)?)
}

/// Reads the argument `name`, an array of exactly this shape.
fn with_shape<'py>(value: Any<'_, 'py>, name: &str, shape: &[usize]) -> PyResult<Input<'py>> {
    let input = Input::new(value, name)?;
    if input.shape() == shape {
        return Ok(input);
    }
    Err(wrong_shape(value.py(), name, &shape_text(shape), input.shape()))
}
