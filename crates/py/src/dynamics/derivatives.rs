//! Derivatives of the equations of motion and of the reduced model.

use super::evaluate;
use crate::arrays::Threads;
use crate::errors::{fields, raise};
use crate::model::PyModel;
use onorbit_core::batch::Kernel;
use pyo3::prelude::*;
use pyo3::types::PyTuple;

/// Derivatives of the reduced model at given joint accelerations, in the tangent space of
/// ``Model.integrate``.
///
/// ``q`` and ``v`` are the state of base and joints, and ``q̈`` are the joint accelerations;
/// :class:`FreeFloating` defines the other symbols. All derivatives are in SI units.
#[pyclass(name = "FreeFloatingDerivatives", frozen, get_all, module = "onorbit_rs")]
pub(crate) struct PyFreeFloatingDerivatives {
    /// Derivative ``∂τ/∂q`` of the joint torques ``τ = M* q̈ + c* - Q*``, (n, nv) or (B, n, nv).
    torque_dq: Py<PyAny>,
    /// Derivative ``∂τ/∂v`` of the joint torques, (n, nv) or (B, n, nv).
    torque_dv: Py<PyAny>,
    /// Derivative ``∂ẍ/∂q`` of the frame's acceleration ``ẍ = Jg q̈ + d``, (6, nv) or (B, 6, nv), rows in W
    /// axes, linear first.
    acceleration_dq: Py<PyAny>,
    /// Derivative ``∂ẍ/∂v`` of the frame's acceleration, (6, nv) or (B, 6, nv), rows in W axes, linear first.
    acceleration_dv: Py<PyAny>,
    /// Derivative ``∂ẋ/∂q`` of the frame's twist ``ẋ = J v``, with the frame's Jacobian ``J``, (6, nv) or (B,
    /// 6, nv), rows in W axes, linear first.
    velocity_dq: Py<PyAny>,
}

/// Computes the derivatives of the reduced model of the frame with index `frame`, in new arrays or those of
/// `out`.
pub(crate) fn free_floating_derivatives<'py>(
    py: Python<'py>,
    model: &PyModel,
    frame: usize,
    state: &[&Bound<'py, PyAny>],
    external: Option<&Bound<'py, PyAny>>,
    out: Option<&Bound<'py, PyFreeFloatingDerivatives>>,
    threads: Option<Threads>,
) -> PyResult<Bound<'py, PyFreeFloatingDerivatives>> {
    let (n, nv) = (model.model.joint_count(), model.model.nv());
    let shapes: [&[usize]; 5] = [&[n, nv], &[n, nv], &[6, nv], &[6, nv], &[6, nv]];
    let kernel = Kernel::FreeFloatingDerivatives(frame);
    let given = out.map(|out| {
        let one = out.get();
        [&one.torque_dq, &one.torque_dv, &one.acceleration_dq, &one.acceleration_dv, &one.velocity_dq]
            .map(|array| array.bind(py).clone())
    });
    let arrays = evaluate(py, model, kernel, state, external, shapes, given, threads)?;
    if let Some(out) = out {
        return Ok(out.clone());
    }
    let [torque_dq, torque_dv, acceleration_dq, acceleration_dv, velocity_dq] =
        arrays.map(|array| array.into_any().unbind());
    let result =
        PyFreeFloatingDerivatives { torque_dq, torque_dv, acceleration_dq, acceleration_dv, velocity_dq };
    Bound::new(py, result)
}

/// Evaluates a kernel with three outputs of shape (nv, nv), in new arrays or in those of `out`.
pub(crate) fn evaluate_three<'py>(
    py: Python<'py>,
    model: &PyModel,
    kernel: Kernel,
    values: &[&Bound<'py, PyAny>],
    external: Option<&Bound<'py, PyAny>>,
    out: Option<&Bound<'py, PyAny>>,
    threads: Option<Threads>,
) -> PyResult<Bound<'py, PyTuple>> {
    let out = out.map(|out| out.extract::<[Bound<'py, PyAny>; 3]>()).transpose().map_err(|_| {
        let needed = "a sequence of three arrays of shape (nv, nv) or (B, nv, nv)";
        let message = format!("out is not {needed}; pass an earlier result, or omit out");
        raise(py, "InputError", &message, &fields!(py, "name": "out", "expected": needed))
    })?;
    let square: &[usize] = &[model.model.nv(); 2];
    PyTuple::new(py, evaluate(py, model, kernel, values, external, [square; 3], out, threads)?)
}
