//! The dynamics of a model: one state `(n,)` or a batch `(B, n)`.

use crate::arrays::{Count, Input, fixed, fresh, wrong_shape, zeros};
use crate::errors::IntoPython;
use crate::model::PyModel;
use numpy::PyArrayDyn;
use onorbit_core::batch::{Evaluator, Kernel, Rows, RowsMut};
use onorbit_core::dynamics::FrameWrench;
use onorbit_core::spatial::Force;
use pyo3::prelude::*;
use pyo3::types::PyDict;

type Array<'py> = Bound<'py, PyArrayDyn<f64>>;

/// The reduced model of a manipulator on a free base, `M* q̈ + c* = τ + Q*` and `ẍ = Jg q̈ + d`.
#[pyclass(name = "FreeFloating", frozen, get_all, module = "onorbit_rs")]
pub(crate) struct PyFreeFloating {
    /// `M*`, (n, n) or (B, n, n), kg m².
    inertia: Py<PyAny>,
    /// `c*`, (n,) or (B, n), N m.
    bias: Py<PyAny>,
    /// `Q* = Qm - Mbmᵀ Mbb⁻¹ Qb`, (n,) or (B, n), N m.
    external: Py<PyAny>,
    /// `Jg`, (6, n) or (B, 6, n), W axes at the frame's origin, linear rows first.
    jacobian: Py<PyAny>,
    /// `d`, (6,) or (B, 6), m/s² and rad/s², W axes.
    drift: Py<PyAny>,
}

/// Derivatives of the reduced model at given joint accelerations, tangent of ``q`` as in ``Model.integrate``.
#[pyclass(name = "FreeFloatingDerivatives", frozen, get_all, module = "onorbit_rs")]
pub(crate) struct PyFreeFloatingDerivatives {
    /// `∂τ/∂q` of `τ = M* q̈ + c* - Q*`, (n, nv) or (B, n, nv).
    torque_dq: Py<PyAny>,
    /// `∂τ/∂v`, (n, nv) or (B, n, nv).
    torque_dv: Py<PyAny>,
    /// `∂ẍ/∂q` of `ẍ = Jg q̈ + d`, (6, nv) or (B, 6, nv), rows in W axes, linear first.
    acceleration_dq: Py<PyAny>,
    /// `∂ẍ/∂v`, (6, nv) or (B, 6, nv), rows in W axes.
    acceleration_dv: Py<PyAny>,
    /// `∂ẋ/∂q` of the frame's twist `ẋ = J v`, (6, nv) or (B, 6, nv), rows in W axes.
    velocity_dq: Py<PyAny>,
}

/// Computes `kernel`; `shapes` are the trailing shapes of its outputs.
pub(crate) fn evaluate<'py>(
    py: Python<'py>,
    model: &PyModel,
    kernel: Kernel,
    values: &[&Bound<'py, PyAny>],
    external: Option<&Bound<'py, PyDict>>,
    shapes: &[&[usize]],
    threads: Option<Count>,
) -> PyResult<Vec<Array<'py>>> {
    let names = kernel.inputs();
    let inputs: Vec<Input<'py>> =
        values.iter().zip(names).map(|(value, name)| Input::new(value, name)).collect::<PyResult<_>>()?;
    let batch = batch_of(py, &inputs, names)?;
    let external = wrenches(model, external)?;
    let outputs: Vec<Array<'py>> = shapes
        .iter()
        .map(|shape| zeros(py, &batch.iter().chain(shape.iter()).copied().collect::<Vec<_>>()))
        .collect::<PyResult<_>>()?;
    let rows: Vec<Rows<'_>> = inputs
        .iter()
        .map(|input| Rows { data: input.data(), width: input.shape().last().copied().unwrap_or(0) })
        .collect();
    let mut slices: Vec<RowsMut<'_>> = outputs.iter().map(fresh).collect();
    let core = &*model.model;
    let result = if batch.is_some() {
        let threads = threads.map(|count| count.0);
        py.detach(|| Evaluator::many(kernel, core, &rows, &external, &mut slices, threads))
    } else {
        let mut evaluator = model.evaluator.lock().unwrap_or_else(std::sync::PoisonError::into_inner);
        evaluator.single(kernel, core, &rows, &external, &mut slices)
    };
    result.map_err(|error| error.into_python(py))?;
    Ok(outputs)
}

