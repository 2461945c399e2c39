//! Worlds: their systems, events, steppers and traces.

mod brake;
mod declared;
mod event;
mod event_record;
mod loops;
mod robot_settings;
mod system;
mod systems;
mod trace;

pub(crate) use declared::PyWorld;
pub(crate) use event_record::PyEventRecord;
pub(crate) use robot_settings::{RobotSettings, initial_state};
pub(crate) use systems::{PySystemStepper, Systems};

use pyo3::prelude::*;

/// Adds the classes of worlds to the module.
pub(crate) fn add_classes(m: &Bound<'_, PyModule>) -> PyResult<()> {
    m.add_class::<system::PySystem>()?;
    m.add_class::<event::PyCapture>()?;
    m.add_class::<event::PyRelease>()?;
    m.add_class::<brake::PyBrake>()?;
    m.add_class::<brake::PyEngage>()?;
    m.add_class::<brake::PyDisengage>()?;
    m.add_class::<declared::PyWorld>()?;
    m.add_class::<systems::PySystemStepper>()?;
    m.add_class::<trace::PyWorldTrace>()?;
    m.add_class::<event_record::PyEventRecord>()
}
