//! Joint torques that the caller of a stepper commands.

use crate::arrays::{Input, wrong_shape};
use crate::errors::{fields, raise};
use onorbit_core::model::Model;
use onorbit_core::number_text::names;
use pyo3::prelude::*;
use pyo3::types::PyDict;

/// Reads the torques commanded to a system, N m (N for a prismatic joint): an array (n,), or a dict from
/// names of joints to torques. Returns one torque per joint; `None` for joints that the dict does not name.
pub(crate) fn torques(model: &Model, tau: &Bound<'_, PyAny>) -> PyResult<Vec<Option<f64>>> {
    let py = tau.py();
    let n = model.joint_count();
    let Ok(by_name) = tau.cast::<PyDict>() else {
        let input = Input::new(tau, "tau")?;
        if input.shape() != [n] {
            return Err(wrong_shape(py, "tau", &format!("({n},), one torque per joint"), input.shape()));
        }
        return Ok(input.data().iter().copied().map(Some).collect());
    };
    let mut torques = vec![None; n];
    for (name, value) in by_name {
        let name = name.str()?.to_string();
        let Ok(joint) = model.joint(&name) else {
            let message = format!(
                "tau contains the unknown joint '{name}' of robot '{}'; {}",
                model.name(),
                names(&model.joint_names().collect::<Vec<_>>(), "joint")
            );
            return Err(raise(py, "InputError", &message, &fields!(py, "name": "tau", "got": name)));
        };
        let input = Input::new(&value, &format!("tau['{name}']"))?;
        let [torque] = input.data() else {
            return Err(wrong_shape(py, &format!("tau['{name}']"), "one number", input.shape()));
        };
        torques[joint] = Some(*torque);
    }
    Ok(torques)
}
