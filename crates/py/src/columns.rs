//! Table of the columns of a trace.

use onorbit_core::simulation::{Column, Length, Part, columns};
use pyo3::prelude::*;
use pyo3::types::{PyDict, PyMappingProxy, PySlice, PyTuple};

/// Returns the part `name` of `values`, an array with one row per time and the parts of `column` side by
/// side. The result has one axis if each row of the part is a single number, otherwise two.
pub(crate) fn part_of<'py>(
    column: &Column,
    values: &Bound<'py, PyAny>,
    name: &str,
) -> PyResult<Bound<'py, PyAny>> {
    let (py, part) = (values.py(), column.parts.iter().find(|part| part.name == name));
    let (start, end) = part.map_or((0, 1), |part| (part.start, part.end.unwrap_or(part.start + 1)));
    let rows = PySlice::full(py);
    if end == start + 1 {
        return values.get_item((rows, start));
    }
    values.get_item((rows, PySlice::new(py, start as isize, end as isize, 1)))
}

/// Description of one recorded quantity: an entry of ``onorbit_rs.COLUMNS``.
///
/// Attributes
/// ----------
/// name : str
///     Name of the attribute of the trace that contains the quantity.
/// path : str
///     Name in ``trace.npz`` and in a checkpoint; ``*`` stands for the name of a control, of an effect, of a
///     contact or of a loop.
/// shape : tuple of str and int
///     Length of each axis: a number, or ``T`` for the rows, ``nq``, ``nv``, ``n`` for the joints,
///     ``bodies``, ``k`` for the components of a tracking error, or ``K`` for the events.
/// unit : str
///     Unit, or the unit of each part, separated by semicolons; ``1`` if dimensionless.
/// frame : str
///     Frame in whose axes the numbers are expressed; empty if they do not depend on a frame.
/// meaning : str
///     Description of the quantity.
/// condition : str
///     Condition under which the quantity is recorded, such as ``always`` or ``with an orbit``.
/// parts : mapping of str to tuple of slice and str
///     Slice of the last axis and unit of each part, by the name of the part; empty for a column without
///     parts.
#[pyclass(name = "Column", frozen, module = "onorbit_rs")]
pub(crate) struct PyColumn(&'static Column);

#[pymethods]
impl PyColumn {
    /// Name of the attribute of the trace that contains the quantity.
    #[getter]
    fn name(&self) -> &'static str {
        self.0.name
    }

    /// Name in ``trace.npz`` and in a checkpoint; ``*`` stands for the name of a control, of an effect, of a
    /// contact or of a loop.
    #[getter]
    fn path(&self) -> &'static str {
        self.0.path
    }

    /// Length of each axis: an integer, or the name of a length, such as ``T`` for the rows.
    #[getter]
    fn shape<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyTuple>> {
        let axis = |length: &Length| match length {
            Length::Fixed(length) => length.into_pyobject(py).map(Bound::into_any).map_err(PyErr::from),
            symbol => symbol.to_string().into_pyobject(py).map(Bound::into_any).map_err(PyErr::from),
        };
        PyTuple::new(py, self.0.shape.iter().map(axis).collect::<PyResult<Vec<_>>>()?)
    }

    /// Unit, or the unit of each part, separated by semicolons; ``1`` if dimensionless.
    #[getter]
    fn unit(&self) -> &'static str {
        self.0.unit
    }

    /// Frame in whose axes the numbers are expressed; empty if they do not depend on a frame.
    #[getter]
    fn frame(&self) -> &'static str {
        self.0.frame
    }

    /// Description of the quantity.
    #[getter]
    fn meaning(&self) -> &'static str {
        self.0.meaning
    }

    /// Condition under which the quantity is recorded, such as ``always`` or ``with an orbit``.
    #[getter]
    fn condition(&self) -> &'static str {
        self.0.condition.text()
    }

    /// Slice of the last axis and unit of each part, by the name of the part; empty for a column without
    /// parts.
    #[getter]
    fn parts<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyMappingProxy>> {
        let parts = PyDict::new(py);
        let slice = |part: &Part| py.get_type::<PySlice>().call1((part.start, part.end));
        for (part, unit) in self.0.parts.iter().zip(self.0.unit.split("; ")) {
            parts.set_item(part.name, (slice(part)?, unit))?;
        }
        Ok(PyMappingProxy::new(py, parts.as_mapping()))
    }

    fn __repr__(&self) -> String {
        let Column { name, shape, unit, .. } = self.0;
        let shape: Vec<String> = shape.iter().map(Length::to_string).collect();
        format!("<Column {name}: ({}), {unit}>", shape.join(", "))
    }
}

/// Returns the read-only mapping from the names of the columns to their descriptions.
fn table(py: Python<'_>) -> PyResult<Bound<'_, PyMappingProxy>> {
    let all = PyDict::new(py);
    for column in columns() {
        all.set_item(column.name, PyColumn(column))?;
    }
    Ok(PyMappingProxy::new(py, all.as_mapping()))
}

/// Adds the class `Column` and the table `COLUMNS` to the module.
pub(crate) fn add(m: &Bound<'_, PyModule>) -> PyResult<()> {
    m.add_class::<PyColumn>()?;
    m.add("COLUMNS", table(m.py())?)
}
