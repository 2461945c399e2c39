//! External engines that are implemented in Python.

use crate::arrays::{Input, array_of, finite, wrong_shape};
use crate::errors::SimulationErrorExt;
use onorbit_core::simulation::{
    Engine, EnvironmentQuery, Simulation, SimulationError, StepInput, StepOutput,
};
use pyo3::prelude::*;
use std::sync::{Mutex, MutexGuard, PoisonError};

/// Environment of a run: ``wrenches(t, q, v)`` returns the wrench on each body at a state within the step.
#[pyclass(name = "Wrenches", frozen, module = "onorbit_rs")]
struct PyWrenches {
    query: Mutex<(EnvironmentQuery, (f64, f64))>,
    sizes: [usize; 3],
}

impl PyWrenches {
    fn lock(&self) -> MutexGuard<'_, (EnvironmentQuery, (f64, f64))> {
        self.query.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

#[pymethods]
impl PyWrenches {
    fn __call__<'py>(
        &self,
        py: Python<'py>,
        t: f64,
        q: &Bound<'py, PyAny>,
        v: &Bound<'py, PyAny>,
    ) -> PyResult<Bound<'py, PyAny>> {
        let [nq, nv, bodies] = self.sizes;
        let (q, v) = (state(q, "q", nq)?, state(v, "v", nv)?);
        let mut out = vec![0.0; 6 * bodies];
        let (query, interval) = &mut *self.lock();
        query
            .wrenches(t, *interval, (q.data(), v.data()), &mut out)
            .map_err(|error| error.into_python_with(py, None))?;
        Ok(array_of(py, &[bodies, 6], &out).into_any())
    }
}

/// Reads a vector of `n` values.
fn vector<'py>(value: &Bound<'py, PyAny>, name: &str, n: usize) -> PyResult<Input<'py>> {
    let input = Input::new(value, name)?;
    if input.shape() == [n] {
        return Ok(input);
    }
    Err(wrong_shape(value.py(), name, &format!("({n},)"), input.shape()))
}

/// Reads a vector of `n` finite values.
fn state<'py>(value: &Bound<'py, PyAny>, name: &str, n: usize) -> PyResult<Input<'py>> {
    let input = vector(value, name, n)?;
    finite(value.py(), name, input.data())?;
    Ok(input)
}

/// Python object with `step(start, end, q, v, tau, wrenches)` as the engine of a run.
pub(crate) struct PythonEngine {
    object: Py<PyAny>,
    wrenches: Py<PyWrenches>,
}

impl PythonEngine {
    /// Wraps the engine of a simulation, to which all effects must have been added before.
    pub(crate) fn new(engine: &Bound<'_, PyAny>, simulation: &Simulation) -> PyResult<Self> {
        let model = &simulation.systems[0].model;
        let sizes = [model.nq(), model.nv(), model.nodes().len()];
        let query = Mutex::new((simulation.outside(), (0.0, 0.0)));
        let wrenches = Py::new(engine.py(), PyWrenches { query, sizes })?;
        Ok(Self { object: engine.clone().unbind(), wrenches })
    }

    /// Calls `step` and copies its results to `output`.
    fn call(&self, py: Python<'_>, input: &StepInput<'_>, output: &mut StepOutput) -> PyResult<()> {
        let array = |values: &[f64]| array_of(py, &[values.len()], values);
        let (start, end) = input.interval;
        self.wrenches.get().lock().1 = input.interval;
        let arguments = (start, end, array(input.q), array(input.v), array(input.tau), &self.wrenches);
        let result = self.object.bind(py).call_method1("step", arguments)?;
        let [q, v, a, impulse, work, dissipated]: [Bound<'_, PyAny>; 6] = result.extract()?;
        for (name, value, to) in [
            ("the q that the engine returned", q, &mut output.q),
            ("the v that the engine returned", v, &mut output.v),
            ("the acceleration that the engine returned", a, &mut output.acceleration),
        ] {
            let n = to.len();
            to.copy_from_slice(vector(&value, name, n)?.data());
        }
        let name = "the impulse that the engine returned";
        output.impulse.copy_from_slice(vector(&impulse, name, 6)?.data());
        (output.work, output.dissipated) = (work.extract()?, dissipated.extract()?);
        Ok(())
    }
}

impl Engine for PythonEngine {
    fn step(&mut self, input: &StepInput<'_>, output: &mut StepOutput) -> Result<(), SimulationError> {
        let outcome = Python::attach(|py| self.call(py, input, output));
        outcome.map_err(|error| SimulationError::Engine(Box::new(error)))
    }
}
