//! External engines that are implemented in Python.

use crate::arrays::{Input, array_of, finite, names_in, wrong_shape};
use crate::errors::{SimulationErrorExt, fields, raise};
use onorbit_core::simulation::{
    BodyWeld, Engine, EnvironmentQuery, Simulation, SimulationError, StepInput, StepOutput,
};
use onorbit_core::spatial::Vec3;
use pyo3::prelude::*;
use pyo3::types::PyDict;
use std::sync::{Mutex, MutexGuard, PoisonError};

/// Function with which an external engine computes the wrenches of the environment during a step.
///
/// ``wrenches(t, q, v)`` returns an array (bodies, 6) for a time ``t``, s, within the current step and the
/// state ``q``, ``v`` of all systems. Each row contains the force on a body, N, which acts at its centre of
/// mass, and the torque about its centre of mass, N m, in the axes of W.
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

/// External engine of a run: a Python object with the method `step(start, end, q, v, tau, wrenches)`, or
/// `step_world` if there are several systems or the engine computes contacts.
pub(crate) struct PythonEngine {
    object: Py<PyAny>,
    wrenches: Py<PyWrenches>,
    /// Names of the contacts whose forces the engine computes.
    contacts: Vec<String>,
    /// Names of the closed loops and mimic joints whose constraints the engine satisfies.
    loops: Vec<String>,
    is_world: bool,
    /// True if the methods accept the engaged brakes as the keyword argument `brakes`.
    supports_brakes: bool,
}

impl PythonEngine {
    /// Wraps the engine of a simulation, after all effects have been added to the simulation. An engine that
    /// needs `step_world` but lacks it is an error.
    pub(crate) fn new(engine: &Bound<'_, PyAny>, simulation: &Simulation) -> PyResult<Self> {
        let py = engine.py();
        let models = || simulation.systems.iter().map(|system| &system.model);
        let (nq, nv) = (models().map(|model| model.nq()).sum(), models().map(|model| model.nv()).sum());
        let sizes = [nq, nv, models().map(|model| model.nodes().len()).sum()];
        let contacts = match engine.getattr_opt("contacts")? {
            Some(names) => names_in(&names, "the engine's attribute contacts", "names of contacts", "touch")?,
            None => Vec::new(),
        };
        let loops = match engine.getattr_opt("loops")? {
            Some(names) => names_in(&names, "the engine's attribute loops", "names of loops", "closing")?,
            None => Vec::new(),
        };
        let supports_brakes = match engine.getattr_opt("supports_brakes")? {
            Some(answer) => answer.is_truthy()?,
            None => false,
        };
        let is_world = simulation.systems.len() > 1 || !contacts.is_empty();
        if is_world && !engine.hasattr("step_world")? {
            let message = "the engine has no step_world, but an engine that computes contacts or moves a \
                           world of several systems needs a method step_world; add the method as described \
                           for Simulation, or use the native engine";
            return Err(raise(py, "EngineError", message, &fields!(py, "name": "engine")));
        }
        let query = Mutex::new((simulation.outside(), (0.0, 0.0)));
        let wrenches = Py::new(py, PyWrenches { query, sizes })?;
        Ok(Self { object: engine.clone().unbind(), wrenches, contacts, loops, is_world, supports_brakes })
    }

    /// Calls the engine for one step, and copies its results to `output`.
    fn call(&self, py: Python<'_>, input: &StepInput<'_>, output: &mut StepOutput) -> PyResult<()> {
        let array = |values: &[f64]| array_of(py, &[values.len()], values);
        let (start, end) = input.interval;
        self.wrenches.get().lock().1 = input.interval;
        let state = (array(input.q), array(input.v), array(input.tau));
        let object = self.object.bind(py);
        let options = self.options(py, input)?;
        let [q, v, a] = if self.is_world {
            let welds: Vec<_> = input.welds.iter().map(|weld| described(py, weld)).collect();
            let arguments = (start, end, state.0, state.1, state.2, &self.wrenches, welds);
            let result = object.call_method("step_world", arguments, options.as_ref())?;
            let ([q, v, a, impulse, work, loss, weld_impulse, weld_work, orbital], contacts) =
                self.returned(&result)?;
            if let Some(contacts) = contacts {
                read_contacts(output, &contacts)?;
            }
            read_exchange(output, [&impulse, &work, &loss, &weld_impulse, &weld_work, &orbital])?;
            [q, v, a]
        } else {
            let arguments = (start, end, state.0, state.1, state.2, &self.wrenches);
            let result = object.call_method("step", arguments, options.as_ref())?;
            let [q, v, a, impulse, work, loss]: [Bound<'_, PyAny>; 6] = result.extract()?;
            let done = &mut output.systems[0];
            done.impulse.copy_from_slice(vector(&impulse, IMPULSE, 6)?.data());
            (done.work, done.dissipated) = (work.extract()?, loss.extract()?);
            [q, v, a]
        };
        for (name, value, to) in [
            ("the q that the engine returned", q, &mut output.q),
            ("the v that the engine returned", v, &mut output.v),
            ("the acceleration that the engine returned", a, &mut output.acceleration),
        ] {
            let n = to.len();
            to.copy_from_slice(vector(&value, name, n)?.data());
        }
        Ok(())
    }

    /// Returns the keyword argument `brakes` if the engine supports brakes: one tuple of system index, joint
    /// index and slip torque (N m or N) for each engaged brake.
    fn options<'py>(&self, py: Python<'py>, input: &StepInput<'_>) -> PyResult<Option<Bound<'py, PyDict>>> {
        if !self.supports_brakes {
            return Ok(None);
        }
        let options = PyDict::new(py);
        let engaged = input.brakes.iter().map(|brake| (brake.system, brake.joint, brake.slip_torque));
        options.set_item("brakes", engaged.collect::<Vec<_>>())?;
        Ok(Some(options))
    }

    /// Splits the tuple that `step_world` returned. Its tenth entry is the array of the contacts, which is
    /// absent if the engine computes no contacts.
    fn returned<'py>(&self, result: &Bound<'py, PyAny>) -> PyResult<Returned<'py>> {
        if self.contacts.is_empty() {
            return Ok((result.extract()?, None));
        }
        let parts: [Bound<'py, PyAny>; 10] = result.extract()?;
        let contacts = parts[9].clone();
        Ok((std::array::from_fn(|k| parts[k].clone()), Some(contacts)))
    }
}

