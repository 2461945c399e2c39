//! Reduced model of a free-floating manipulator.

use super::evaluate;
use crate::arrays::Threads;
use crate::model::PyModel;
use onorbit_core::batch::Kernel;
use pyo3::prelude::*;

/// Reduced model of a free-floating manipulator with ``n`` joints.
///
/// ``M* q̈ + c* = τ + Q*`` and ``ẍ = Jg q̈ + d``, with the joint accelerations ``q̈``, the joint torques
/// ``τ`` and the acceleration ``ẍ`` of a frame.
#[pyclass(name = "FreeFloating", frozen, get_all, module = "onorbit_rs")]
pub(crate) struct PyFreeFloating {
    /// Reduced mass matrix ``M*``, (n, n) or (B, n, n), kg m², kg m and kg.
    inertia: Py<PyAny>,
    /// Reduced bias forces ``c*``, (n,) or (B, n), N m or N.
    bias: Py<PyAny>,
    /// Generalized external forces ``Q* = Qm - Mbmᵀ Mbb⁻¹ Qb`` at the joints, (n,) or (B, n), N m or N. The
    /// indices ``b`` and ``m`` denote the parts of the forces ``Q`` and of the mass matrix ``M`` that belong
    /// to the base and to the joints.
    external: Py<PyAny>,
    /// Generalized Jacobian ``Jg`` of the frame, (6, n) or (B, 6, n), at the frame's origin in W axes, linear
    /// rows first; dimensionless, m and 1/m.
    jacobian: Py<PyAny>,
    /// Drift ``d``, the acceleration of the frame for ``q̈ = 0``, (6,) or (B, 6), m/s² and rad/s², W axes.
    drift: Py<PyAny>,
}

/// Computes the reduced model of the frame with index `frame`, in new arrays or those of `out`.
pub(crate) fn free_floating<'py>(
    py: Python<'py>,
    model: &PyModel,
    frame: usize,
    state: &[&Bound<'py, PyAny>],
    external: Option<&Bound<'py, PyAny>>,
    out: Option<&Bound<'py, PyFreeFloating>>,
    threads: Option<Threads>,
) -> PyResult<Bound<'py, PyFreeFloating>> {
    let n = model.model.joint_count();
    let shapes: [&[usize]; 5] = [&[n, n], &[n], &[n], &[6, n], &[6]];
    let kernel = Kernel::FreeFloating(frame);
    let given = out.map(|out| {
        let PyFreeFloating { inertia, bias, external, jacobian, drift } = out.get();
        [inertia, bias, external, jacobian, drift].map(|array| array.bind(py).clone())
    });
    let arrays = evaluate(py, model, kernel, state, external, shapes, given, threads)?;
    if let Some(out) = out {
        return Ok(out.clone());
    }
    let [inertia, bias, external, jacobian, drift] = arrays.map(|array| array.into_any().unbind());
    Bound::new(py, PyFreeFloating { inertia, bias, external, jacobian, drift })
}
