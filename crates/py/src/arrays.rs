//! Conversion of numbers and arrays from and to Python.

use crate::errors::{fields, raise, shape_error};
use nalgebra::Vector3;
use numpy::{
    IxDyn, PyArray, PyArrayDyn, PyArrayMethods, PyReadonlyArrayDyn, PyUntypedArray, PyUntypedArrayMethods,
};
use pyo3::PyTypeInfo;
use pyo3::exceptions::PyOverflowError;
use pyo3::prelude::*;
use pyo3::type_object::PyTypeCheck;
use pyo3::types::{PyBool, PySet, PyString, PyTuple};

/// Returns the name of an object's type, for use in messages.
pub(crate) fn type_name(value: &Bound<'_, PyAny>) -> String {
    value.get_type().name().map_or_else(|_| "an object".to_owned(), |name| name.to_string())
}

/// Reads an integer; floats, booleans and text are errors whose message contains `name`.
pub(crate) fn whole(value: &Bound<'_, PyAny>, name: &str) -> PyResult<i64> {
    let py = value.py();
    let number = if value.is_instance_of::<PyBool>() { None } else { Some(value.extract::<i64>()) };
    match number {
        Some(Ok(number)) => Ok(number),
        Some(Err(error)) if error.is_instance_of::<PyOverflowError>(py) => {
            let (limit, got) = (i64::MAX, value.str());
            let got =
                got.map_or_else(|_| "an integer with thousands of digits".to_owned(), |got| got.to_string());
            let message = format!("{name} is {got}; its magnitude must be at most {limit}");
            Err(raise(
                py,
                "InputError",
                &message,
                &fields!(py, "name": name, "got": value, "expected": limit),
            ))
        }
        _ => {
            let got = type_name(value);
            let message = format!("{name} is of type {got}; expected a whole number (int)");
            Err(raise(py, "DtypeError", &message, &fields!(py, "name": name, "got": got, "expected": "int")))
        }
    }
}

/// Reads an integer that must be at least `least`; the message for a smaller integer ends with `hint`.
fn count(value: &Bound<'_, PyAny>, name: &str, least: usize, hint: &str) -> PyResult<usize> {
    let number = whole(value, name)?;
    usize::try_from(number).ok().filter(|count| *count >= least).ok_or_else(|| {
        let (py, expected) = (value.py(), format!("at least {least}"));
        let message = format!("{name} is {number}; it must be {expected}{hint}");
        raise(py, "InputError", &message, &fields!(py, "name": name, "got": number, "expected": expected))
    })
}

/// Reads the argument `steps`, a number of steps that may be zero.
pub(crate) fn steps(value: &Bound<'_, PyAny>) -> PyResult<usize> {
    count(value, "steps", 0, "")
}

/// Reads the argument `record_every`, the number of steps per recorded row, which is at least one.
pub(crate) fn record_every(value: &Bound<'_, PyAny>) -> PyResult<usize> {
    count(value, "record_every", 1, " step")
}

/// Reads the argument `since`, the index of the first row to return.
pub(crate) fn first_row(value: &Bound<'_, PyAny>) -> PyResult<usize> {
    count(value, "since", 0, "")
}

/// Number of threads, as given by the argument `threads`.
#[derive(Clone, Copy)]
pub(crate) struct Threads(pub(crate) usize);

impl<'py> FromPyObject<'_, 'py> for Threads {
    type Error = PyErr;

    fn extract(value: Borrowed<'_, 'py, PyAny>) -> PyResult<Self> {
        count(&value, "threads", 1, "; omit it to use all cores").map(Self)
    }
}

/// Reads the entries of an iterable other than text or a set. All entries must have the class `T`; `what`
/// describes them in messages.
pub(crate) fn list_of<'py, T: PyTypeCheck>(
    value: &Bound<'py, PyAny>,
    name: &str,
    what: &str,
) -> PyResult<Vec<Bound<'py, T>>> {
    if value.is_instance_of::<PyString>() || value.is_instance_of::<PySet>() {
        return Err(no_list(value, name, what));
    }
    let entries = value.try_iter().map_err(|_| no_list(value, name, what))?;
    entries
        .map(|entry| entry?.cast_into::<T>().map_err(|error| wrong_entry(&error.into_inner(), name, what)))
        .collect()
}

/// Returns the error for a value that is not a list of `what`.
fn no_list(value: &Bound<'_, PyAny>, name: &str, what: &str) -> PyErr {
    let (py, got) = (value.py(), type_name(value));
    let message = format!("{name} is of type {got}; expected a list of {what}");
    raise(py, "DtypeError", &message, &fields!(py, "name": name, "got": got, "expected": what))
}

