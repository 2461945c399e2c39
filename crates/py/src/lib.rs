//! Python bindings of `onorbit-core`: this crate translates, it never computes.

mod air;
mod arrays;
mod attach;
mod builder;
mod checkpoint;
mod control;
mod derivatives;
mod earth;
mod environment;
mod errors;
mod gravity;
mod interrupt;
mod kernels;
mod link_change;
mod made;
mod model;
mod orbit;
mod output;
mod plant;
mod propagate;
mod records;
mod reference;
mod relative;
mod robot_file;
mod rollout;
mod simulation;
mod surfaces;
mod trace;
mod xacro;

use onorbit_core::spatial::InstructionSet;
use pyo3::exceptions::PyImportError;
use pyo3::prelude::*;
use pyo3::types::PyDict;

/// Version and instruction set of the engine.
///
/// Returns
/// -------
/// dict
///     ``version`` and ``instruction_set`` (``baseline``, ``avx2+fma`` or ``avx512``).
#[pyfunction]
fn build_info(py: Python<'_>) -> PyResult<Bound<'_, PyDict>> {
    let info = PyDict::new(py);
    info.set_item("version", env!("CARGO_PKG_VERSION"))?;
    info.set_item("instruction_set", InstructionSet::current().name())?;
    Ok(info)
}

/// ``ONORBIT_INSTRUCTION_SET=baseline`` (or ``avx2+fma``) keeps the engine off newer instructions.
fn limit_instructions() -> PyResult<()> {
    let level = std::env::var("ONORBIT_INSTRUCTION_SET").unwrap_or_default();
    if level.is_empty() {
        return Ok(());
    }
    let Some(level) = InstructionSet::named(&level) else {
        let names = InstructionSet::ALL.map(InstructionSet::name).join(", ");
        let message = format!("ONORBIT_INSTRUCTION_SET is {level:?}, it must be one of {names}");
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
    m.add_class::<model::PyModel>()?;
    m.add_class::<robot_file::PyRobotPart>()?;
    m.add_function(wrap_pyfunction!(attach::attach, m)?)?;
    m.add_class::<records::PyVisual>()?;
    m.add_class::<records::PyJoint>()?;
    m.add_class::<records::PyBody>()?;
    m.add_class::<records::PyFrame>()?;
    m.add_class::<kernels::PyFreeFloating>()?;
    m.add_class::<derivatives::PyFreeFloatingDerivatives>()?;
    m.add_class::<builder::PyModelBuilder>()?;
    m.add_class::<orbit::PyOrbit>()?;
    m.add_class::<orbit::PyKepler>()?;
    m.add_class::<orbit::PySgp4>()?;
    m.add_class::<orbit::PyCustomPath>()?;
    m.add_class::<orbit::PyFixedFrame>()?;
    m.add_class::<orbit::PyNumerical>()?;
    m.add_class::<earth::PyEarth>()?;
    m.add_class::<environment::PyEffect>()?;
    m.add_class::<environment::PyGravityGradient>()?;
    m.add_class::<environment::PyThirdBody>()?;
    m.add_class::<environment::PyBodyWrench>()?;
    m.add_class::<gravity::PyGravityField>()?;
    m.add_class::<environment::PyDrag>()?;
    m.add_class::<environment::PyRadiationPressure>()?;
    air::add_classes(m)?;
    surfaces::add_classes(m)?;
    control::add_classes(m)?;
    reference::add_classes(m)?;
    m.add_class::<simulation::PySimulation>()?;
    m.add_class::<trace::PyTrace>()?;
    m.add_class::<checkpoint::PyCheckpoint>()?;
    m.add_function(wrap_pyfunction!(build_info, m)?)?;
    m.add_function(wrap_pyfunction!(rollout::rollout, m)?)?;
    m.add_function(wrap_pyfunction!(propagate::propagate, m)?)?;
    m.add_function(wrap_pyfunction!(relative::hill_transition, m)?)?;
    m.add_function(wrap_pyfunction!(relative::intercept_velocity, m)?)?;
    m.add_function(wrap_pyfunction!(relative::to_lvlh, m)?)?;
    m.add_function(wrap_pyfunction!(relative::from_lvlh, m)?)?;
    m.add_function(wrap_pyfunction!(relative::relative_elements, m)?)?;
    m.add_function(wrap_pyfunction!(relative::deputy_state, m)?)?;
    Ok(())
}