/// The batch size, if the first argument is a batch.
fn batch_of(py: Python<'_>, inputs: &[Input<'_>], names: &[&str]) -> PyResult<Option<usize>> {
    let first = inputs[0].shape();
    for (input, name) in inputs.iter().zip(names) {
        let shape = input.shape();
        if shape.len() != first.len() || !(1..=2).contains(&shape.len()) {
            let expected = match (first.len(), std::ptr::eq(input, &raw const inputs[0])) {
                (1, false) => "one state (n,) like the first argument",
                (2, false) => "a batch (B, n) like the first argument",
                _ => "(n,) or (B, n)",
            };
            return Err(wrong_shape(py, name, expected, shape));
        }
    }
    Ok((first.len() == 2).then(|| first[0]))
}

/// `{frame: (6,)}`: wrenches in the frame's axes about its origin, N and N m, linear first.
pub(crate) fn wrenches(
    model: &PyModel,
    external: Option<&Bound<'_, PyDict>>,
) -> PyResult<Vec<FrameWrench<f64>>> {
    let Some(external) = external else { return Ok(Vec::new()) };
    let one = |(name, wrench): (Bound<'_, PyAny>, Bound<'_, PyAny>)| {
        let frame = model.frame(&name)?;
        let numbers: [f64; 6] = fixed(&wrench, "external wrench", &[6])?;
        Ok(FrameWrench { frame, wrench: Force::from_slice(&numbers) })
    };
    external.iter().map(one).collect()
}

/// The reduced model with its arrays.
pub(crate) fn free_floating<'py>(
    py: Python<'py>,
    model: &PyModel,
    frame: usize,
    state: &[&Bound<'py, PyAny>],
    external: Option<&Bound<'py, PyDict>>,
    threads: Option<Count>,
) -> PyResult<PyFreeFloating> {
    let n = model.model.joint_count();
    let shapes: [&[usize]; 5] = [&[n, n], &[n], &[n], &[6, n], &[6]];
    let kernel = Kernel::FreeFloating(frame);
    let mut out = evaluate(py, model, kernel, state, external, &shapes, threads)?.into_iter();
    let mut next = || out.next().map_or_else(|| py.None(), |array| array.into_any().unbind());
    Ok(PyFreeFloating { inertia: next(), bias: next(), external: next(), jacobian: next(), drift: next() })
}

/// The derivatives of the reduced model with their arrays.
pub(crate) fn free_floating_derivatives<'py>(
    py: Python<'py>,
    model: &PyModel,
    frame: usize,
    state: &[&Bound<'py, PyAny>],
    external: Option<&Bound<'py, PyDict>>,
    threads: Option<Count>,
) -> PyResult<PyFreeFloatingDerivatives> {
    let (n, nv) = (model.model.joint_count(), model.model.nv());
    let shapes: [&[usize]; 5] = [&[n, nv], &[n, nv], &[6, nv], &[6, nv], &[6, nv]];
    let kernel = Kernel::FreeFloatingDerivatives(frame);
    let mut out = evaluate(py, model, kernel, state, external, &shapes, threads)?.into_iter();
    let mut next = || out.next().map_or_else(|| py.None(), |array| array.into_any().unbind());
    Ok(PyFreeFloatingDerivatives {
        torque_dq: next(),
        torque_dv: next(),
        acceleration_dq: next(),
        acceleration_dv: next(),
        velocity_dq: next(),
    })
}
