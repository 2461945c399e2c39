//! The call that reconstructs a robot after changes of its links or joints.

use super::PyModel;
use crate::pickling::ConstructorCall;
use pyo3::prelude::*;
use pyo3::types::PyDict;

/// Returns the call of `method`, such as `Model.with_joint`, with the arguments `name` and `keywords`, that
/// reconstructs the changed copy of `model`. Successive changes of the same link or joint are merged into a
/// single call, so that intermediate models do not remain in memory.
pub(super) fn merged_call(
    model: &Bound<'_, PyModel>,
    method: &str,
    name: &str,
    keywords: Bound<'_, PyDict>,
) -> PyResult<ConstructorCall> {
    let py = model.py();
    let call = model.get().constructor_call.as_ref();
    let call = call.map(|call| call.arguments_of(py, method)).transpose()?;
    if let Some((arguments, earlier)) = call.flatten() {
        let (origin, changed): (Bound<'_, PyAny>, String) = arguments.extract()?;
        if changed == name {
            let merged = earlier.copy()?;
            for (key, value) in keywords.iter().filter(|(_, value)| !value.is_none()) {
                merged.set_item(key, value)?;
            }
            return ConstructorCall::new(method, (origin, name), &merged);
        }
    }
    ConstructorCall::new(method, (model, name), &keywords)
}
