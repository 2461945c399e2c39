//! Python bindings of `onorbit-core`. This crate converts arguments, results and errors; all physics is
//! computed in the core.

mod arrays;
mod batch;
mod checkpoint;
mod columns;
mod commands;
mod contact;
mod control;
mod dynamics;
mod earth;
mod engine;
mod environment;
mod errors;
mod geometry;
mod gravity;
mod interrupt;
mod least_distance;
mod model;
mod orbit;
mod output;
mod pickling;
mod recorded_loop;
mod reference;
mod run_failure;
mod shared_run;
mod simulation;
mod stepper;
mod stepper_advance;
mod stepper_rows;
mod torques;
mod trace;
mod world;

use onorbit_core::spatial::InstructionSet;
use pyo3::exceptions::PyImportError;
use pyo3::prelude::*;
use pyo3::types::PyDict;

/// Return the version of the engine and the instruction set that it uses on this computer.
///
/// Returns
/// -------
/// dict
///     ``version`` and ``instruction_set``, both str. The instruction set is ``baseline``, ``avx2+fma`` or
///     ``avx512``, or ``fma`` on ARM.
#[pyfunction]
fn build_info(py: Python<'_>) -> PyResult<Bound<'_, PyDict>> {
    let info = PyDict::new(py);
    info.set_item("version", env!("CARGO_PKG_VERSION"))?;
    info.set_item("instruction_set", InstructionSet::current().name())?;
    Ok(info)
}

/// Disables instructions newer than the instruction set named by the environment variable
/// `ONORBIT_INSTRUCTION_SET`. An unset or empty variable changes nothing; an unknown name is an error.
fn limit_instructions() -> PyResult<()> {
    let level = std::env::var("ONORBIT_INSTRUCTION_SET").unwrap_or_default();
    if level.is_empty() {
        return Ok(());
    }
    let Some(level) = InstructionSet::named(&level) else {
        let names = InstructionSet::ALL.map(InstructionSet::name).join(", ");
        let message = format!("ONORBIT_INSTRUCTION_SET is {level:?}; it must be one of {names}");
        return Err(PyImportError::new_err(message));
    };
    InstructionSet::limit(level);
    Ok(())
}

#[pymodule]
fn _core(m: &Bound<'_, PyModule>) -> PyResult<()> {
    limit_instructions()?;
    m.add("__version__", env!("CARGO_PKG_VERSION"))?;
    m.add("MU_EARTH", onorbit_core::orbit::MU_EARTH)?;
    model::add_classes(m)?;
    m.add_class::<dynamics::PyFreeFloating>()?;
    m.add_class::<dynamics::PyFreeFloatingDerivatives>()?;
    m.add_class::<earth::PyEarth>()?;
    orbit::add_classes(m)?;
    environment::add_classes(m)?;
    m.add_class::<geometry::PyDistance>()?;
    m.add_function(wrap_pyfunction!(geometry::distance, m)?)?;
    m.add_function(wrap_pyfunction!(least_distance::least_distances, m)?)?;
    gravity::add_classes(m)?;
    reference::add_classes(m)?;
    control::add_classes(m)?;
    m.add_class::<simulation::PySimulation>()?;
    m.add_class::<stepper::PyStepper>()?;
    m.add_class::<trace::PyTrace>()?;
    contact::add_classes(m)?;
    m.add_class::<recorded_loop::PyLoopTrace>()?;
    world::add_classes(m)?;
    columns::add(m)?;
    m.add_class::<checkpoint::PyCheckpoint>()?;
    batch::add_functions(m)?;
    m.add_function(wrap_pyfunction!(build_info, m)?)?;
    Ok(())
}
