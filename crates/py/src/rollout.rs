//! Many runs at once.

use pyo3::prelude::*;

/// placeholder
#[pyfunction]
pub(crate) fn rollout() {}
