//! Evaluation of a model's functions for one state or for a batch of states.

mod derivatives;
mod free_floating;

pub(crate) use derivatives::{PyFreeFloatingDerivatives, evaluate_three, free_floating_derivatives};
pub(crate) use free_floating::{PyFreeFloating, free_floating};

use crate::arrays::{Input, Threads, type_name, wrong_shape};
use crate::errors::{IntoPython, fields, raise};
use crate::interrupt::{self, LONG_BATCH};
use crate::model::PyModel;
use crate::output::{Output, outputs};
use numpy::PyArrayDyn;
use onorbit_core::batch::{Evaluator, Kernel, Rows, RowsMut, Wrenches};
use onorbit_core::dynamics::FrameWrench;
use onorbit_core::spatial::Force;
use pyo3::prelude::*;
use pyo3::types::PyDict;

type Array<'py> = Bound<'py, PyArrayDyn<f64>>;

/// Evaluates `kernel` for one state or a batch of states.
///
/// `values` are the inputs of the kernel and `external` the wrenches by frame. `shapes` are the shapes of the
/// outputs for one state. If `out` is given, the outputs are stored in its arrays, otherwise in new arrays.
pub(crate) fn evaluate<'py, const N: usize>(
    py: Python<'py>,
    model: &PyModel,
    kernel: Kernel,
    values: &[&Bound<'py, PyAny>],
    external: Option<&Bound<'py, PyAny>>,
    shapes: [&[usize]; N],
    out: Option<[Bound<'py, PyAny>; N]>,
    threads: Option<Threads>,
) -> PyResult<[Array<'py>; N]> {
    let names = kernel.inputs();
    let mut inputs: Vec<Input<'py>> =
        values.iter().zip(names).map(|(value, name)| Input::new(value, name)).collect::<PyResult<_>>()?;
    let batch = batch_of(py, &inputs, names)?;
    let frames = wrenches(model, external, batch, &mut inputs)?;
    let whole = shapes.map(|shape| batch.iter().chain(shape).copied().collect::<Vec<_>>());
    let mut outputs = outputs(py, out, whole.each_ref().map(Vec::as_slice), &inputs)?;
    let (states, wrenches) = inputs.split_at(names.len());
    let rows: Vec<Rows<'_>> = states
        .iter()
        .map(|input| Rows { data: input.data(), width: input.shape().last().copied().unwrap_or(0) })
        .collect();
    let external: Vec<Wrenches<'_>> =
        frames.iter().zip(wrenches).map(|(&frame, input)| Wrenches { frame, rows: input.data() }).collect();
    let mut slices: [RowsMut<'_>; N] = outputs.each_mut().map(Output::numbers);
    let core = &*model.model;
    let result = if batch.is_some() {
        let threads = threads.map(|count| count.0);
        let is_long = batch >= Some(LONG_BATCH);
        interrupt::batch(py, threads, is_long, |on| {
            Evaluator::many(kernel, core, &rows, &external, &mut slices, on)
        })?
    } else {
        let mut evaluator = model.evaluator.lock().unwrap_or_else(std::sync::PoisonError::into_inner);
        evaluator.single(kernel, core, &rows, &external, &mut slices)
    };
    result.map_err(|error| error.into_python(py))?;
    Ok(outputs.map(Output::into_array))
}

/// Returns the batch size if the first input is a batch, otherwise `None`. An input with a different number
/// of axes is an error.
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

/// Reads `{frame: (6,)}`: for one state, the force, N, and the moment, N m, in the axes of each frame about
/// its origin.
pub(crate) fn single_wrenches(
    model: &PyModel,
    external: Option<&Bound<'_, PyAny>>,
) -> PyResult<Vec<FrameWrench<f64>>> {
    let mut inputs = Vec::new();
    let frames = wrenches(model, external, None, &mut inputs)?;
    let wrench =
        |(frame, input): (usize, &Input<'_>)| FrameWrench { frame, wrench: Force::from_slice(input.data()) };
    Ok(frames.into_iter().zip(&inputs).map(wrench).collect())
}

/// Reads `{frame: (6,) or (B, 6)}`: the force, N, and the moment, N m, in the axes of each frame about its
/// origin.
///
/// Appends the arrays to `inputs`, and returns the indices of the frames in the same order.
fn wrenches<'py>(
    model: &PyModel,
    external: Option<&Bound<'py, PyAny>>,
    batch: Option<usize>,
    inputs: &mut Vec<Input<'py>>,
) -> PyResult<Vec<usize>> {
    let Some(external) = external else { return Ok(Vec::new()) };
    let Ok(external) = external.cast::<PyDict>() else {
        let (py, got) = (external.py(), type_name(external));
        let message = format!(
            "external is of type {got}; expected a dict of wrenches by frame name, such as \
             {{'{}': [fx, fy, fz, tx, ty, tz]}}",
            model.model.frames()[0].name
        );
        let fields = fields!(py, "name": "external", "got": got, "expected": "dict");
        return Err(raise(py, "DtypeError", &message, &fields));
    };
    let mut one = |(name, wrench): (Bound<'py, PyAny>, Bound<'py, PyAny>)| {
        let frame = model.frame(&name)?;
        let input = Input::new(&wrench, "external wrench")?;
        match (input.shape(), batch) {
            ([6], _) => {}
            ([count, 6], Some(batch)) if *count == batch => {}
            (shape, Some(batch)) => {
                let expected = format!("(6,) or ({batch}, 6)");
                return Err(wrong_shape(name.py(), "external wrench", &expected, shape));
            }
            (shape, None) => return Err(wrong_shape(name.py(), "external wrench", "(6,)", shape)),
        }
        inputs.push(input);
        Ok(frame)
    };
    external.iter().map(&mut one).collect()
}
