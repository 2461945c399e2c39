//! Output arrays, which are either new or given by the caller.

use crate::arrays::{Input, fresh, shape_text, zeros};
use crate::errors::{fields, raise};
use numpy::{PyArrayDyn, PyArrayMethods, PyReadwriteArrayDyn, PyUntypedArrayMethods};
use pyo3::prelude::*;

type Any<'a, 'py> = &'a Bound<'py, PyAny>;

/// Array in which a call stores results.
pub(crate) struct Output<'py> {
    array: Bound<'py, PyArrayDyn<f64>>,
    /// Exclusive borrow of the caller's array during the call.
    borrowed: Option<PyReadwriteArrayDyn<'py, f64>>,
}

impl<'py> Output<'py> {
    /// Creates a new array of this shape.
    pub(crate) fn fresh(py: Python<'py>, shape: &[usize]) -> PyResult<Self> {
        Ok(Self { array: zeros(py, shape)?, borrowed: None })
    }

    /// Borrows the caller's array, which must be a writable, contiguous array of `f64` with this shape.
    fn given(value: Any<'_, 'py>, name: &str, shape: &[usize]) -> PyResult<Self> {
        let refuse = |class: &str, got: &str| {
            let (py, needed) = (value.py(), shape_text(shape));
            let message =
                format!("{name} is {got}; expected a writable, contiguous float64 array of shape {needed}");
            raise(py, class, &message, &fields!(py, "name": name, "expected": shape.to_vec(), "got": got))
        };
        let Ok(array) = value.cast::<PyArrayDyn<f64>>() else {
            return Err(refuse("DtypeError", "not a float64 array"));
        };
        if array.shape() != shape {
            return Err(refuse("ShapeError", &format!("of shape {}", shape_text(array.shape()))));
        }
        if !array.is_c_contiguous() || !array.is_aligned() {
            return Err(refuse("ShapeError", "not contiguous and aligned"));
        }
        match array.try_readwrite() {
            Ok(borrowed) => Ok(Self { array: array.clone(), borrowed: Some(borrowed) }),
            Err(numpy::BorrowError::NotWriteable) => Err(refuse("InputError", "read-only")),
            Err(_) => {
                let message = format!(
                    "{name} is in use as an input, as another output or by another call; use a separate array"
                );
                Err(raise(value.py(), "InputError", &message, &fields!(value.py(), "name": name)))
            }
        }
    }

    /// Returns the elements of the array in row-major order.
    pub(crate) fn numbers(&mut self) -> &mut [f64] {
        match &mut self.borrowed {
            Some(borrowed) => borrowed.as_slice_mut().unwrap_or(&mut []), // contiguity was checked
            None => fresh(&self.array),
        }
    }

    /// Returns the array with the results, and ends its borrow.
    pub(crate) fn into_array(self) -> Bound<'py, PyArrayDyn<f64>> {
        self.array
    }
}

/// Returns one output array for each shape: the caller's arrays in this order, or new arrays.
///
/// Arrays that share memory with an input or with each other are rejected.
pub(crate) fn outputs<'py, const N: usize>(
    py: Python<'py>,
    given: Option<[Bound<'py, PyAny>; N]>,
    shapes: [&[usize]; N],
    inputs: &[Input<'py>],
) -> PyResult<[Output<'py>; N]> {
    let mut made: Vec<Output<'py>> = Vec::with_capacity(N);
    for (k, shape) in shapes.iter().enumerate() {
        let output = match &given {
            None => Output::fresh(py, shape)?,
            Some(given) => {
                let name = if N == 1 { "out".to_owned() } else { format!("out[{k}]") };
                let mut output = Output::given(&given[k], &name, shape)?;
                // unrelated views may still share memory
                let here = output.numbers().as_ptr_range();
                let others = inputs.iter().map(|input| input.data().as_ptr_range());
                let others = others.chain(made.iter_mut().map(|other| other.numbers().as_ptr_range()));
                if others.into_iter().any(|other| here.start < other.end && other.start < here.end) {
                    let message =
                        format!("{name} shares memory with an input or another output; use separate arrays");
                    return Err(raise(py, "InputError", &message, &fields!(py, "name": name)));
                }
                output
            }
        };
        made.push(output);
    }
    let Ok(made) = <[Output<'py>; N]>::try_from(made) else { unreachable!("one for each shape") };
    Ok(made)
}

/// Reads the argument `out=(a, b)`, if it is given; `what` describes the two arrays in messages.
pub(crate) fn pair<'py>(out: Option<Any<'_, 'py>>, what: &str) -> PyResult<Option<[Bound<'py, PyAny>; 2]>> {
    let Some(out) = out else { return Ok(None) };
    let (a, b) = out.extract::<(Bound<'py, PyAny>, Bound<'py, PyAny>)>().map_err(|_| {
        let message = format!("out is not a pair of arrays; expected {what}");
        raise(out.py(), "InputError", &message, &fields!(out.py(), "name": "out", "expected": what))
    })?;
    Ok(Some([a, b]))
}