/// Returns the error for an entry of the wrong type in a list of `what`.
pub(crate) fn wrong_entry(entry: &Bound<'_, PyAny>, name: &str, what: &str) -> PyErr {
    let (py, got) = (entry.py(), type_name(entry));
    let message = format!("{name} contains an entry of type {got}; expected a list of {what}");
    raise(py, "DtypeError", &message, &fields!(py, "name": name, "got": got, "expected": what))
}

/// Reads a list of names; `what` describes them in messages. The message for any other value shows a list of
/// one name: the value itself if it is text, otherwise `example`.
pub(crate) fn names_in(
    value: &Bound<'_, PyAny>,
    name: &str,
    what: &str,
    example: &str,
) -> PyResult<Vec<String>> {
    let example = value.extract().unwrap_or_else(|_| example.to_owned());
    let entries = list_of::<PyString>(value, name, &format!("{what}, such as [\"{example}\"]"))?;
    entries.iter().map(|entry| entry.extract()).collect()
}

/// Reads text; `what` describes the expected text in messages.
pub(crate) fn text(value: &Bound<'_, PyAny>, name: &str, what: &str) -> PyResult<String> {
    value.extract().map_err(|_| {
        let (py, got) = (value.py(), type_name(value));
        let message = format!("{name} is of type {got}; expected {what}");
        raise(py, "DtypeError", &message, &fields!(py, "name": name, "got": got, "expected": what))
    })
}

/// Contiguous array of `f64`, borrowed for reading.
pub(crate) struct Input<'py> {
    array: PyReadonlyArrayDyn<'py, f64>,
}

impl<'py> Input<'py> {
    /// Borrows an array of `f64`. Lists and other arrays of real numbers are converted; any other value is an
    /// error whose message contains `name`.
    pub(crate) fn new(value: &Bound<'py, PyAny>, name: &str) -> PyResult<Self> {
        // only the exact type is borrowed; a subclass such as a masked array is converted
        if let Ok(array) = value.cast::<PyArrayDyn<f64>>()
            && value.get_type_ptr() == PyUntypedArray::type_object_raw(value.py())
            && array.is_c_contiguous()
            && array.is_aligned()
        {
            return Self::borrow(array, name);
        }
        Self::converted(value, name)
    }

    #[cold]
    fn converted(value: &Bound<'py, PyAny>, name: &str) -> PyResult<Self> {
        let py = value.py();
        let refuse = |got: String| {
            let message = format!("{name} is {got}; expected an array of real numbers (float64)");
            raise(py, "DtypeError", &message, &fields!(py, "name": name, "got": got, "expected": "float64"))
        };
        if value.is_instance_of::<PyString>() {
            return Err(refuse("text".to_owned()));
        }
        let numpy = py.import("numpy")?;
        if numpy.getattr("ma")?.call_method1("is_masked", (value,))?.is_truthy()? {
            let message = format!(
                "{name} is a masked array with masked entries; replace them with {name}.filled(x), or remove \
                 them with {name}.compressed()"
            );
            let fields = fields!(py, "name": name, "got": "masked entries", "expected": "float64");
            return Err(raise(py, "DtypeError", &message, &fields));
        }
        let array = numpy
            .call_method1("asarray", (value,))
            .map_err(|_| refuse("not a rectangular array".to_owned()))?;
        let kind: String = array.getattr("dtype")?.getattr("kind")?.extract()?;
        if !matches!(kind.as_str(), "f" | "i" | "u") {
            return Err(refuse(format!("of dtype {}", array.getattr("dtype")?)));
        }
        // ascontiguousarray makes a scalar one-dimensional; the length is checked later
        let array = numpy.call_method1("ascontiguousarray", (array, "float64"))?;
        let array = array.cast_into::<PyArrayDyn<f64>>()?;
        if array.is_aligned() {
            return Self::borrow(&array, name);
        }
        Self::borrow(array.call_method0("copy")?.cast::<PyArrayDyn<f64>>()?, name)
    }

    fn borrow(array: &Bound<'py, PyArrayDyn<f64>>, name: &str) -> PyResult<Self> {
        match array.try_readonly() {
            Ok(array) => Ok(Self { array }),
            Err(_) => {
                let (py, message) = (
                    array.py(),
                    format!(
                        "{name} is being written by another call; use \
                separate arrays for concurrent calls"
                    ),
                );
                Err(raise(py, "InputError", &message, &fields!(py, "name": name)))
            }
        }
    }

    /// Returns all elements of the array in row-major order.
    pub(crate) fn data(&self) -> &[f64] {
        self.array.as_slice().unwrap_or(&[]) // contiguity was checked when it was borrowed
    }

    pub(crate) fn shape(&self) -> &[usize] {
        self.array.shape()
    }
}