/// Result of `step_world`: nine arrays, and the array of the contacts if the engine computes contacts.
type Returned<'py> = ([Bound<'py, PyAny>; 9], Option<Bound<'py, PyAny>>);

const IMPULSE: &str = "the impulse that the engine returned";

/// Connection as passed to Python: indices of system and body of both sides, the points (2, 3), m, and the
/// rotation (3, 3) of [`BodyWeld`].
type Described<'py> = ((usize, usize), (usize, usize), Bound<'py, PyAny>, Bound<'py, PyAny>);

fn described<'py>(py: Python<'py>, weld: &BodyWeld) -> Described<'py> {
    let [by, of] = weld.bodies.map(|body| (body.system, body.body));
    let rows = |vectors: &[Vec3<f64>]| vectors.iter().flat_map(|v| [v.x, v.y, v.z]).collect::<Vec<f64>>();
    let turned = weld.rotation.transpose(); // the matrix is stored by columns
    let (points, rotation) = (rows(&weld.points), rows(&[turned.x, turned.y, turned.z]));
    (by, of, array_of(py, &[2, 3], &points).into_any(), array_of(py, &[3, 3], &rotation).into_any())
}

/// Reads an array (contacts, 14): force (N), moment (N m) and power (W) of each contact at the start of the
/// step, then the integrals of these seven numbers over the step. The moment at the start is not used.
fn read_contacts(output: &mut StepOutput, value: &Bound<'_, PyAny>) -> PyResult<()> {
    let name = "the array of contacts that the engine returned";
    let (rows, n) = (Input::new(value, name)?, output.contacts.len());
    if rows.shape() != [n, 14] {
        return Err(wrong_shape(value.py(), name, &format!("({n}, 14)"), rows.shape()));
    }
    for (done, row) in output.contacts.iter_mut().zip(rows.data().chunks_exact(14)) {
        let (now, over_step) = row.split_at(7);
        let (impulse, work) = over_step.split_at(done.impulse.len());
        done.force.copy_from_slice(&now[..3]);
        done.impulse.copy_from_slice(impulse);
        (done.power, done.work) = (now[6], work[0]);
    }
    Ok(())
}

/// Reads six arrays of a step of a world. For each system: impulse (N s and N m s), work (J), dissipated
/// energy (J), and impulse and work of the connections. For the world: the time integral of the moment about
/// the common centre of mass, N m s.
fn read_exchange(output: &mut StepOutput, values: [&Bound<'_, PyAny>; 6]) -> PyResult<()> {
    let [impulse, work, loss, weld_impulse, weld_work, orbital] = values;
    let n = output.systems.len();
    let impulses =
        [(IMPULSE, impulse), ("the impulse of the connections that the engine returned", weld_impulse)];
    for (k, (name, value)) in impulses.into_iter().enumerate() {
        let rows = Input::new(value, name)?;
        if rows.shape() != [n, 6] {
            return Err(wrong_shape(value.py(), name, &format!("({n}, 6)"), rows.shape()));
        }
        for (done, row) in output.systems.iter_mut().zip(rows.data().chunks_exact(6)) {
            let to = if k == 0 { &mut done.impulse } else { &mut done.weld_impulse };
            to.copy_from_slice(row);
        }
    }
    let scalars = |value, name| vector(value, name, n);
    let work = scalars(work, "the work that the engine returned")?;
    let loss = scalars(loss, "the dissipated energy that the engine returned")?;
    let weld_work = scalars(weld_work, "the work of the connections that the engine returned")?;
    for (k, done) in output.systems.iter_mut().enumerate() {
        (done.work, done.dissipated) = (work.data()[k], loss.data()[k]);
        done.weld_work = weld_work.data()[k];
    }
    let name = "the moment about the common centre of mass that the engine returned";
    output.orbital.copy_from_slice(vector(orbital, name, 3)?.data());
    Ok(())
}

impl Engine for PythonEngine {
    fn contacts(&self) -> Vec<String> {
        self.contacts.clone()
    }

    fn loops(&self) -> Vec<String> {
        self.loops.clone()
    }

    fn supports_brakes(&self) -> bool {
        self.supports_brakes
    }

    fn step(&mut self, input: &StepInput<'_>, output: &mut StepOutput) -> Result<(), SimulationError> {
        let outcome = Python::attach(|py| self.call(py, input, output));
        outcome.map_err(|error| SimulationError::Engine(Box::new(error)))
    }
}
