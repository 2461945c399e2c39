//! A robot moved by an engine that is spoken to in Python.

use crate::arrays::{Input, array_of, finite, wrong_shape};
use crate::errors::SimulationErrorExt;
use onorbit_core::simulation::{Crossed, Crossing, Engine, Outside, Simulation, SimulationError};
use pyo3::prelude::*;
use std::sync::{Mutex, MutexGuard, PoisonError};

/// The environment of a run: ``wrenches(t, q, v)`` is the wrench on each body at a state within the step.
#[pyclass(name = "Wrenches", frozen, module = "onorbit_rs")]
struct PyWrenches {
    outside: Mutex<(Outside, (f64, f64))>,
    sizes: [usize; 3],
}

impl PyWrenches {
    fn lock(&self) -> MutexGuard<'_, (Outside, (f64, f64))> {
        self.outside.lock().unwrap_or_else(PoisonError::into_inner)
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
        let (outside, interval) = &mut *self.lock();
        outside
            .wrenches(t, *interval, (q.data(), v.data()), &mut out)
            .map_err(|error| error.into_python_with(py, None))?;
        Ok(array_of(py, &[bodies, 6], &out).into_any())
    }
}

fn vector<'py>(value: &Bound<'py, PyAny>, name: &str, n: usize) -> PyResult<Input<'py>> {
    let input = Input::new(value, name)?;
    if input.shape() == [n] {
        return Ok(input);
    }
    Err(wrong_shape(value.py(), name, &format!("({n},)"), input.shape()))
}

/// One that is finite.
fn state<'py>(value: &Bound<'py, PyAny>, name: &str, n: usize) -> PyResult<Input<'py>> {
    let input = vector(value, name, n)?;
    finite(value.py(), name, input.data())?;
    Ok(input)
}

/// A Python object with ``step(start, end, q, v, tau, wrenches)``, in the native loop.
pub(crate) struct PythonPlant {
    object: Py<PyAny>,
    wrenches: Py<PyWrenches>,
}

impl PythonPlant {
    /// For a simulation whose environment is complete.
    pub(crate) fn new(plant: &Bound<'_, PyAny>, simulation: &Simulation) -> PyResult<Self> {
        let model = &simulation.model;
        let sizes = [model.nq(), model.nv(), model.nodes().len()];
        let outside = Mutex::new((simulation.outside(), (0.0, 0.0)));
        let wrenches = Py::new(plant.py(), PyWrenches { outside, sizes })?;
        Ok(Self { object: plant.clone().unbind(), wrenches })
    }

    fn call(&self, py: Python<'_>, now: &Crossing<'_>, crossed: &mut Crossed) -> PyResult<()> {
        let array = |values: &[f64]| array_of(py, &[values.len()], values);
        let (start, end) = now.interval;
        self.wrenches.get().lock().1 = now.interval;
        let given = (start, end, array(now.q), array(now.v), array(now.tau), &self.wrenches);
        let left = self.object.bind(py).call_method1("step", given)?;
        let [q, v, a, impulse, work, dissipated]: [Bound<'_, PyAny>; 6] = left.extract()?;
        for (name, value, to) in [
            ("the q that the plant returned", q, &mut crossed.q),
            ("the v that the plant returned", v, &mut crossed.v),
            ("the acceleration that the plant returned", a, &mut crossed.acceleration),
        ] {
            let n = to.len();
            to.copy_from_slice(vector(&value, name, n)?.data());
        }
        let name = "the impulse that the plant returned";
        crossed.impulse.copy_from_slice(vector(&impulse, name, 6)?.data());
        (crossed.work, crossed.dissipated) = (work.extract()?, dissipated.extract()?);
        Ok(())
    }
}

impl Engine for PythonPlant {
    fn step(&mut self, now: &Crossing<'_>, crossed: &mut Crossed) -> Result<(), SimulationError> {
        let called = Python::attach(|py| self.call(py, now, crossed));
        called.map_err(|error| SimulationError::Engine(Box::new(error)))
    }
}