/// Reads an array of `N` real numbers. A shape other than `shape`, or an entry that is not finite, is an
/// error.
pub(crate) fn fixed<const N: usize>(
    value: &Bound<'_, PyAny>,
    name: &str,
    shape: &[usize],
) -> PyResult<[f64; N]> {
    let py = value.py();
    let input = Input::new(value, name)?;
    match <[f64; N]>::try_from(input.data()) {
        Ok(numbers) if input.shape() == shape => {
            finite(py, name, &numbers)?;
            Ok(numbers)
        }
        _ => Err(wrong_shape(py, name, &shape_text(shape), input.shape())),
    }
}

/// Reads the vector `value`, (3,); returns `default` if it is `None`. `name` is the name of the argument in
/// error messages.
pub(crate) fn vector(
    value: Option<&Bound<'_, PyAny>>,
    name: &str,
    default: [f64; 3],
) -> PyResult<Vector3<f64>> {
    Ok(Vector3::from(value.map_or(Ok(default), |value| fixed(value, name, &[3]))?))
}

/// Returns an error if a number is not finite; the message contains `name` and the first such number.
pub(crate) fn finite(py: Python<'_>, name: &str, numbers: &[f64]) -> PyResult<()> {
    let Some(x) = numbers.iter().find(|x| !x.is_finite()) else { return Ok(()) };
    let message = format!("{name} holds {x}; all values must be finite");
    Err(raise(py, "InputError", &message, &fields!(py, "name": name, "got": *x)))
}

/// Reads the argument `t`: simulation times, s. Also returns their shape: `()` for a number, `(T,)` for an
/// array.
pub(crate) fn times(t: &Bound<'_, PyAny>) -> PyResult<(Vec<f64>, Vec<usize>)> {
    if let Ok(one) = t.extract::<f64>() {
        return Ok((vec![one], Vec::new()));
    }
    let input = Input::new(t, "t")?;
    match input.shape() {
        [n] => Ok((input.data().to_vec(), vec![*n])),
        other => Err(wrong_shape(t.py(), "t", "a number or (T,)", other)),
    }
}

/// Returns the error for an array of the wrong shape.
pub(crate) fn wrong_shape(py: Python<'_>, name: &str, expected: &str, got: &[usize]) -> PyErr {
    let message = format!("{name} has shape {}; expected {expected}", shape_text(got));
    shape_error(py, &message, name, expected, got.to_vec())
}

/// Formats a shape as Python does, such as `(2, 3)`.
pub(crate) fn shape_text(shape: &[usize]) -> String {
    match shape {
        [n] => format!("({n},)"),
        _ => format!("({})", shape.iter().map(ToString::to_string).collect::<Vec<_>>().join(", ")),
    }
}

/// Number of elements (8 MiB) up to which an allocation is assumed to succeed.
const SMALL: usize = 1 << 20;

/// Creates an array of zeros for results of the core; an array that does not fit in memory is an error.
pub(crate) fn zeros<'py>(py: Python<'py>, shape: &[usize]) -> PyResult<Bound<'py, PyArrayDyn<f64>>> {
    let count = shape.iter().try_fold(1_usize, |count, n| count.checked_mul(*n));
    if count.is_some_and(|count| count <= SMALL) {
        return Ok(PyArray::zeros(py, IxDyn(shape), false));
    }
    // numpy raises MemoryError, where the constructor above would panic
    let array = PyTuple::new(py, shape).and_then(|shape| py.import("numpy")?.call_method1("zeros", (shape,)));
    match array {
        Ok(array) => Ok(array.cast_into::<PyArrayDyn<f64>>()?),
        Err(_) => {
            let message = format!(
                "a result of shape {} does not fit in memory; compute it in smaller batches",
                shape_text(shape)
            );
            Err(raise(py, "InputError", &message, &fields!(py, "name": "shape", "got": shape.to_vec())))
        }
    }
}

/// Returns the numbers of an array that was created in this call and to which there are no other references.
#[allow(clippy::mut_from_ref)] // the slice is numpy's buffer, which has no other references
pub(crate) fn fresh<'a>(array: &'a Bound<'_, PyArrayDyn<f64>>) -> &'a mut [f64] {
    // SAFETY: created by `zeros` in this call, contiguous, and not yet visible to Python.
    unsafe { array.as_slice_mut() }.unwrap_or(&mut [])
}

/// Creates an array of this shape with these numbers, in row-major order.
pub(crate) fn array_of<'py>(py: Python<'py>, shape: &[usize], data: &[f64]) -> Bound<'py, PyArrayDyn<f64>> {
    let array = PyArray::zeros(py, IxDyn(shape), false); // for small arrays, such as a state
    fresh(&array).copy_from_slice(data);
    array
}

/// Creates a read-only vector with these numbers.
pub(crate) fn constant<'py>(py: Python<'py>, values: &[f64]) -> Bound<'py, PyArrayDyn<f64>> {
    let array = array_of(py, &[values.len()], values);
    let _ = array.readwrite().make_nonwriteable();
    array
}
